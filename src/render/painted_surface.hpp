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
    struct Style {
        Vec3f front, back;     ///< linear colours, where the object has one for all faces
        bool has_back = false; ///< the back has colours of its own
        float wire_half_width_px = 0;
    };

    TriangleMesh mesh;
    std::vector<CornerNormals> normals;     ///< [face_count]
    std::vector<Vec3f> fronts;              ///< [face_count] linear colour of the front
    std::vector<std::uint32_t> style_index; ///< [face_count] index into `styles`
    std::vector<Style> styles;              ///< [object_count]
    UnitFrame frame;
};

/// Checks the objects and joins them. Faces without area are left out: no ray hits them.
/// @throws Error as render()
PaintedSurface paint(std::span<const RenderedObject> objects);

/// Positions of all vertices that faces use, object after object.
/// @throws Error InvalidMesh as inspect() does
std::vector<Vec3f> used_points(std::span<const RenderedObject> objects);

} // namespace echinus
