#include "simulation/start/untangle.hpp"

#include "simulation/start/part_from_models.hpp"
#include "simulation/start/part_layers.hpp"
#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/elements.hpp"

#include <algorithm>
#include <cstddef>

namespace echinus {

namespace {

/// Layers that are separated may be moved into a model, and the reverse.
constexpr int kMostTurns = 4;

/// The gap by which layers are separated, as a share of their thickness, and its limits as shares of the mean
/// edge length. Contact does the rest.
constexpr float kGapInThicknesses = 0.5F;
constexpr float kLeastGap = 1.0F / 32;
constexpr float kMostGap = 1.0F / 8;

} // namespace

void untangle(Deformable& deformable, const std::vector<Collider>& colliders,
              const SimulationOptions& options) {
    const Elements elements = elements_of(deformable);
    std::vector<Vec3f> positions = deformable.positions;
    const float edge_length = mean_edge_length(elements, positions);
    const auto thickness = static_cast<float>(options.newton().self_thickness.value_or(*options.thickness));
    const float gap =
        std::clamp(kGapInThicknesses * thickness, kLeastGap * edge_length, kMostGap * edge_length);
    for (int turn = 0; turn < kMostTurns; ++turn) {
        const bool left_models = part_from_models(elements, deformable, colliders, options, positions);
        const bool face_moves = turn % 2 != 0; // moving the particle instead has led into a model
        const bool left_itself = options.layers_collide() &&
                                 part_layers(elements, deformable.inverse_masses, gap, face_moves, positions);
        if (!left_models && !left_itself) break;
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        deformable.positions[v] = positions[v];
    }
}

} // namespace echinus
