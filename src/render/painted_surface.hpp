#pragma once

#include "render/corner_normals.hpp"

#include <echinus/render.hpp>

#include <span>
#include <vector>

namespace echinus {

/// A similarity from the objects' frame to one in which the drawing fills the unit sphere about the origin,
/// where float has enough digits for objects of any size and position.
struct UnitFrame {
    Vec3d centre;
    double scale = 1; ///< 1 / radius

    Vec3d to_unit(const Vec3d& point) const { return (point - centre) * scale; }
};

/// All objects as one triangle soup in the unit frame, with the data that shade it.
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

/// Positions of all vertices that faces use, object after object.
/// @throws Error InvalidMesh as inspect() does
std::vector<Vec3f> used_points(std::span<const RenderedObject> objects);

} // namespace echinus
