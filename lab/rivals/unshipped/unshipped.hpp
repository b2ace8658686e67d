#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <malloc.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

/// Rivals that only benchmarks link: CGAL's packages are under the GPL, and `echinus-compare` gains little by
/// the others. Each is immutable and is asked as its users ask it.
namespace echinus::rivals {

/// "cgal": CGAL's tree of boxes, with exact predicates and rounded constructions. The side of a particle by a
/// ray parity (Side_of_triangle_mesh), and the nearest point.
/// @param mesh  closed; copied
/// @throws Error InvalidMesh as inspect() does, and for an open mesh
std::unique_ptr<const System> cgal_tree(const TriangleMesh& mesh);

/// "fcl": FCL's tree of oriented boxes with spheres (OBBRSS), asked for the distance of a tiny sphere. FCL
/// knows no inside of a mesh: the side is that of the nearest face, which errs where an edge or a vertex is
/// nearest. No contacts outside.
/// @throws Error as above
std::unique_ptr<const System> fcl_tree(const TriangleMesh& mesh);

/// "nanovdb": the signed distances of OpenVDB's meshToVolume, three samples deep outside and all of the
/// inside, as NanoVDB stores them: one block of memory. Trilinear interpolation. No contacts outside.
/// @param spacing  of the samples, in the mesh's unit
/// @throws Error as above
std::unique_ptr<const System> nano_field(const TriangleMesh& mesh, double spacing);

/// Bytes that the process has taken from the heap of the C library and not given back. Its growth while a
/// structure is built is what the structure weighs, for libraries that keep no account of their own.
inline std::size_t heap_bytes() {
    const auto info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

// Libraries that are asked about the triangles of one mesh against another mesh, as their users ask them.
// Only benchmarks link them.

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
