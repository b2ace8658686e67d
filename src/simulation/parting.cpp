#include "simulation/start/untangle.hpp"
#include "simulation/start/validation.hpp"
#include "simulation/surface_layers.hpp"
#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/surface_collision.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// The thickness, in mean edge lengths, that a parted surface keeps by default.
constexpr double kDefaultThickness = 0.1;
/// The largest thickness, in mean edge lengths. The number of faces that a vertex has to keep off grows with
/// its square; twice as much takes gigabytes.
constexpr double kMostThicknessInEdges = 4;
/// The largest number of frames in which the material contracts, and the largest displacement of a particle
/// in a frame, in mean edge lengths, with which it counts as contracted.
constexpr int kMostFrames = 30;
constexpr double kContracted = 0.01;
/// The share of the work that untangling takes in the progress.
constexpr double kUntanglingShare = 0.8;
/// The change of an edge's length, as a share of it, above which the edge counts as stretched.
constexpr double kStretched = 0.05;

SimulationOptions simulation_options(const PartOptions& options, double edge_length) {
    SimulationOptions all;
    all.gravity = {};
    // The air is so thick that the material contracts without swinging.
    all.solver = NewtonOptions{.material = options.material, .air_drag = 1 / all.time_step};
    all.thickness = options.thickness.value_or(kDefaultThickness * edge_length);
    all.thread_count = options.thread_count;
    return all;
}

/// The surface in its own frame.
Deformable deformable_of(TriangleMesh surface) {
    surface.origin = {};
    Deformable deformable = make_cloth(surface, {});
    deformable.rest_positions = deformable.positions;
    return deformable;
}

void pin(Deformable& deformable, std::span<const std::uint8_t> pinned) {
    for (std::size_t v = 0; v < pinned.size(); ++v)
        if (pinned[v] != 0) deformable.inverse_masses[v] = 0;
}

/// Calls a function, and names the mesh of which its errors speak.
auto with_name(const std::string& name, const auto& function) {
    try {
        return function();
    } catch (const Error& error) {
        throw Error(error.code(), name + ": " + error.what());
    }
}

/// The meshes in the frame of the surface, which becomes their only one.
std::vector<TriangleMesh> in_frame(const Vec3d& origin, std::span<const TriangleMesh> meshes) {
    std::vector<TriangleMesh> moved(meshes.begin(), meshes.end());
    for (TriangleMesh& mesh : moved) {
        const Vec3d offset = mesh.origin - origin;
        if (offset != Vec3d{})
            for (Vec3f& vertex : mesh.vertices) vertex = Vec3f(Vec3d(vertex) + offset);
        mesh.origin = {};
    }
    return moved;
}

std::vector<Collider> colliders_of(std::span<const TriangleMesh> models) {
    std::vector<Collider> colliders;
    for (std::size_t i = 0; i < models.size(); ++i) {
        const std::string name = "model " + std::to_string(i);
        colliders.push_back({.map = with_name(name, [&] { return ExactMap::build(models[i]); })});
        colliders.back().name = name;
    }
    return colliders;
}

/// Separates one layer after the other from the models and from the layers inside of it.
/// @return whether nothing intersects
bool untangle_layers(const TriangleMesh& surface, const std::vector<Collider>& colliders,
                     const SimulationOptions& simulation, const PartOptions& options,
                     std::vector<Vec3f>& positions) {
    std::vector<SurfaceLayer> layers = layers_of(surface, options);
    std::vector<InnerLayer> inner;
    bool is_apart = true;
    for (SurfaceLayer& layer : layers) {
        const auto progress = [&](double share) {
            if (options.progress)
                options.progress(kUntanglingShare * (static_cast<double>(inner.size()) + share) /
                                 static_cast<double>(layers.size()));
        };
        Deformable deformable = deformable_of(layer.mesh);
        pin(deformable, layer.pinned);
        std::optional<std::span<const InnerLayer>> inside;
        if (!options.layers.empty()) inside = inner;
        is_apart = untangle(deformable, colliders, simulation, inside, progress) && is_apart;
        for (std::size_t v = 0; v < layer.vertices.size(); ++v)
            positions[layer.vertices[v]] = deformable.positions[v];
        if (&layer == &layers.back()) break; // nothing is outside of it
        layer.mesh.vertices = deformable.positions;
        turn_outward(layer.mesh, colliders);
        inner.push_back(with_name("layer " + std::to_string(inner.size()),
                                  [&] { return InnerLayer(std::move(layer.mesh)); }));
    }
    return is_apart;
}

/// Lets the material contract without leaving what untangling has found.
void contract(Deformable& deformable, const std::vector<Collider>& colliders,
              const SimulationOptions& options, double edge_length, const PartOptions& part_options) {
    Simulation simulation(deformable, colliders, options);
    for (int frame = 0; frame < kMostFrames; ++frame) {
        if (part_options.progress)
            part_options.progress(kUntanglingShare + (1 - kUntanglingShare) * frame / kMostFrames);
        simulation.step();
        if (simulation.largest_speed() * options.time_step < kContracted * edge_length) break;
    }
    deformable.positions = simulation.deformable().positions;
}

void find_remaining(const TriangleMesh& surface, std::span<const TriangleMesh> models,
                    const std::vector<Collider>& colliders, unsigned thread_count, Parted& parted) {
    TriangleMesh moved{parted.vertices, surface.faces};
    parted.own_pairs = self_intersecting_pairs(moved);
    for (const TriangleMesh& model : models) parted.model_pairs.push_back(intersecting_pairs(moved, model));
    std::vector<std::uint8_t> inside(moved.vertices.size()), in_any(moved.vertices.size());
    for (const Collider& collider : colliders) {
        if (!has_inside(collider)) continue;
        contains_batch(collider, moved.vertices, inside, thread_count);
        for (std::size_t v = 0; v < inside.size(); ++v) in_any[v] |= inside[v];
    }
    for (std::uint32_t v = 0; v < in_any.size(); ++v)
        if (in_any[v] != 0) parted.inside.push_back(v);
}

void measure_changes(const Elements& elements, std::span<const Vec3f> before, Parted& parted) {
    for (std::size_t v = 0; v < before.size(); ++v)
        parted.largest_displacement =
            std::max(parted.largest_displacement, double{length(parted.vertices[v] - before[v])});
    std::size_t stretched_count = 0;
    for (const auto& [a, b] : elements.edges) {
        const double length_before = double{length(before[a] - before[b])};
        if (!(length_before > 0)) continue;
        const double stretch = double{length(parted.vertices[a] - parted.vertices[b])} / length_before - 1;
        parted.largest_stretch = std::max(parted.largest_stretch, stretch);
        if (std::abs(stretch) > kStretched) ++stretched_count;
    }
    if (!elements.edges.empty())
        parted.stretched_share =
            static_cast<double>(stretched_count) / static_cast<double>(elements.edges.size());
}

} // namespace

bool Parted::is_apart() const {
    return own_pairs.empty() && inside.empty() &&
           std::all_of(model_pairs.begin(), model_pairs.end(),
                       [](const std::vector<FacePair>& pairs) { return pairs.empty(); });
}

Parted part(const TriangleMesh& surface, std::span<const TriangleMesh> given_models,
            const PartOptions& options) {
    const std::vector<TriangleMesh> models = in_frame(surface.origin, given_models);
    Deformable deformable = deformable_of(surface);
    require_layers(surface, options);
    pin(deformable, options.pinned);
    const std::vector<Collider> colliders = colliders_of(models);
    const Elements elements = elements_of(deformable);
    const double edge_length = double{mean_edge_length(elements, deformable.positions)};
    const SimulationOptions simulation = simulation_options(options, edge_length);
    require_valid(simulation);
    require_option(*simulation.thickness > 0, "the thickness is 0; parted surfaces need a distance");
    require_option(*simulation.thickness <= kMostThicknessInEdges * edge_length,
                   "the thickness is more than four times the mean edge length");
    require_valid(deformable);
    require_valid(colliders, simulation);
    Parted parted{.vertices = deformable.positions};
    find_remaining(surface, models, colliders, options.thread_count, parted);
    if (options.layers.empty() && parted.is_apart()) return parted;
    const bool is_apart = untangle_layers(surface, colliders, simulation, options, deformable.positions);
    if (deformable.positions == parted.vertices) return parted;
    if (is_apart) contract(deformable, colliders, simulation, edge_length, options);
    if (options.progress) options.progress(1);
    parted = Parted{.vertices = deformable.positions};
    find_remaining(surface, models, colliders, options.thread_count, parted);
    measure_changes(elements, surface.vertices, parted);
    return parted;
}

} // namespace echinus
