#include "simulation/start/model_pairs.hpp"

#include "directions/lattice.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/simulation.hpp>
#include <echinus/surface_queries.hpp>

#include <algorithm>
#include <utility>

namespace echinus {

namespace {

/// The positions of the mesh and of a particle are each inexact by less than a step.
constexpr float kTouchInSteps = 2;

} // namespace

ModelPairs::ModelPairs(const Collider& collider, std::vector<std::uint8_t> passes)
    : map_(map_of_surface(collider)->view()), local_(collider), body_(collider.pose, {1, 1, 1}),
      in_body_(model_mesh(map_, collider.scale)),
      is_mirrored_(collider.scale.x * collider.scale.y * collider.scale.z < 0), passes_(std::move(passes)) {
    std::uint32_t most = 0;
    for (std::uint32_t f = 0; f < map_.face_count(); ++f) most = std::max(most, map_.face_numbers[f]);
    in_map_.resize(std::size_t{most} + 1);
    for (std::uint32_t f = 0; f < map_.face_count(); ++f) in_map_[map_.face_numbers[f]] = f;
}

std::array<Vec3f, 3> ModelPairs::face(std::uint32_t number) const {
    auto [a, b, c] = in_body_.faces[in_map_[number]];
    if (is_mirrored_) std::swap(b, c);
    return {body_.point_to_world<float>(in_body_.vertices[a]),
            body_.point_to_world<float>(in_body_.vertices[b]),
            body_.point_to_world<float>(in_body_.vertices[c])};
}

ModelPairs::Found ModelPairs::with(const TriangleMesh& surface) const {
    Found found;
    if (surface.faces.empty()) return found;
    TriangleMesh moved = surface;
    for (Vec3f& p : moved.vertices) p = body_.point_to_local(p);
    found.intersecting = intersecting_pairs(moved, in_body_);
    std::erase_if(found.intersecting,
                  [&](const FacePair& pair) { return passes_through(surface.faces[pair.a], passes_); });
    for (FacePair& pair : found.intersecting) pair.b = map_.face_numbers[pair.b];
    std::sort(found.intersecting.begin(), found.intersecting.end());
    const float touch = kTouchInSteps * map_.radius / static_cast<float>(kLatticeExtent);
    std::size_t next = 0;
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
        while (next < found.intersecting.size() && found.intersecting[next].a < f) ++next;
        if (next < found.intersecting.size() && found.intersecting[next].a == f) continue;
        if (passes_through(surface.faces[f], passes_)) continue;
        const auto& [a, b, c] = surface.faces[f];
        const TrianglePoints corners{local_.point_to_local(surface.vertices[a]),
                                     local_.point_to_local(surface.vertices[b]),
                                     local_.point_to_local(surface.vertices[c])};
        if (clearance(map_, corners, touch).found()) found.touching.push_back(f);
    }
    return found;
}

} // namespace echinus
