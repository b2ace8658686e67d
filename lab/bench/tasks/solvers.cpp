// The task solvers: what a large cloth that hangs stretches under each solver, and how long its frame takes.

#include "compare/turns.hpp"
#include "task.hpp"

#include <echinus/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace echinus;

namespace {

struct Design {
    std::string name;
    SimulationOptions options;
};

Design newton(std::uint32_t steps) {
    SimulationOptions options;
    options.newton_step_count = steps;
    return {fmt::format("newton, {} steps", steps), options};
}

/// At the pace that it needs: four frames for one of the other.
Design jakobsen(std::uint32_t iterations) {
    SimulationOptions options;
    options.solver = SolverKind::Jakobsen;
    options.time_step = 1.0 / 240;
    options.iteration_count = iterations;
    return {fmt::format("jakobsen, {} relaxations", iterations), options};
}

std::vector<Design> designs() {
    return {newton(4), newton(1), newton(2), newton(8), jakobsen(10), jakobsen(40), jakobsen(160)};
}

/// A square of one unit that hangs down along y from its whole first row, or from its two corners, which
/// stand nearer together so that it falls in folds.
Deformable hanging(std::uint32_t side, bool by_corners) {
    std::vector<std::uint32_t> pins;
    for (std::uint32_t c = 0; c < side; c += by_corners ? side - 1 : 1) pins.push_back(c);
    Deformable cloth = make_cloth({.column_count = side, .row_count = side, .pins = pins});
    if (!by_corners) return cloth;
    cloth.rest_positions = cloth.positions;
    for (Vec3f& p : cloth.positions) {
        p.z = 0.02F * static_cast<float>(std::sin(20 * double{p.x}));
        p.x *= 0.9F;
    }
    cloth.previous_positions = cloth.positions;
    return cloth;
}

/// One cloth on its way; the last frames are timed.
class Runner {
  public:
    Runner(const Design& design, const Deformable& cloth)
        : simulation_(cloth, {}, with_gravity_along_rows(design.options)) {}

    /// @param frame_count  of 1/60 s each
    void run_turn(std::uint32_t frame_count, bool is_timed) {
        const auto steps =
            static_cast<std::uint32_t>(std::lround(frame_count / (60 * simulation_.options().time_step)));
        const double start = comparison::thread_seconds();
        for (std::uint32_t i = 0; i < steps; ++i) simulation_.step();
        if (is_timed) frame_seconds_.push_back((comparison::thread_seconds() - start) / frame_count);
    }
    const Simulation& simulation() const { return simulation_; }
    double frame_ms() const { return 1e3 * comparison::median_of(frame_seconds_); }

  private:
    static SimulationOptions with_gravity_along_rows(SimulationOptions options) {
        options.gravity = {0, 9.81, 0};
        return options;
    }

    Simulation simulation_;
    std::vector<double> frame_seconds_;
};

/// Of structural sticks, longer than at rest; that of the given share.
double stretch_of(const Deformable& cloth, double share) {
    std::vector<double> stretches;
    for (const Stick& stick : cloth.sticks) {
        if (stick.kind != StickKind::Structural) continue;
        const Vec3d across = Vec3d(cloth.positions[stick.b]) - Vec3d(cloth.positions[stick.a]);
        stretches.push_back(length(across) / double{stick.rest_length} - 1);
    }
    std::sort(stretches.begin(), stretches.end());
    return stretches[static_cast<std::size_t>(share * static_cast<double>(stretches.size() - 1))];
}

/// How far the middle column reaches, over its length.
double column_stretch(const Deformable& cloth, std::uint32_t side) {
    double sum = 0;
    for (std::uint32_t row = 1; row < side; ++row)
        sum += double{
            length(cloth.positions[row * side + side / 2] - cloth.positions[(row - 1) * side + side / 2])};
    return sum - 1;
}

} // namespace

Records measure_solvers(const Setting& setting) {
    Records records({"hangs", "design", "particles", "frame_ms", "ratio", "column_stretch", "stretch_99",
                     "stretch_largest", "residual", "speed"});
    const std::uint32_t side = setting.is_short ? 100 : 316;
    const std::uint32_t settling = setting.is_short ? 15 : 120, turn = 2, turn_count = 10;
    for (const bool by_corners : {false, true}) {
        const char* const hangs = by_corners ? "by two corners" : "by an edge";
        const Deformable cloth = hanging(side, by_corners);
        std::vector<Design> all = designs();
        std::vector<Runner> runners;
        runners.reserve(all.size());
        for (const Design& design : all) {
            setting.report_progress(fmt::format("{} {}", hangs, design.name), 0);
            runners.emplace_back(design, cloth).run_turn(settling, false);
        }
        for (std::uint32_t i = 0; i < turn_count; ++i)
            for (Runner& runner : runners) runner.run_turn(turn, true);
        for (std::size_t k = 0; k < all.size(); ++k) {
            const Simulation& simulation = runners[k].simulation();
            const Deformable& now = simulation.deformable();
            records.add({{"hangs", hangs},
                         {"design", all[k].name},
                         {"particles", fmt::format("{}", now.particle_count())},
                         {"frame_ms", fmt::format("{:.4g}", runners[k].frame_ms())},
                         {"ratio", fmt::format("{:.3g}", runners[k].frame_ms() / runners[0].frame_ms())},
                         {"column_stretch", fmt::format("{:.3g}", column_stretch(now, side))},
                         {"stretch_99", fmt::format("{:.3g}", stretch_of(now, 0.99))},
                         {"stretch_largest", fmt::format("{:.3g}", stretch_of(now, 1))},
                         {"residual", fmt::format("{:.3g}", simulation.residual().root_mean_square)},
                         {"speed", fmt::format("{:.3g}", simulation.largest_speed())}});
        }
    }
    return records;
}
