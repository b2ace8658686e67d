#include "simulation/start/inner_layer.hpp"

#include "geometry/elementary.hpp"
#include "simulation/start/openings.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace echinus {

namespace {

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
      elements_(surface_.vertices.size(), surface_.faces, {}), face_normals_(surface_.faces.size()),
      edge_normals_(elements_.edges.size()), vertex_normals_(surface_.vertices.size()),
      is_border_edge_(elements_.edges.size()), is_border_vertex_(surface_.vertices.size()) {
    find_normals();
}

void InnerLayer::find_normals() {
    std::vector<std::uint32_t> face_counts(elements_.edges.size());
    for (std::size_t f = 0; f < surface_.faces.size(); ++f) {
        const std::array<Vec3d, 3> p = corners(f);
        face_normals_[f] = unit_or_zero(cross(p[1] - p[0], p[2] - p[0]));
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d to_next = p[(k + 1) % 3] - p[k], to_last = p[(k + 2) % 3] - p[k];
            vertex_normals_[surface_.faces[f][k]] += face_normals_[f] * angle_between(to_next, to_last);
            const std::uint32_t edge = elements_.all[f].edges[k];
            edge_normals_[edge] += face_normals_[f];
            ++face_counts[edge];
        }
    }
    for (std::size_t edge = 0; edge < face_counts.size(); ++edge) {
        if (face_counts[edge] > 1) continue;
        is_border_edge_[edge] = true;
        for (const std::uint32_t end : elements_.edges[edge]) is_border_vertex_[end] = true;
    }
}

std::array<Vec3d, 3> InnerLayer::corners(std::size_t face) const {
    const auto& [a, b, c] = surface_.faces[face];
    return {Vec3d(surface_.vertices[a]), Vec3d(surface_.vertices[b]), Vec3d(surface_.vertices[c])};
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
    const auto [least, most] = least_and_most(corners(nearest.face), Vec3d(nearest.point));
    if (nearest.feature == Feature::Edge) {
        const std::uint32_t opposite = elements_.all[nearest.face].edges[(least + 1) % 3];
        return is_border_edge_[opposite] ? std::nullopt : std::optional(edge_normals_[opposite]);
    }
    const std::uint32_t vertex = surface_.faces[nearest.face][most];
    return is_border_vertex_[vertex] ? std::nullopt : std::optional(vertex_normals_[vertex]);
}

} // namespace echinus
