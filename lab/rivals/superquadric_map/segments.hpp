#pragma once

#include "rivals/superquadric_map/decompose.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus::rivals {

/// The faces of the convex hull of points: closed, counter-clockwise seen from outside, corners numbered as
/// the points. By Bullet's exact integers (btConvexHullComputer, after Preparata and Hong 1977), to which
/// points are rounded in steps of 1e-4 of their extent. Points in one plane give a sheet of two sides; on one
/// line, nothing.
/// @pre positions are finite
std::vector<Triangle> convex_hull(std::span<const Vec3f> points);

/// A segment of a surface and the solid that it stands for: the convex hull of its faces and, where that
/// leaves gaps, of middles of chords, which run inwards from the faces at a right angle to the next wall.
///
/// The hulls of patches alone are but a crust. A place in the solid is at most half-way down the chord from
/// the point of the surface that is nearest to it, since the ball around it up to that point is empty; so
/// hulls that hold the middles of all chords hold the whole solid. A hundred chords a segment are tried, and
/// those whose outer half is in some segments' hulls already are left out.
struct Segment {
    TriangleMesh mesh;                       ///< the segment's own faces first, then the hull's
    std::vector<std::uint32_t> face_numbers; ///< [own faces] in the whole mesh, ascending

    std::span<const Triangle> own_faces() const { return std::span(mesh.faces).first(face_numbers.size()); }
    std::span<const Triangle> hull_faces() const {
        return std::span(mesh.faces).subspan(face_numbers.size());
    }
    /// Is a place in the hull? Time O(faces).
    bool holds(const Vec3d& place) const;
};

/// Time O(segments x faces) with a factor of a hundred chords.
/// @param mesh  wound outward
std::vector<Segment> make_segments(const TriangleMesh& mesh, const Decomposition& decomposition);

/// Points spread evenly over the area of some faces.
struct SurfaceSamples {
    std::vector<Vec3d> points;
    std::vector<std::uint32_t> faces; ///< on which they lie
    double area = 0;                  ///< of those faces
};

/// @return  `count` samples, each of the same share of the faces' area; none where there is no area
SurfaceSamples sample_surface(std::span<const Vec3f> vertices, std::span<const Triangle> faces,
                              std::size_t count);

} // namespace echinus::rivals
