// The task solvers: how far cloth is stretched under each solver, beside the converged solution of the same
// mesh, and how long a frame takes; and how it hangs at rest by the length of a frame.

#include "commands/verdict.hpp"
#include "compare/turns.hpp"
#include "task.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <vector>

using namespace echinus;

namespace {

constexpr double kFramesPerSecond = 60; // of what is measured; a solver may take several steps for one

// ---- The solvers ----

struct Design {
    const char* name;
    bool is_paper = false; ///< the paper's solver
    double time_step = 1 / kFramesPerSecond;
    std::uint32_t newton_steps = 0; ///< 0: the default
    double tolerance = 0;           ///< 0: the default
};

constexpr Design kNewton{.name = "newton"};
constexpr Design kEightSteps{.name = "eight steps", .newton_steps = 8};
constexpr Design kConverged{.name = "converged", .newton_steps = 200, .tolerance = 1e-6};
constexpr Design kJakobsen{.name = "jakobsen", .is_paper = true, .time_step = 1.0 / 240};

SimulationOptions options_of(const Design& design) {
    SimulationOptions options;
    options.time_step = design.time_step;
    if (design.is_paper) options.solver = JakobsenOptions{.drag = 0};
    if (design.is_paper) return options;
    options.newton().air_drag = 0;
    if (design.newton_steps != 0) options.newton().step_count = design.newton_steps;
    if (design.tolerance != 0) options.newton().tolerance = design.tolerance;
    return options;
}

// ---- The problems: a square sheet of a metre ----

struct Problem {
    std::string name;
    Deformable cloth;
    std::vector<Collider> colliders{};
};

/// It lies level and swings down.
Problem hung_by_an_edge(std::uint32_t side) {
    ClothOptions sheet{.column_count = side, .row_count = side};
    for (std::uint32_t column = 0; column < side; ++column) sheet.pins.push_back(column);
    return {"hung by an edge", make_cloth(sheet)};
}

/// Patches of a sixteenth of the side are held, nearer to each other than they are at rest. The sheet begins
/// in waves, which nothing stretches.
Problem hung_by_two_corners(std::uint32_t side) {
    constexpr double kPatch = 1.0 / 16, kWaves = 4;
    constexpr double kSteepest = 0.64; // radians: the waves are nine tenths as long as the sheet
    const auto last = static_cast<double>(side - 1);
    ClothOptions sheet{.column_count = side, .row_count = side};
    for (std::uint32_t row = 0; row <= kPatch * last; ++row)
        for (std::uint32_t column = 0; column < side; ++column)
            if (std::min(column, side - 1 - column) <= kPatch * last)
                sheet.pins.push_back(row * side + column);
    Deformable cloth = make_cloth(sheet);
    cloth.rest_positions = cloth.positions;
    double along = 0, across = 0;
    for (std::uint32_t column = 0; column < side; ++column) {
        for (std::uint32_t row = 0; row < side; ++row)
            cloth.positions[row * side + column] = Vec3f(Vec3d{along, across, -(row / last)});
        const double angle = kSteepest * std::cos(2 * std::numbers::pi * kWaves * (column + 0.5) / last);
        along += std::cos(angle) / last;
        across += std::sin(angle) / last;
    }
    return {"hung by two corners", std::move(cloth)};
}

/// Off its middle, so that nothing is symmetric.
Problem fallen_on_a_ball(std::uint32_t side) {
    ClothOptions sheet{.column_count = side, .row_count = side};
    sheet.pose.translation = {0.013, 0.007, 0.35};
    return {"fallen on a ball", make_cloth(sheet), {{.map = ExactMap::build(make_sphere(0.3, 64, 32))}}};
}

Simulation simulation_of(const Problem& problem, SimulationOptions options) {
    if (options.kind() == SolverKind::Newton)
        options.newton().collision =
            problem.colliders.empty() ? CollisionMode::Particles : CollisionMode::Surfaces;
    return Simulation(problem.cloth, problem.colliders, options);
}

// ---- Strain and time while it moves ----

constexpr std::uint32_t kFirstMeasured = 12, kTurn = 6; // frames

/// One cloth on its way: means over the measured frames.
class Runner {
  public:
    Runner(const Problem& problem, const SimulationOptions& options)
        : simulation_(simulation_of(problem, options)) {}

    void run_turn(std::uint32_t first_frame) {
        const auto steps = std::lround(1 / (kFramesPerSecond * simulation_.options().time_step));
        for (std::uint32_t frame = first_frame; frame < first_frame + kTurn; ++frame) {
            const double start = comparison::thread_seconds();
            for (long i = 0; i < steps; ++i) simulation_.step();
            if (frame < kFirstMeasured) continue;
            seconds_ += comparison::thread_seconds() - start;
            const Strain strain = material_strain(simulation_.deformable()).value();
            sum_.mean += strain.mean;
            sum_.percentile_99 += strain.percentile_99;
            sum_.largest += strain.largest;
            ++count_;
        }
    }
    Records::Record record() const {
        return {{"strain_mean", fmt::format("{:.4g}", sum_.mean / count_)},
                {"strain_99", fmt::format("{:.4g}", sum_.percentile_99 / count_)},
                {"strain_largest", fmt::format("{:.4g}", sum_.largest / count_)},
                {"frame_ms", fmt::format("{:.4g}", 1e3 * seconds_ / count_)}};
    }

  private:
    Simulation simulation_;
    Strain sum_{};
    double seconds_ = 0;
    std::uint32_t count_ = 0; ///< of measured frames
};

struct Size {
    std::uint32_t side;
    std::vector<double> stiffnesses{1000}; ///< N/m
    bool is_converged = true;              ///< by a solution that takes minutes where the mesh is fine
    std::uint32_t frame_count = 60;
};

/// The designs take turns of a few frames, so that other load on the machine slows all alike.
void add_moving(const Problem& problem, const Size& size, double stiffness, const Setting& setting,
                Records& records) {
    std::vector<Design> designs{kNewton, kEightSteps};
    if (stiffness == size.stiffnesses[0]) designs.push_back(kJakobsen); // for which it means nothing
    if (size.is_converged) designs.push_back(kConverged);
    std::vector<Runner> runners;
    for (const Design& design : designs) {
        SimulationOptions options = options_of(design);
        if (options.kind() == SolverKind::Newton) {
            options.newton().material.stretch_stiffness = stiffness;
            options.newton().material.shear_stiffness = 0.4 * stiffness;
        }
        runners.emplace_back(problem, options);
    }
    for (std::uint32_t frame = 0; frame < size.frame_count; frame += kTurn) {
        for (Runner& runner : runners) runner.run_turn(frame);
        setting.report_progress(fmt::format("{}, {} a side, {} N/m", problem.name, size.side, stiffness),
                                static_cast<double>(frame + kTurn) / size.frame_count);
    }
    for (std::size_t k = 0; k < designs.size(); ++k) {
        Records::Record record = runners[k].record();
        record.insert({{"state", "moving"},
                       {"problem", problem.name},
                       {"side", fmt::format("{}", size.side)},
                       {"stiffness", fmt::format("{}", stiffness)},
                       {"frames_per_second", fmt::format("{}", kFramesPerSecond)},
                       {"design", designs[k].name}});
        records.add(std::move(record));
    }
}

// ---- At rest ----

double root_mean_square_distance(std::span<const Vec3f> a, std::span<const Vec3f> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vec3d way = Vec3d(a[i]) - Vec3d(b[i]);
        sum += dot(way, way);
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Damped, so that it is at rest in the end, with the shape and the strain that damping does not decide.
void add_at_rest(const Problem& problem, std::uint32_t side, const Setting& setting, Records& records) {
    constexpr double kSeconds = 8;
    std::vector<Vec3f> at_60;
    for (const double pace : {60.0, 30.0, 240.0}) {
        SimulationOptions options = options_of({.name = "", .time_step = 1 / pace});
        options.newton().material.damping = 0.2;
        options.newton().air_drag = 2;
        Simulation simulation = simulation_of(problem, options);
        const auto frame_count = static_cast<std::uint32_t>((setting.is_short ? 0.1 : kSeconds) * pace);
        for (std::uint32_t i = 0; i < frame_count; ++i) {
            simulation.step();
            setting.report_progress(fmt::format("{}, at rest, 1/{} s", problem.name, pace),
                                    double(i + 1) / frame_count);
        }
        if (at_60.empty()) at_60.assign(simulation.positions().begin(), simulation.positions().end());
        const Strain strain = material_strain(simulation.deformable()).value();
        records.add(
            {{"state", "at rest"},
             {"problem", problem.name},
             {"side", fmt::format("{}", side)},
             {"stiffness", fmt::format("{}", options.newton().material.stretch_stiffness)},
             {"frames_per_second", fmt::format("{}", pace)},
             {"design", "newton"},
             {"strain_mean", fmt::format("{:.4g}", strain.mean)},
             {"strain_99", fmt::format("{:.4g}", strain.percentile_99)},
             {"strain_largest", fmt::format("{:.4g}", strain.largest)},
             {"away", fmt::format("{:.4g}", root_mean_square_distance(simulation.positions(), at_60))},
             {"speed", fmt::format("{:.3g}", simulation.largest_speed())}});
    }
}

} // namespace

Records measure_solvers(const Setting& setting) {
    Records records({"state", "problem", "side", "stiffness", "frames_per_second", "design", "strain_mean",
                     "strain_99", "strain_largest", "frame_ms", "away", "speed"});
    struct Measured {
        Problem (*problem_at)(std::uint32_t side);
        std::vector<Size> sizes;
        std::uint32_t side_at_rest;
    };
    const std::vector<Size> hung{{.side = 33, .stiffnesses = {1000, 500, 5000}},
                                 {.side = 100},
                                 {.side = 316, .is_converged = false, .frame_count = 30}};
    const std::vector<Size> fallen{{.side = 33}, {.side = 100, .is_converged = false}};
    std::vector<Measured> all{
        {hung_by_an_edge, hung, 33}, {hung_by_two_corners, hung, 33}, {fallen_on_a_ball, fallen, 17}};
    if (setting.is_short)
        for (Measured& measured : all) measured.sizes = {{.side = measured.side_at_rest = 13}};
    for (const auto& [problem_at, sizes, side_at_rest] : all) {
        for (const Size& size : sizes) {
            const Problem problem = problem_at(size.side);
            for (const double stiffness : size.stiffnesses) {
                add_moving(problem, size, stiffness, setting, records);
                setting.store(records);
            }
        }
        add_at_rest(problem_at(side_at_rest), side_at_rest, setting, records);
        setting.store(records);
    }
    return records;
}
