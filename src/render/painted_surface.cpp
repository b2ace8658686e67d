#include "render/painted_surface.hpp"

#include "render/image.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

namespace echinus::render {

namespace {

/// The corners that meet at each vertex: corner 3 * face + k in [offsets[v], offsets[v + 1]).
struct CornersOfVertices {
    std::vector<std::uint32_t> offsets;
    std::vector<std::uint32_t> corners;

    explicit CornersOfVertices(const TriangleMesh& mesh)
        : offsets(mesh.vertices.size() + 1), corners(3 * mesh.faces.size()) {
        for (const Triangle& face : mesh.faces) {
            for (std::uint32_t vertex : face) ++offsets[vertex + 1];
        }
        for (std::size_t v = 1; v < offsets.size(); ++v) offsets[v] += offsets[v - 1];
        std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
        for (std::uint32_t corner = 0; corner < corners.size(); ++corner) {
            corners[next[mesh.faces[corner / 3][corner % 3]]++] = corner;
        }
    }

    std::span<const std::uint32_t> at(std::uint32_t vertex) const {
        return {corners.data() + offsets[vertex], corners.data() + offsets[vertex + 1]};
    }
};

Vec3d unit_or_zero(const Vec3d& v) {
    const double size = length(v);
    return size > 0 ? v * (1 / size) : Vec3d{};
}

/// A face's normal times its angle at a corner.
Vec3d weighted_normal(const TriangleMesh& mesh, const Vec3d& normal, std::uint32_t corner) {
    const Triangle& face = mesh.faces[corner / 3];
    const Vec3d apex(mesh.vertices[face[corner % 3]]);
    const Vec3d a = Vec3d(mesh.vertices[face[(corner + 1) % 3]]) - apex;
    const Vec3d b = Vec3d(mesh.vertices[face[(corner + 2) % 3]]) - apex;
    return normal * std::atan2(length(cross(a, b)), dot(a, b));
}

} // namespace

Vec3d face_normal(const TriangleMesh& mesh, const Triangle& face) {
    const Vec3d a(mesh.vertices[face[0]]);
    return unit_or_zero(cross(Vec3d(mesh.vertices[face[1]]) - a, Vec3d(mesh.vertices[face[2]]) - a));
}

std::vector<CornerNormals> corner_normals(const TriangleMesh& mesh, double crease_angle_deg) {
    const CornersOfVertices around(mesh);
    const double cos_crease = std::cos(crease_angle_deg * std::numbers::pi / 180);
    std::vector<Vec3d> normals(mesh.faces.size());
    std::transform(mesh.faces.begin(), mesh.faces.end(), normals.begin(),
                   [&](const Triangle& face) { return face_normal(mesh, face); });
    std::vector<Vec3d> weighted(3 * mesh.faces.size());
    for (std::uint32_t corner = 0; corner < weighted.size(); ++corner) {
        weighted[corner] = weighted_normal(mesh, normals[corner / 3], corner);
    }

    std::vector<CornerNormals> result(mesh.faces.size());
    for (std::uint32_t corner = 0; corner < weighted.size(); ++corner) {
        Vec3d sum = normals[corner / 3] * 1e-6; // gives a direction even if all others cancel out
        for (std::uint32_t other : around.at(mesh.faces[corner / 3][corner % 3])) {
            if (dot(normals[other / 3], normals[corner / 3]) >= cos_crease) sum += weighted[other];
        }
        result[corner / 3][corner % 3] = Vec3f(unit_or_zero(sum));
    }
    return result;
}

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
        // A vertex that no face uses may be anywhere; it must not extend Embree's bounds.
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

/// The colours of the fronts and backs of an object's faces.
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

} // namespace echinus::render
