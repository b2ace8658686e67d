#include "cloth_run.hpp"

#include "compare/clock.hpp"
#include "compare/turns.hpp"

#include <algorithm>

using namespace echinus;

namespace {

constexpr std::uint32_t kTurn = 10; // frames

/// The maps are compared by what keeps particles out, which all of them can.
Scene of_particles(Scene scene) {
    scene.simulation.surface_collision = scene.simulation.self_collision = scene.simulation.untangle = false;
    return scene;
}

/// One cloth on its way.
class Runner {
  public:
    Runner(const ClothScene& scene, const ClothSystem& system, const ExactMap& judge,
           const ClothLimits& limits)
        : system_(system), judge_(judge), limits_(limits),
          simulation_(make_simulation(of_particles(scene.scene), system.map)) {}

    bool is_done() const {
        const std::uint32_t frame = simulation_.frame();
        return simulation_.at_rest() || frame >= limits_.frame_limit ||
               (system_.only_timed && frame >= limits_.first_timed + limits_.timed_count);
    }

    void run_turn() {
        for (std::uint32_t i = 0; i < kTurn && !is_done(); ++i) run_frame();
    }

    double progress() const {
        return is_done() ? 1 : static_cast<double>(simulation_.frame()) / limits_.frame_limit;
    }

    ClothOutcome outcome() const {
        ClothOutcome result = outcome_;
        result.frames = simulation_.frame();
        result.rested = simulation_.at_rest();
        const auto per_frame = [&](double seconds) {
            return timed_.empty() ? 0 : 1e3 * seconds / static_cast<double>(timed_.size());
        };
        result.frame_ms = 1e3 * comparison::median_of(timed_);
        result.constraint_ms = per_frame(after_.constraint_seconds - before_.constraint_seconds);
        result.collision_ms = per_frame(after_.collision_seconds - before_.collision_seconds);
        return result;
    }

  private:
    void run_frame() {
        const std::uint32_t frame = simulation_.frame();
        if (frame == limits_.first_timed) before_ = simulation_.profile();
        const double start = comparison::thread_seconds();
        simulation_.step();
        if (frame >= limits_.first_timed && frame < limits_.first_timed + limits_.timed_count) {
            timed_.push_back(comparison::thread_seconds() - start);
            after_ = simulation_.profile();
        }
        judge_places();
    }

    void judge_places() {
        const auto& positions = simulation_.deformable().positions;
        contacts_.resize(positions.size());
        Collider collider = simulation_.colliders().front();
        collider.map = judge_;
        contacts_batch(collider, std::span(positions), 0, contacts_);
        outcome_.inside_at_end = 0;
        outcome_.deepest_at_end = 0;
        for (const Contact& contact : contacts_) {
            if (!contact.inside) continue;
            ++outcome_.inside_at_end;
            outcome_.deepest_at_end =
                std::max(outcome_.deepest_at_end, double{contact.depth} / double{judge_.view().radius});
        }
        outcome_.deepest = std::max(outcome_.deepest, outcome_.deepest_at_end);
    }

    const ClothSystem& system_;
    const ExactMap& judge_;
    const ClothLimits& limits_;
    Simulation simulation_;
    SimulationProfile before_, after_;
    std::vector<double> timed_;
    std::vector<Contact> contacts_;
    ClothOutcome outcome_;
};

} // namespace

std::vector<ClothOutcome> run_cloths(const ClothScene& scene, const std::vector<ClothSystem>& systems,
                                     const ClothLimits& limits,
                                     const std::function<void(double)>& report_progress) {
    const ExactMap judge = ExactMap::build(scene.mesh);
    std::vector<Runner> runners;
    runners.reserve(systems.size());
    for (const ClothSystem& system : systems) runners.emplace_back(scene, system, judge, limits);
    while (!std::ranges::all_of(runners, &Runner::is_done)) {
        double progress = 1;
        for (Runner& runner : runners) {
            runner.run_turn();
            progress = std::min(progress, runner.progress());
        }
        report_progress(progress);
    }
    std::vector<ClothOutcome> outcomes;
    for (const Runner& runner : runners) outcomes.push_back(runner.outcome());
    return outcomes;
}
