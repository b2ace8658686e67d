#include "recording/threads.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

using namespace echinus;

namespace {

constexpr std::uint32_t kSides = kTubeFaces / 2;
constexpr float kThickness = 0.3F; ///< as a share of the mean length of a piece

Vec3f unit_or_zero(const Vec3f& v) {
    const float size = length(v);
    return size > 0 ? v * (1 / size) : Vec3f{};
}

/// Any direction perpendicular to another one.
Vec3f across(const Vec3f& direction) {
    const Vec3f axis = std::fabs(direction.z) < 0.7F ? Vec3f{0, 0, 1} : Vec3f{1, 0, 0};
    return unit_or_zero(cross(direction, axis));
}

void add_tube(TriangleMesh& mesh, const Vec3f& from, const Vec3f& to, float radius) {
    const Vec3f direction = unit_or_zero(to - from);
    const Vec3f x = across(direction), y = cross(direction, x);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t side = 0; side < kSides; ++side) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(side) / kSides;
        const Vec3f radial = (x * std::cos(angle) + y * std::sin(angle)) * radius;
        mesh.vertices.insert(mesh.vertices.end(), {from + radial, to + radial});
    }
    for (std::uint32_t side = 0; side < kSides; ++side) {
        const std::uint32_t a = first + 2 * side, b = first + 2 * ((side + 1) % kSides);
        mesh.faces.insert(mesh.faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    }
}

} // namespace

std::vector<std::array<std::uint32_t, 2>> threads_of(const Deformable& cloth) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> face_edges;
    for (const auto& [a, b, c] : cloth.faces)
        for (const auto& edge : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)})
            face_edges.insert(edge);
    std::vector<std::array<std::uint32_t, 2>> threads;
    for (const DistanceConstraint& constraint : cloth.constraints)
        if (constraint.kind == ConstraintKind::Structural &&
            !face_edges.contains(std::minmax(constraint.a, constraint.b)))
            threads.push_back({constraint.a, constraint.b});
    return threads;
}

std::vector<Triangle> surface_of(const MeshAndEdges& cloth) {
    std::vector<Triangle> surface = cloth.mesh.faces;
    for (const auto& [a, b] : cloth.edges) surface.push_back({a, b, b});
    return surface;
}

std::vector<Triangle> surface_of(const Deformable& cloth) {
    return surface_of(MeshAndEdges{{{}, cloth.faces}, threads_of(cloth)});
}

VisibleSurface::VisibleSurface(const Deformable& deformable)
    : faces_(deformable.faces), threads_(threads_of(deformable)) {
    std::vector<std::uint32_t> vertex_of(deformable.particle_count());
    for (const Triangle& face : faces_)
        for (const std::uint32_t particle : face) vertex_of[particle] = 1;
    for (const auto& thread : threads_)
        for (const std::uint32_t particle : thread) vertex_of[particle] = 1;
    for (std::uint32_t particle = 0; particle < vertex_of.size(); ++particle) {
        if (vertex_of[particle] == 0) continue;
        vertex_of[particle] = static_cast<std::uint32_t>(particles_.size());
        particles_.push_back(particle);
    }
    for (Triangle& face : faces_)
        for (std::uint32_t& corner : face) corner = vertex_of[corner];
    for (auto& thread : threads_)
        for (std::uint32_t& end : thread) end = vertex_of[end];
}

std::vector<Vec3f> VisibleSurface::vertices(std::span<const Vec3f> positions) const {
    std::vector<Vec3f> result;
    result.reserve(particles_.size());
    for (const std::uint32_t particle : particles_) result.push_back(positions[particle]);
    return result;
}

MeshAndEdges VisibleSurface::mesh(std::span<const Vec3f> positions) const {
    return {{vertices(positions), faces_}, threads_};
}

TriangleMesh with_tubes(const MeshAndEdges& cloth) {
    TriangleMesh drawn = cloth.mesh;
    const auto end = [&](std::uint32_t vertex) { return cloth.mesh.vertices[vertex]; };
    float sum = 0;
    for (const auto& [a, b] : cloth.edges) sum += length(end(b) - end(a));
    const float radius = kThickness / 2 * sum / static_cast<float>(cloth.edges.size());
    for (const auto& [a, b] : cloth.edges) add_tube(drawn, end(a), end(b), radius);
    return drawn;
}
