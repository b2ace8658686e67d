#include "simulation/start/inner_layer.hpp"

#include "geometry/elementary.hpp"
#include "simulation/start/openings.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

namespace echinus {

namespace {

/// The faces at an edge.
struct AtEdge {
    Vec3d normals;
    int face_count = 0;
};

std::pair<std::uint32_t, std::uint32_t> edge_opposite(const Triangle& face, std::size_t corner) {
    return std::minmax(face[(corner + 1) % 3], face[(corner + 2) % 3]);
}

double angle_between(const Vec3d& a, const Vec3d& b) {
    return portable_atan2(length(cross(a, b)), dot(a, b));
}

/// The index of the smallest and of the largest barycentric coordinate of a point in a triangle.
std::pair<std::size_t, std::size_t> least_and_most(const std::array<Vec3d, 3>& corners, const Vec3d& point) {
    const auto& [a, b, c] = corners;
    const Vec3d normal = cross(b - a, c - a);
    const std::array<double, 3> areas{dot(normal, cross(b - point, c - point)),
                                      dot(normal, cross(c - point, a - point)),
                                      dot(normal, cross(a - point, b - point))};
    const auto [least, most] = std::minmax_element(areas.begin(), areas.end());
    return {static_cast<std::size_t>(least - areas.begin()), static_cast<std::size_t>(most - areas.begin())};
}

Contact away(const Vec3f& point) {
    Contact none;
    none.point = point;
    return none;
}

} // namespace

InnerLayer::InnerLayer(TriangleMesh surface)
    : surface_(std::move(surface)), collider_{.map = ExactMap::build(surface_)},
      edge_normals_(surface_.faces.size()), is_border_edge_(surface_.faces.size()),
      vertex_normals_(surface_.vertices.size()), is_border_vertex_(surface_.vertices.size()) {
    find_normals();
}

void InnerLayer::find_normals() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, AtEdge> edges;
    for (const Triangle& face : surface_.faces) {
        const std::array<Vec3d, 3> p = corners(face);
        const Vec3d normal = unit_or_zero(cross(p[1] - p[0], p[2] - p[0]));
        face_normals_.push_back(normal);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d to_next = p[(k + 1) % 3] - p[k], to_last = p[(k + 2) % 3] - p[k];
            vertex_normals_[face[k]] += normal * angle_between(to_next, to_last);
            AtEdge& edge = edges[edge_opposite(face, k)];
            edge.normals += normal;
            ++edge.face_count;
        }
    }
    for (std::size_t f = 0; f < surface_.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::pair ends = edge_opposite(surface_.faces[f], k);
            const AtEdge& edge = edges[ends];
            edge_normals_[f][k] = edge.normals;
            is_border_edge_[f][k] = edge.face_count == 1;
            if (edge.face_count == 1) is_border_vertex_[ends.first] = is_border_vertex_[ends.second] = true;
        }
}

std::array<Vec3d, 3> InnerLayer::corners(const Triangle& face) const {
    return {Vec3d(surface_.vertices[face[0]]), Vec3d(surface_.vertices[face[1]]),
            Vec3d(surface_.vertices[face[2]])};
}

Contact InnerLayer::contact_of(const Vec3f& point, const Contact& nearest) const {
    if (!nearest.found()) return away(point);
    const std::optional<Vec3d> normal = normal_at(nearest);
    if (!normal) return away(point);
    Contact contact = nearest;
    const Vec3d offset = Vec3d(point) - Vec3d(nearest.point);
    const double distance = length(offset);
    contact.inside = dot(offset, *normal) < 0;
    contact.depth = static_cast<float>(contact.inside ? distance : -distance);
    contact.normal =
        distance > 0 ? Vec3f(offset * ((contact.inside ? -1 : 1) / distance)) : Vec3f(unit_or_zero(*normal));
    return contact;
}

std::optional<Vec3d> InnerLayer::normal_at(const Contact& nearest) const {
    if (nearest.feature == Feature::Face) return face_normals_[nearest.face];
    const Triangle& face = surface_.faces[nearest.face];
    const auto [least, most] = least_and_most(corners(face), Vec3d(nearest.point));
    if (nearest.feature == Feature::Edge)
        return is_border_edge_[nearest.face][least] ? std::nullopt
                                                    : std::optional(edge_normals_[nearest.face][least]);
    return is_border_vertex_[face[most]] ? std::nullopt : std::optional(vertex_normals_[face[most]]);
}

} // namespace echinus
