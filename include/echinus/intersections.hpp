#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Which faces intersect? Judges results, for instance of a simulation; decided exactly on the float
/// coordinates, no rounding and no tolerance takes part. The same answers on every machine.
namespace echinus {

/// Do two closed triangles have a common point? Touching counts. Corners may coincide or lie on a line: the
/// triangle is then the segment or the point that they span. False where a coordinate is not finite.
bool triangles_intersect(const std::array<Vec3f, 3>& a, const std::array<Vec3f, 3>& b) noexcept;

/// Two faces by their numbers.
struct FacePair {
    std::uint32_t a, b;

    friend auto operator<=>(const FacePair&, const FacePair&) = default;
};

// Both calls find candidates with trees of boxes over the faces: time O(n log n + pairs of overlapping
// boxes). A face { v, w, w } is an edge without area, such as a piece of thread, and counts as that segment.

/// The pairs of a face of `a` and a face of `b` that intersect, ascending, both meshes in one frame.
/// @throws Error InvalidMesh as require_valid() does, for either mesh, or when their origins differ
std::vector<FacePair> intersecting_pairs(const TriangleMesh& a, const TriangleMesh& b);

/// The pairs a < b of faces of one mesh that intersect beyond what they share, ascending: a part of one
/// (corner, edge or whole face) meets a part of the other with which it has no vertex in common. So faces
///   - without a common vertex intersect when they touch,
///   - with one when they meet anywhere else,
///   - with two, neighbours across an edge, when they are folded onto each other,
///   - with three always.
/// Vertices are distinguished by index: weld() first where equal positions mean the same vertex. A face whose
/// corner lies on its own opposite edge intersects its neighbours there.
/// @throws Error InvalidMesh as require_valid() does
std::vector<FacePair> self_intersecting_pairs(const TriangleMesh& mesh);

} // namespace echinus

ECHINUS_EXPORT_END
