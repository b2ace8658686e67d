#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

/// Libraries that are asked about the triangles of one mesh against another mesh, as their users ask them.
/// Only benchmarks link them.
namespace echinus::rivals {

/// A structure around a model that stays; the other mesh is new in each call, as a cloth is in each frame.
class TriangleRival {
  public:
    virtual ~TriangleRival() = default;

    /// Which faces of a mesh intersect the model?
    /// @param meets  [face_count] out: 1 for those that do
    virtual void find_intersecting(const TriangleMesh& mesh, std::span<std::uint8_t> meets) const = 0;
};

/// CGAL's tree of boxes, asked with each triangle; exact predicates.
std::unique_ptr<const TriangleRival> cgal_triangles(const TriangleMesh& model);

/// FCL's trees of oriented boxes with spheres, one around the model and one, built in each call, around the
/// other mesh; asked for all contacts. Single precision.
std::unique_ptr<const TriangleRival> fcl_triangles(const TriangleMesh& model);

/// Embree's rtcCollide() of two trees, of which one is built in each call.
class [[gnu::visibility("default")]] EmbreeTriangles final : public TriangleRival {
  public:
    explicit EmbreeTriangles(const TriangleMesh& model);
    ~EmbreeTriangles() override;

    /// Where boxes overlap, triangles_intersect() decides: Embree leaves that to its user.
    void find_intersecting(const TriangleMesh& mesh, std::span<std::uint8_t> meets) const override;

    /// How many pairs of a face of the mesh and one of the model have boxes not farther from each other than
    /// `reach` along any axis. Distances are left to the user.
    std::size_t count_near_boxes(const TriangleMesh& mesh, float reach) const;

  private:
    struct Structure;
    std::unique_ptr<const Structure> structure_;
};

} // namespace echinus::rivals
