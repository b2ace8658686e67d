#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <memory>
#include <span>

namespace echinus::rivals {

/// Signed distances as people really store them: a sparse grid of OpenVDB (Museth, "VDB: High-resolution
/// sparse volumes with dynamic topology", ACM Transactions on Graphics 32(3), 2013), three voxels deep
/// outside and all of the inside, in its standard tree, read by trilinear interpolation.
///
/// The samples are OpenVDB's (meshToVolume): near the surface the distance to the nearest face, deep inside
/// carried from voxel to voxel, and signs by a flood from outside, so that inner surfaces of nested or
/// overlapping parts count for depths and not for sides. The interpolation errs as a dense grid's does:
/// sqrt(3) / 2 of the voxel at most, if the samples were exact. Contacts outside are found within 1.26 voxels
/// of the surface, however wide the margin.
class SparseField final : public System {
  public:
    static constexpr std::uint32_t kMaxSamples = 4000; ///< one inner node of the tree is 4096 across

    /// So many samples along the longest side of the mesh's box. Built on all cores, in the order that
    /// OpenVDB likes; the samples do not depend on it.
    /// @param mesh  closed
    /// @throws Error InvalidMesh as inspect() does, for an open mesh, or when the bounding radius lies
    /// outside [1e-15, 1e15]; InvalidOptions unless sample_count lies in [2, kMaxSamples] and the box has
    /// at most 2^30 voxels
    static SparseField with_samples(const TriangleMesh& mesh, std::uint32_t sample_count);

    /// As many samples as fit, to about one part in twenty: bytes are known only of a field that was built,
    /// so this builds some ten. The coarsest takes some 0.3 MB, which is the top of OpenVDB's tree.
    /// @throws Error as above; InvalidOptions when the coarsest field exceeds the budget
    static SparseField with_bytes(const TriangleMesh& mesh, std::size_t byte_budget);

    SparseField(SparseField&&) noexcept;
    SparseField& operator=(SparseField&&) noexcept;
    ~SparseField() override;

    std::string name() const override { return "openvdb"; }
    std::size_t byte_count() const override;
    std::string_view counted() const override { return "the grid, by OpenVDB's memUsage()"; }
    double spacing() const;             ///< edge of a voxel in the mesh's unit
    std::uint32_t sample_count() const; ///< along the longest side

    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override;
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const override;
    using System::contacts_batch;

  private:
    struct Grid;
    explicit SparseField(std::unique_ptr<const Grid> grid);

    std::unique_ptr<const Grid> grid_;
};

} // namespace echinus::rivals
