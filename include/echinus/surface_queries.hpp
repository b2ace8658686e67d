#pragma once

#include <echinus/exact_map_view.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Queries of triangles against the surface of an exact map: the nearby faces, the distance to the nearest
/// one, intersection tests, and sweeps. They do not need an inside, so open meshes work as well as closed
/// ones.
///
/// The surface is that of the map: the faces of the mesh, with their vertices snapped to the map's lattice.
/// Snapping moves a vertex by at most R / 2^20 along each axis; a face that has no area on the lattice counts
/// as a segment or a point. Everything is in the map's frame; faces are numbered as in the mesh. A triangle
/// with two equal corners is an edge, and one with three equal corners a point. A triangle with a corner that
/// is not finite is far from all faces.
///
/// Any number of threads may query one map. The answers are the same on every machine and for any number of
/// threads.
namespace echinus {

/// Three corners in the map's frame.
using TrianglePoints = std::array<Vec3f, 3>;

/// Does the triangle have a point in common with the surface? Touching counts. Corners are snapped to the
/// lattice like particles, so triangles that share a corner still share it; for the snapped triangle the
/// answer is exact. Farther than 32 R from the map's centre, corners are rounded as coarsely as floats in
/// units of lattice steps, and a corner farther than 10^32 R counts as not finite. The query does not
/// allocate.
bool intersects(const ExactMapView& map, const TrianglePoints& triangle_local) noexcept;

/// The distance of a triangle from the surface.
struct Clearance {
    /// A lower bound on the distance between the triangle and the surface, which holds despite rounding. It
    /// usually falls short of the distance by rounding errors only: by 1e-6 of the sum of the distance and
    /// the coordinates' extent. It is 0 if the triangle and the surface intersect.
    float distance = std::numeric_limits<float>::infinity();
    std::uint32_t face = kNoIndex; ///< the face at this distance; kNoIndex if none is within `farthest`

    bool found() const { return face != kNoIndex; }
};

/// The clearance of a triangle. The query does not allocate. The cost grows with the logarithm of the number
/// of faces, and with the number of faces at about the same distance as the nearest one.
/// @param farthest  the search distance, limited to 10^12 R: if nothing is found within it, the distance is
/// this limit, and there is no face. Not negative
Clearance clearance(const ExactMapView& map, const TrianglePoints& triangle_local,
                    float farthest = std::numeric_limits<float>::infinity()) noexcept;

/// The time at which a moving triangle first reaches the surface.
struct TriangleSweepHit {
    /// The fraction of the path up to which the triangle does not meet the surface; 1 if it does not meet it
    /// at all.
    float fraction = 1;
    std::uint32_t face = kNoIndex; ///< the face that it reaches, or kNoIndex

    bool found() const { return face != kNoIndex; }
};

/// Sweeps a triangle whose corners each move along a straight line at the same time. An edge is a triangle
/// with two equal corners.
///
/// The query uses conservative advancement, until the triangle is within R / 2^17 of the surface or, if that
/// is more, within 10^-13 times the distance of the path's ends from the centre. So if `fraction` is less
/// than 1, the triangle is that close to the surface at this point of the path, except for the rounding of
/// `fraction` itself. A path that begins or ends farther than 10^11 R from the centre is ignored: the
/// triangle meets nothing. The query does not allocate.
///
/// The cost is up to 16 clearances. A triangle that has not arrived by then, because it slides along the
/// surface or leaves it slowly, is advanced separately for each face within its box, until the first face is
/// met. For each face this takes a few computations of the distance of two triangles, and at most 36 + 2
/// log2(L / R) for a path of length L on which all corners move alike. The path of a triangle that turns
/// closely around an edge is divided; this may take about ten thousand distance computations, and more if its
/// corners are far away.
TriangleSweepHit sweep(const ExactMapView& map, const TrianglePoints& from_local,
                       const TrianglePoints& to_local) noexcept;

// The same queries for many triangles. All arrays have the same size (@pre), and the output must not overlap
// the triangles. thread_count, 0 for all cores, is used for 32 768 triangles or more.

/// @param intersecting  [n] out: 0 or 1
void intersects_batch(const ExactMapView& map, StridedSpan<const TrianglePoints> triangles_local,
                      std::span<std::uint8_t> intersecting, unsigned thread_count = 1) noexcept;
/// @param farthest  as in clearance()
void clearance_batch(const ExactMapView& map, StridedSpan<const TrianglePoints> triangles_local,
                     float farthest, std::span<Clearance> clearances, unsigned thread_count = 1) noexcept;
void sweep_batch(const ExactMapView& map, StridedSpan<const TrianglePoints> from_local,
                 StridedSpan<const TrianglePoints> to_local, std::span<TriangleSweepHit> hits,
                 unsigned thread_count = 1) noexcept;

/// A list of faces for each of many triangles.
struct FaceLists {
    std::vector<std::uint32_t> offsets; ///< [triangle_count + 1] the start of each list; the last is the end
    std::vector<std::uint32_t> faces;   ///< the lists one after the other, each ascending

    std::span<const std::uint32_t> operator[](std::size_t triangle) const {
        return {faces.data() + offsets[triangle], faces.data() + offsets[triangle + 1]};
    }
};

/// Finds the faces within reach of each triangle: all faces whose distance is at most `reach`, and possibly
/// faces that are farther away by no more than rounding errors (see Clearance).
/// @param vertices_local  [vertex_count]
/// @param triangles       [n] indices of vertices
/// @param reach           not negative; 0: only touching faces. Limited to 10^12 R
/// @param lists           [n] out; keeps its memory from one call to the next
/// @param thread_count    0: all cores
/// @pre indices are in range; @throws Error InvalidOptions when the lists would hold 2^32 faces or more
///
/// Allocates the memory of the lists. A triangle far from the surface takes about 100 ns.
void faces_within_batch(const ExactMapView& map, StridedSpan<const Vec3f> vertices_local,
                        std::span<const Triangle> triangles, float reach, FaceLists& lists,
                        unsigned thread_count = 1);

} // namespace echinus

ECHINUS_EXPORT_END
