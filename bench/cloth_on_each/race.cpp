#include "race.hpp"

#include "rivals/compare/clock.hpp"

#include <algorithm>

using namespace echinus;

namespace {

constexpr std::uint32_t kTurn = 10; // frames

double median_of(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// One cloth on its way.
class Runner {
  public:
    Runner(const Scene& scene, const Contestant& contestant, const ExactMap& judge,
           const RaceOptions& options)
        : contestant_(contestant), judge_(judge), options_(options),
          simulation_(make_simulation(scene, contestant.map)) {}

    bool is_done() const {
        const bool is_timed = simulation_.frame() >= options_.first_timed + options_.timed_count;
        return simulation_.at_rest() || simulation_.frame() >= options_.frame_limit ||
               (is_timed && contestant_.only_timed);
    }

    void run_turn() {
        for (std::uint32_t i = 0; i < kTurn && !is_done(); ++i) run_frame();
    }

    Outcome outcome() const {
        Outcome result = outcome_;
        result.frames = simulation_.frame();
        result.rested = simulation_.at_rest();
        result.frame_ms = 1e3 * median_of(timed_);
        result.positions.assign(simulation_.positions().begin(), simulation_.positions().end());
        return result;
    }

  private:
    void run_frame() {
        if (simulation_.frame() % options_.judged_step == 0)
            judge_next_pushes(simulation_, contestant_.asked, judge_, outcome_.pushes);
        const std::uint32_t frame = simulation_.frame();
        const double start = comparison::thread_seconds();
        simulation_.step();
        const double seconds = comparison::thread_seconds() - start;
        if (frame >= options_.first_timed && frame < options_.first_timed + options_.timed_count)
            timed_.push_back(seconds);
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

    const Contestant& contestant_;
    const ExactMap& judge_;
    const RaceOptions& options_;
    Simulation simulation_;
    std::vector<double> timed_;
    std::vector<Contact> contacts_;
    Outcome outcome_;
};

} // namespace

void race(const Scene& scene, const TriangleMesh& mesh, const std::vector<Contestant>& contestants,
          const RaceOptions& options) {
    const ExactMap judge = ExactMap::build(mesh);
    std::vector<Runner> runners;
    runners.reserve(contestants.size());
    for (const Contestant& contestant : contestants) runners.emplace_back(scene, contestant, judge, options);
    bool all_done = false;
    for (std::uint32_t frame = kTurn; !all_done; frame += kTurn) {
        for (Runner& runner : runners) runner.run_turn();
        all_done = std::ranges::all_of(runners, &Runner::is_done);
        if (!all_done && frame % 100 != 0) continue;
        std::vector<Outcome> outcomes;
        for (const Runner& runner : runners) outcomes.push_back(runner.outcome());
        options.report(outcomes);
    }
}
