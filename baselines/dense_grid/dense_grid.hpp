#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus::baselines {

/// Signed distances at the nodes of a regular grid in the mesh's own box, read by trilinear interpolation:
/// what one writes oneself when no library is at hand, and the speed to beat. The queries are loops without a
/// branch, which the compiler turns into vector instructions and gathers.
///
/// Wrong by interpolation: near the surface in its sign, everywhere in its depth, by some share of the
/// spacing. All points are in the mesh's frame. Any number of threads may query one grid.
class DenseGrid {
  public:
    /// The finest spacing with which the samples take at most so many bytes.
    static DenseGrid with_bytes(const TriangleMesh& mesh, std::size_t byte_budget);

    /// @param spacing  of the nodes, in the mesh's unit
    static DenseGrid with_spacing(const TriangleMesh& mesh, double spacing);

    std::size_t byte_count() const { return samples_.size() * sizeof(float); }
    std::size_t node_count(int axis) const { return node_counts_[axis]; }

    /// What contacts_batch() answers, an array a component: the normal is that of the field, found for every
    /// particle, as a loop without branches does. Depth is positive inside.
    struct Contacts {
        std::span<float> depths, normals_x, normals_y, normals_z; ///< [n] each
    };

    /// A particle beyond the box is outside, and so is one that is not finite.
    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const noexcept;
    void contacts_batch(std::span<const Vec3f> points, const Contacts& contacts) const noexcept;

  private:
    DenseGrid(const TriangleMesh& mesh, double spacing);

    Vec3f low_;                ///< the first node
    float nodes_per_unit_ = 0; ///< 1 / spacing
    std::uint32_t node_counts_[3]{};
    std::vector<float> samples_; ///< [z][y][x] signed distances, negative inside
};

} // namespace echinus::baselines
