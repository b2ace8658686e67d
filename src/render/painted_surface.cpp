#include "render/painted_surface.hpp"

#include "render/tone.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// The same mesh in the unit frame, without its faces of area zero.
struct UnitMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> source_face; ///< [face_count] its number in the object
};

UnitMesh to_unit_frame(const TriangleMesh& mesh, const UnitFrame& frame) {
    UnitMesh result;
    result.mesh.vertices.reserve(mesh.vertices.size());
    for (const Vec3f& vertex : mesh.vertices) {
        // A vertex that no face uses may be anything; it must not enter Embree's bounds.
        const Vec3d moved = frame.to_unit(Vec3d(vertex));
        result.mesh.vertices.push_back(length(moved) <= 2 ? Vec3f(moved) : Vec3f{});
    }
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        if (face_normal(result.mesh, mesh.faces[f]) == Vec3d{}) continue;
        result.mesh.faces.push_back(mesh.faces[f]);
        result.source_face.push_back(f);
    }
    return result;
}

void require_options(const RenderedObject& object, const std::string& name) {
    if (!object.face_colours.empty() && object.face_colours.size() != object.mesh.faces.size()) {
        throw Error(ErrorCode::InvalidOptions,
                    name + ": " + std::to_string(object.face_colours.size()) + " face colours for " +
                        std::to_string(object.mesh.faces.size()) + " faces; give one each, or none");
    }
    for (const std::uint32_t face : object.marked_faces)
        if (face >= object.mesh.faces.size())
            throw Error(ErrorCode::InvalidOptions, name + ": face " + std::to_string(face) +
                                                       " is to be marked, but there are only " +
                                                       std::to_string(object.mesh.faces.size()));
    if (!(object.crease_angle_deg >= 0 && object.crease_angle_deg <= 180)) {
        throw Error(ErrorCode::InvalidOptions, name + ": the crease angle must lie in [0, 180] degrees");
    }
    if (!(object.wire_width_px >= 0 && object.wire_width_px <= 100)) {
        throw Error(ErrorCode::InvalidOptions, name + ": the wire's width must lie in [0, 100] pixels");
    }
}

/// The colours of an object's faces, of their fronts and backs.
std::pair<std::vector<Colour>, std::vector<Colour>> colours_of(const RenderedObject& object) {
    std::vector<Colour> fronts = object.face_colours;
    fronts.resize(object.mesh.faces.size(), object.colour);
    std::vector<Colour> backs = fronts;
    if (object.back_colour) std::fill(backs.begin(), backs.end(), *object.back_colour);
    for (const std::uint32_t face : object.marked_faces) fronts[face] = backs[face] = palette::kMark;
    return {std::move(fronts), std::move(backs)};
}

void append(PaintedSurface& surface, const RenderedObject& object, const UnitMesh& part) {
    const auto first_vertex = static_cast<std::uint32_t>(surface.mesh.vertices.size());
    const auto [fronts, backs] = colours_of(object);
    surface.mesh.vertices.insert(surface.mesh.vertices.end(), part.mesh.vertices.begin(),
                                 part.mesh.vertices.end());
    const std::vector<CornerNormals> normals = corner_normals(part.mesh, object.crease_angle_deg);
    surface.normals.insert(surface.normals.end(), normals.begin(), normals.end());
    for (std::size_t f = 0; f < part.mesh.faces.size(); ++f) {
        const Triangle& face = part.mesh.faces[f];
        surface.mesh.faces.push_back(
            {face[0] + first_vertex, face[1] + first_vertex, face[2] + first_vertex});
        surface.fronts.push_back(to_linear(fronts[part.source_face[f]]));
        surface.backs.push_back(to_linear(backs[part.source_face[f]]));
        surface.wire_half_widths_px.push_back(static_cast<float>(object.wire_width_px / 2));
    }
}

} // namespace

std::vector<Vec3f> used_points(std::span<const RenderedObject> objects) {
    std::vector<Vec3f> points;
    for (const RenderedObject& object : objects) {
        require_valid(object.mesh);
        std::vector<bool> used(object.mesh.vertices.size());
        for (const Triangle& face : object.mesh.faces) {
            for (std::uint32_t vertex : face) used[vertex] = true;
        }
        for (std::size_t v = 0; v < used.size(); ++v) {
            if (used[v]) points.push_back(object.mesh.vertices[v]);
        }
    }
    return points;
}

PaintedSurface paint(std::span<const RenderedObject> objects) {
    if (objects.empty()) throw Error(ErrorCode::InvalidMesh, "there is no object to draw");
    const Sphere bounds = smallest_enclosing_sphere(used_points(objects));
    PaintedSurface surface;
    surface.frame = {bounds.centre, bounds.radius > 0 ? 1 / bounds.radius : 1};
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::string name = "object " + std::to_string(i + 1);
        require_options(objects[i], name);
        const UnitMesh part = to_unit_frame(objects[i].mesh, surface.frame);
        if (part.mesh.faces.empty()) {
            throw Error(ErrorCode::InvalidMesh, name + ": none of its " +
                                                    std::to_string(objects[i].mesh.faces.size()) +
                                                    " faces has an area; there is nothing to see");
        }
        append(surface, objects[i], part);
    }
    return surface;
}

} // namespace echinus
