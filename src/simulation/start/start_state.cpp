#include "simulation/start/start_state.hpp"

#include "simulation/contact/thresholds.hpp"
#include "simulation/start/model_pairs.hpp"
#include "simulation/start/validation.hpp"
#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>

namespace echinus {

namespace {

constexpr std::size_t kNamed = 3;

/// @param way  the kind of collision that requires this
/// @param pinned  whether pinned particles are involved, which untangle() does not move
std::string remedy(const SimulationOptions& options, const char* way, bool pinned = false) {
    return std::string("; move the deformable until they are apart, ") +
           (options.newton().untangle || pinned ? "" : "set untangle to separate them, ") + "or do without " +
           way;
}

std::string name_of(const Elements& elements, std::uint32_t number) {
    const auto& [a, b, c] = elements.all[number].vertices;
    if (elements.all[number].is_face()) return "face " + std::to_string(number);
    if (a == b) return "particle " + std::to_string(a);
    return "the edge from particle " + std::to_string(a) + " to " + std::to_string(b);
}

/// @param what  the fault, such as "touching the box with", which precedes the number and `noun`
/// @param name  returns the name of one of them
template <typename Item, typename Name>
[[noreturn]] void refuse(const std::string& what, const std::vector<Item>& found, const char* noun,
                         const SimulationOptions& options, const char* way, const Name& name) {
    std::string sentence = "the deformable begins " + what + " " + std::to_string(found.size()) + " " + noun +
                           (found.size() == 1 ? "" : "s") +
                           (options.newton().untangle ? " that untangle could not separate: " : ": ");
    for (std::size_t i = 0; i < std::min(found.size(), kNamed); ++i)
        sentence += (i == 0 ? "" : ", ") + name(found[i]);
    if (found.size() > kNamed) sentence += ", ...";
    throw Error(ErrorCode::InvalidOptions, sentence + remedy(options, way));
}

void require_outside(const Deformable& deformable, std::span<const std::uint8_t> passes,
                     const Collider& collider, const SimulationOptions& options, const std::string& name) {
    const std::vector<float>& inverse_masses = deformable.inverse_masses;
    std::vector<std::uint8_t> inside(deformable.particle_count());
    contains_batch(collider, std::span(deformable.positions), inside);
    for (std::size_t v = 0; v < passes.size(); ++v)
        if (passes[v] != 0) inside[v] = 0;
    const auto first = std::find(inside.begin(), inside.end(), std::uint8_t{1});
    if (first == inside.end()) return;
    std::size_t pinned = 0;
    for (std::size_t v = 0; v < inside.size(); ++v)
        if (inside[v] != 0 && inverse_masses[v] == 0) ++pinned;
    const std::string count = std::to_string(std::count(inside.begin(), inside.end(), std::uint8_t{1}));
    throw Error(ErrorCode::InvalidOptions,
                count + " particles begin inside " + name +
                    (pinned > 0 ? ", " + std::to_string(pinned) + " of them pinned there" : "") +
                    (options.newton().untangle ? "; untangle could not move them out" : "") +
                    "; the first is particle " + std::to_string(first - inside.begin()) +
                    remedy(options, "collision of surfaces", pinned > 0));
}

void require_apart(const Deformable& deformable, const TriangleMesh& surface, const Elements& elements,
                   std::span<const std::uint8_t> passes, const Collider& collider,
                   const SimulationOptions& options, const std::string& name) {
    const ModelPairs pairs(collider, {passes.begin(), passes.end()});
    const auto [intersecting, touching] = pairs.with(surface);
    if (!intersecting.empty())
        refuse("intersecting " + name + " in", intersecting, "pair", options, "collision of surfaces",
               [&](const FacePair& pair) {
                   return name_of(elements, pair.a) + " of the deformable and face " +
                          std::to_string(pair.b) + " of " + name;
               });
    if (!touching.empty())
        refuse("touching " + name + " with", touching, "face", options, "collision of surfaces",
               [&](std::uint32_t face) { return name_of(elements, face); });
    // If nothing intersects, a piece is either entirely inside or entirely outside. An open surface has no
    // inside.
    if (pairs.has_inside())
        require_outside(deformable, passes, with_map(collider, *map_of_surface(collider)), options, name);
}

/// Layers that cannot come nearer to each other than this would keep the deformable in place. Particles
/// without edges have no layers.
void require_resolved(const Deformable& deformable, const Elements& elements) {
    float extent = 0;
    for (const Vec3f& v : deformable.positions)
        extent = std::max({extent, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    const float edge_length = mean_edge_length(elements, deformable.positions);
    const float least_gap = extent * threshold::kLeastGap;
    if (edge_length == 0 || !(least_gap > edge_length * threshold::kMostSelfThickness)) return;
    throw Error(ErrorCode::InvalidOptions,
                "the deformable begins " + std::to_string(extent) +
                    " from the origin, where floats separate its layers only from a distance of " +
                    std::to_string(least_gap) + " on, and its mean edge length is " +
                    std::to_string(edge_length) +
                    "; move the scene nearer to the origin, or do without self-collision");
}

} // namespace

void require_apart(const Deformable& deformable, const std::vector<Collider>& colliders,
                   const SimulationOptions& options) {
    const Elements elements = elements_of(deformable);
    // This comes first, because with such coarse floats faces also intersect.
    if (options.layers_collide()) require_resolved(deformable, elements);
    const TriangleMesh surface = surface_of(elements, deformable.positions);
    for (std::size_t i = 0; i < colliders.size(); ++i)
        if (map_of_surface(colliders[i]) != nullptr)
            require_apart(deformable, surface, elements, let_through(deformable, i), colliders[i], options,
                          name_of(colliders[i], i));
    if (!options.layers_collide()) return;
    const std::vector<FacePair> pairs = self_intersecting_pairs(surface);
    if (!pairs.empty())
        refuse("intersecting itself in", pairs, "pair", options, "self-collision", [&](const FacePair& pair) {
            return name_of(elements, pair.a) + " and " + name_of(elements, pair.b);
        });
}

void require_no_meeting(const Deformable& deformable, std::span<const Vec3f> places,
                        std::span<const std::uint8_t> passes, const Collider& collider,
                        const std::string& name) {
    const ExactMap* const map = map_of_surface(collider);
    if (map == nullptr) return;
    const TriangleMesh surface = surface_of(elements_of(deformable), places);
    const ModelPairs pairs(collider, {passes.begin(), passes.end()});
    const auto [intersecting, touching] = pairs.with(surface);
    std::size_t inside_count = 0;
    if (pairs.has_inside()) {
        std::vector<std::uint8_t> inside(places.size());
        contains_batch(with_map(collider, *map), places, inside);
        for (std::size_t v = 0; v < inside.size(); ++v)
            if (inside[v] != 0 && (passes.empty() || passes[v] == 0)) ++inside_count;
    }
    const std::size_t face_count = intersecting.size() + touching.size();
    if (face_count == 0 && inside_count == 0) return;
    throw Error(ErrorCode::InvalidOptions,
                "a teleport moves the deformable and " + name + " to where " +
                    (face_count > 0 ? std::to_string(face_count) + " pairs of their faces meet"
                                    : std::to_string(inside_count) + " particles are inside") +
                    "; choose another displacement, or teleport both together");
}

} // namespace echinus
