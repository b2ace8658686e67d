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

/// Queries of triangles against the surface of an exact map: which faces are near, how far the nearest is,
/// does one meet the triangle, and when. They need no inside: open meshes are as good as closed ones.
///
/// The surface is that of the map: the faces of the mesh with their vertices on the map's lattice, R / 2^20
/// from where the mesh has them at most along each axis, without those that have no area there. Everything is
/// in the map's frame; faces have their numbers in the mesh. A triangle with two equal corners is an edge,
/// one with three a point. A triangle with a corner that is not finite is nowhere: it has no face near it.
///
/// Any number of threads may query one map. The same answers on every machine and for every number of
/// threads.
namespace echinus {

/// Three corners in the map's frame.
using TrianglePoints = std::array<Vec3f, 3>;

/// Has the triangle a point in common with the surface? Touching counts. Corners are snapped to the lattice
/// as particles are, so that neighbours stay neighbours; then the answer is exact. Farther than 32 R from the
/// map's centre the lattice is as coarse as floats of such lattice steps, and a corner farther than 10^32 R
/// counts as not finite. Does not allocate.
bool intersects(const ExactMapView& map, const TrianglePoints& triangle_local) noexcept;

/// How far a triangle is from the surface.
struct Clearance {
    /// Not more than the distance between triangle and surface, rounding included, and mostly less by no more
    /// than rounding: by 1e-6 of the distance and of the coordinates' extent together. 0 where they
    /// intersect.
    float distance = std::numeric_limits<float>::infinity();
    std::int32_t face = -1; ///< the face that is so far; -1 where none is within `farthest`

    bool found() const { return face != -1; }
};

/// The clearance of a triangle. Does not allocate. Cost: grows with the logarithm of the number of faces, and
/// with the number of faces that are about as near as the nearest.
/// @param farthest  beyond it, and beyond 10^12 R, nothing is looked for: the distance is then the smaller of
///                  the two, and there is no face. Not negative
Clearance clearance(const ExactMapView& map, const TrianglePoints& triangle_local,
                    float farthest = std::numeric_limits<float>::infinity()) noexcept;

/// Where a moving triangle first comes to the surface.
struct TriangleSweepHit {
    /// Of the way. Until there the triangle does not meet the surface. 1 where it never does.
    float fraction = 1;
    std::int32_t face = -1; ///< the face that it comes to, or -1

    bool found() const { return face != -1; }
};

/// The way of a triangle whose corners each move along a straight line, at the same time. An edge is a
/// triangle with two equal corners.
///
/// Conservative advancement, until the triangle is within R / 2^17 of the surface, or within 10^-13 of how
/// far from the centre the way begins and ends, if that is more. So where `fraction` is less than 1, it is
/// that near to the surface, but for the rounding of `fraction` itself. A way that begins or ends farther
/// than 10^11 R from the centre is not followed: nothing is met. Does not allocate.
///
/// Cost: up to 16 clearances. A triangle that has not arrived by then, because it slides along the surface or
/// leaves it slowly, is moved on beside each face for itself that comes within its box, until the first is
/// met: by a few distances of two triangles, and by no more than 36 + 2 log2(L / R) where its corners move
/// alike; L is the length of the way. One that turns closely around an edge all the way is taken in parts:
/// that may take some ten thousand distances, and more the farther its corners are.
TriangleSweepHit sweep(const ExactMapView& map, const TrianglePoints& from_local,
                       const TrianglePoints& to_local) noexcept;

/// A list of faces for each of many triangles.
struct FaceLists {
    std::vector<std::uint32_t> offsets; ///< [triangle_count + 1] where each one's list begins; the last ends
    std::vector<std::uint32_t> faces;   ///< list after list, each ascending

    std::span<const std::uint32_t> operator[](std::size_t triangle) const {
        return {faces.data() + offsets[triangle], faces.data() + offsets[triangle + 1]};
    }
};

/// The faces that come within reach of each triangle: all whose distance is at most `reach`, and hardly one
/// that is farther by more than rounding (see Clearance).
/// @param vertices_local  [vertex_count]
/// @param triangles       [n] indices of vertices
/// @param reach           not negative; 0: faces that touch. Beyond 10^12 R nothing is looked for
/// @param lists           [n] out; keeps its memory from one call to the next
/// @param thread_count    0: all cores
/// @pre indices are in range; @throws Error InvalidOptions when the lists would hold 2^32 faces or more
/// Allocates what the lists need. Cost: of a triangle that is far from the surface some 100 ns.
void faces_within_batch(const ExactMapView& map, StridedSpan<const Vec3f> vertices_local,
                        std::span<const Triangle> triangles, float reach, FaceLists& lists,
                        unsigned thread_count = 1);

} // namespace echinus

ECHINUS_EXPORT_END
