#include "simulation/start/untangle.hpp"

#include "simulation/elastic_parts.hpp"
#include "simulation/jakobsen/collider_now.hpp"
#include "simulation/start/layer_openings.hpp"
#include "simulation/start/model_openings.hpp"
#include "simulation/start/thresholds.hpp"
#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace echinus {

namespace {

constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();

/// The positions with the fewest intersections found.
struct Untangled {
    std::vector<Vec3f> positions;
    std::size_t tangle_count = kUnknown; ///< intersecting pairs, touching faces and particles inside
};

/// An attempt to separate a deformable from models and from itself: a material that starts at rest and is
/// pulled apart round by round.
class Attempt {
  public:
    Attempt(const Deformable& deformable, const std::vector<Collider>& colliders,
            const SimulationOptions& options, std::span<const InnerLayer> inner_layers, ExitSide side)
        : deformable_(deformable), options_(options), elements_(elements_of(deformable)),
          step_(elastic_parts(deformable, options)), motion_(deformable.particle_count()),
          is_held_(deformable.particle_count()), no_forces_(deformable.particle_count()),
          workers_(options.thread_count), edge_length_(mean_edge_length(elements_, deformable.positions)) {
        for (std::size_t i = 0; i < is_held_.size(); ++i)
            is_held_[i] = deformable.inverse_masses[i] == 0 ? 1 : 0;
        for (std::size_t c = 0; c < colliders.size(); ++c)
            if (map_of_surface(colliders[c]) != nullptr)
                models_.emplace_back(elements_, colliders[c], let_through(deformable, c),
                                     ColliderNow(colliders[c], colliders[c].pose, options).thickness,
                                     edge_length_, side);
        for (const InnerLayer& layer : inner_layers)
            models_.emplace_back(elements_, layer, layer_gap(), edge_length_, side);
        find_stiffnesses();
    }
    Attempt(const Attempt&) = delete; // the models refer to the elements
    Attempt& operator=(const Attempt&) = delete;

    Untangled run(const std::function<void(double share)>& progress) {
        const Workers::Session session(workers_);
        Untangled best;
        double stiffness = 1, least_depths = std::numeric_limits<double>::infinity();
        std::size_t initial_count = 0;
        int idle_rounds = 0;
        for (int round = 0; round < threshold::kMostRounds; ++round) {
            Openings openings;
            const std::size_t count = find(openings.all);
            const bool is_fewer = count < best.tangle_count;
            const bool is_nearer = depths() < threshold::kNearer * least_depths;
            if (is_nearer) least_depths = depths();
            if (is_fewer) best = {deformable_.positions, count};
            if (round == 0) initial_count = std::max(count, std::size_t{1});
            progress(1 - static_cast<double>(best.tangle_count) / static_cast<double>(initial_count));
            idle_rounds = is_fewer || is_nearer ? 0 : idle_rounds + 1;
            if (count == 0 || idle_rounds > threshold::kPatience) break;
            if (count > threshold::kFarWorse * best.tangle_count + threshold::kFewPairs) break;
            if (idle_rounds > 0)
                stiffness = std::min(stiffness * threshold::kStiffening, threshold::kMostStiffness);
            if (idle_rounds > 0 && idle_rounds % threshold::kYieldAfter == 0) yield();
            if (!move(openings, stiffness)) break;
        }
        return best;
    }

  private:
    void find_stiffnesses() {
        load_places();
        stiffnesses_ = step_.stiffnesses(motion_.places, workers_);
        const std::span<const double> masses = step_.masses();
        const double stiffness = std::accumulate(stiffnesses_.begin(), stiffnesses_.end(), 0.0);
        const double mass = std::accumulate(masses.begin(), masses.end(), 0.0);
        if (stiffness > 0) seconds_ = std::sqrt(mass / (threshold::kInertiaShare * stiffness));
        for (std::size_t i = 0; i < stiffnesses_.size(); ++i)
            stiffnesses_[i] += masses[i] / (seconds_ * seconds_);
    }

    void load_places() {
        for (std::size_t i = 0; i < motion_.particle_count(); ++i)
            motion_.places[i] = Vec3d(deformable_.positions[i]);
    }

    /// @return the number of tangles
    std::size_t find(std::vector<Opening>& openings) {
        const std::span<const Vec3f> positions = deformable_.positions;
        std::size_t count = 0;
        for (ModelOpenings& model : models_) count += model.add(positions, openings);
        if (options_.layers_collide())
            count += add_layer_openings(elements_, positions, layer_gap(), edge_length_, openings);
        return count;
    }

    float layer_gap() const {
        const auto thickness =
            static_cast<float>(options_.newton().self_thickness.value_or(*options_.thickness));
        return std::clamp(threshold::kGapInThicknesses * thickness, threshold::kLeastLayerGap * edge_length_,
                          threshold::kMostLayerGap * edge_length_);
    }

    double depths() const {
        double sum = 0;
        for (const ModelOpenings& model : models_) sum += model.depths();
        return sum;
    }

    /// Makes the present shape the shape at rest.
    void yield() {
        deformable_.rest_positions = deformable_.positions;
        step_ = ImplicitStep(elastic_parts(deformable_, options_));
    }

    /// @param stiffness  of what opens the gaps, in stiffnesses of the material
    /// @return false if the material is so distorted that no step is possible
    bool move(Openings& openings, double stiffness) {
        for (Opening& opening : openings.all)
            for (std::size_t k = 0; k < Opening::kMostParts; ++k)
                opening.stiffness +=
                    stiffness * std::abs(opening.weights[k]) * stiffnesses_[opening.particles[k]];
        load_places();
        step_.begin(motion_, no_forces_, is_held_, seconds_);
        std::vector<Vec3d> places = motion_.places;
        step_.solve(places, &openings, {.newton_steps = threshold::kStepsPerRound}, workers_);
        std::transform(places.begin(), places.end(), deformable_.positions.begin(),
                       [](const Vec3d& place) { return Vec3f(place); });
        return std::all_of(deformable_.positions.begin(), deformable_.positions.end(),
                           [](const Vec3f& position) { return is_finite(position); });
    }

    Deformable deformable_;
    const SimulationOptions& options_;
    Elements elements_;
    ImplicitStep step_;
    Motion motion_; ///< without velocities
    std::vector<std::uint8_t> is_held_;
    std::vector<Vec3d> no_forces_;
    Workers workers_;
    float edge_length_;
    std::vector<ModelOpenings> models_;
    std::vector<double> stiffnesses_; ///< [particle] of the material and of inertia
    double seconds_ = 1;              ///< the duration of a step
};

} // namespace

bool untangle(Deformable& deformable, const std::vector<Collider>& colliders,
              const SimulationOptions& options, std::optional<std::span<const InnerLayer>> inner_layers,
              const std::function<void(double share)>& progress) {
    std::vector<ExitSide> sides{ExitSide::Nearest};
    if (!inner_layers && !colliders.empty()) sides.insert(sides.end(), {ExitSide::Front, ExitSide::Back});
    Deformable start = deformable;
    Untangled best;
    double reported = 0;
    const auto report = [&](double share) { // an attempt that starts again does not go back
        reported = std::max(reported, share);
        if (progress) progress(reported);
    };
    // A start that has become better is worth another pass, with its shape as the one at rest.
    std::size_t before = kUnknown;
    do {
        before = best.tangle_count;
        for (const ExitSide side : sides) {
            Untangled found =
                Attempt(start, colliders, options, inner_layers.value_or(std::span<const InnerLayer>()), side)
                    .run(report);
            if (found.tangle_count < best.tangle_count) best = std::move(found);
            if (best.tangle_count == 0) break;
        }
        start.positions = start.rest_positions = best.positions;
    } while (best.tangle_count > 0 && best.tangle_count <= before / 2);
    deformable.positions = std::move(best.positions);
    return best.tangle_count == 0;
}

} // namespace echinus
