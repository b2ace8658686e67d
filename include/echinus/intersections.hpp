#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Exact tests for intersecting faces, for instance to verify the results of a simulation, or to check a
/// garment and its body before a simulation. The tests are exact for the given float coordinates, without
/// rounding or tolerances. The answers are the same on every machine.
namespace echinus {

/// Do two closed triangles have a common point? Touching counts. Corners may coincide or be collinear; the
/// triangle is then the segment or the point that they span. The result is false if a coordinate is not
/// finite.
bool triangles_intersect(const std::array<Vec3f, 3>& a, const std::array<Vec3f, 3>& b) noexcept;

/// Two faces, by index.
struct FacePair {
    std::uint32_t a, b;

    friend auto operator<=>(const FacePair&, const FacePair&) = default;
};

// The following two functions find candidates with trees of boxes over the faces, in O(n log n + m) time for
// n faces and m pairs of overlapping boxes. A face { v, w, w } is an edge without area, such as a thread
// segment, and counts as that segment.

/// The intersecting pairs of a face of `a` and a face of `b`, in ascending order, for meshes in the same
/// frame.
/// @throws Error InvalidMesh as require_valid() does, for either mesh, or when their origins differ
std::vector<FacePair> intersecting_pairs(const TriangleMesh& a, const TriangleMesh& b);

/// The pairs a < b of faces of one mesh that intersect other than in shared vertices or edges, in ascending
/// order: a part of one face (corner, edge or whole face) meets a part of the other with which it has no
/// common vertex. So two faces
///   - without a common vertex intersect if they touch,
///   - with one common vertex intersect if they meet anywhere else,
///   - with two common vertices, neighbours across an edge, intersect if they are folded onto each other,
///   - with three common vertices always intersect.
///
/// Vertices are distinguished by index: call weld() first if vertices at equal positions are meant to be one.
/// A face whose corner lies on its own opposite edge intersects its neighbours there.
/// @throws Error InvalidMesh as require_valid() does
std::vector<FacePair> self_intersecting_pairs(const TriangleMesh& mesh);

/// A polyline along which surfaces intersect.
struct IntersectionCurve {
    std::vector<Vec3f> points;
    bool closed = false; ///< a segment joins the last point to the first
};

/// The intersections of surfaces, as pairs of faces and as curves.
struct Intersections {
    /// The largest number of pairs. It limits the memory for surfaces that lie on each other, in which each
    /// face intersects a dozen others.
    static constexpr std::size_t kMostPairs = std::size_t{1} << 25;

    std::vector<FacePair> pairs;
    /// Each pair of faces that cross contributes the segment that both contain. Whether segments meet at an
    /// end is decided exactly; positions are computed in double and rounded. Curves end at the border of a
    /// surface, and where more than two segments meet. Coplanar faces, faces without area, and faces that
    /// touch in a point contribute nothing.
    std::vector<IntersectionCurve> curves;
    double length = 0; ///< the total length of all curves
};

/// The pairs of intersecting_pairs() and their curves. The curves of p pairs take O(p log p) time in
/// addition.
/// @throws Error as intersecting_pairs() does; InvalidMesh for more than kMostPairs pairs
Intersections intersections(const TriangleMesh& a, const TriangleMesh& b);

/// The pairs of self_intersecting_pairs() and their curves.
/// @throws Error as self_intersecting_pairs() does; InvalidMesh for more than kMostPairs pairs
Intersections self_intersections(const TriangleMesh& mesh);

// ---- Many meshes at once ----

/// How far the vertices of one mesh are inside another. The depth of a vertex is the length of the shortest
/// translation that moves it out: its distance from the other's surface. Surfaces may also cross where no
/// vertex is inside; the length of the curves measures that.
struct Penetration {
    /// Whether the depth was measured: the other mesh must be closed, so that it has an inside, and an exact
    /// map of it must be possible. Otherwise the other members keep their defaults.
    bool known = false;
    std::uint32_t vertex_count = 0; ///< number of vertices inside, not counting those that no face uses
    std::uint32_t deepest_vertex = kNoIndex; ///< the first of the deepest vertices
    float depth = 0;                         ///< the depth of the deepest vertex
};

/// The findings about a pair of the given meshes, or about one mesh and itself.
struct CheckedMeshes {
    std::uint32_t a = 0, b = 0; ///< a <= b; equal for a mesh and itself
    Intersections found;
    Penetration a_in_b, b_in_a; ///< not known for a mesh and itself

    bool intersect() const { return !found.pairs.empty(); }
};

struct CheckOptions {
    /// The names of the meshes in errors, for instance those of their files. If there are none, the meshes
    /// are called "mesh 0" and so on.
    std::vector<std::string> names = {};
    unsigned thread_count = 0; ///< for measuring depths; 0: all cores. The results do not depend on it
    /// Called with the completed share of the work, 0 to 1, in the thread that called check().
    std::function<void(double share)> progress = nullptr;
};

/// Checks every mesh and every pair of meshes, which must all lie in one frame. Intersections of faces are
/// decided exactly; containment and depth are as accurate as the queries of an exact map (exact_map.hpp),
/// which is built from each closed mesh. A mesh may lie inside another without intersecting it.
/// @returns the pairs of meshes that intersect or of which one has a vertex inside the other, and the meshes
/// that intersect themselves, in ascending order
/// @throws Error InvalidMesh as intersections() and self_intersections() do; the message begins with the
/// names of the meshes
/// @throws Error InvalidOptions if the number of names is neither 0 nor that of the meshes
std::vector<CheckedMeshes> check(std::span<const TriangleMesh> meshes, const CheckOptions& options = {});

} // namespace echinus

ECHINUS_EXPORT_END
