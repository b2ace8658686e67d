#pragma once

#include <echinus/mesh.hpp>
#include <echinus_render/render.hpp>

#include <array>
#include <span>
#include <vector>

namespace echinus::render {

/// Unit normals at the three corners of a face.
using CornerNormals = std::array<Vec3f, 3>;

/// Shading normals per face corner, [face_count]: the mean of the normals of the faces around the vertex
/// whose angle with this face is below the crease angle, each weighted by its corner angle at the vertex
/// (Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998). Faces without area get (0,
/// 0, 0).
/// @pre indices are in range, coordinates finite and of moderate size
std::vector<CornerNormals> corner_normals(const TriangleMesh& mesh, double crease_angle_deg);

/// Unit normal of one face, in double; (0, 0, 0) if it has no area.
Vec3d face_normal(const TriangleMesh& mesh, const Triangle& face);

/// A similarity from the objects' frame to one in which the drawing fills the unit sphere about the origin,
/// where float has enough digits for objects of any size and position.
struct UnitFrame {
    Vec3d centre;
    double scale = 1; ///< 1 / radius

    Vec3d to_unit(const Vec3d& point) const { return (point - centre) * scale; }
};

/// All objects as one triangle soup in the unit frame, with the data for shading.
struct PaintedSurface {
    TriangleMesh mesh;
    std::vector<CornerNormals> normals;     ///< [face_count]
    std::vector<Vec3f> fronts, backs;       ///< [face_count] linear colours
    std::vector<float> wire_half_widths_px; ///< [face_count]
    UnitFrame frame;
};

/// Checks the objects and joins them. Faces without area are left out: no ray hits them.
/// @throws Error as render()
PaintedSurface paint(std::span<const RenderedObject> objects);

/// Positions of all vertices that faces use, one object after the other.
/// @throws Error InvalidMesh as inspect() does
std::vector<Vec3f> used_points(std::span<const RenderedObject> objects);

} // namespace echinus::render
