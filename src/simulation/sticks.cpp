#include "simulation/sticks.hpp"

#include <algorithm>
#include <utility>

namespace echinus {

namespace {

/// Shorter runs are not worth a kernel's start.
constexpr std::size_t kShortestRun = 4;

std::pair<std::uint32_t, std::uint32_t> nth_stick(RunShape shape, std::uint32_t a, std::uint32_t b,
                                                  std::uint32_t n) {
    switch (shape) {
    case RunShape::SideBySide:
        return {a + n, b + n};
    case RunShape::Neighbours:
        return {a + 2 * n, b + 2 * n};
    case RunShape::EverySecond:
        return {a + 4 * (n / 2) + n % 2, b + 4 * (n / 2) + n % 2};
    case RunShape::Scattered:
        break;
    }
    return {a, b};
}

/// The most sticks that a run of this shape may have without two that share a particle.
std::size_t longest_run(RunShape shape, std::uint32_t a, std::uint32_t b) {
    constexpr auto kNoLimit = static_cast<std::size_t>(-1);
    switch (shape) {
    case RunShape::SideBySide:
        return a < b ? b - a : a - b;
    case RunShape::Neighbours:
        return b == a + 1 ? kNoLimit : 1;
    case RunShape::EverySecond:
        return b == a + 2 ? kNoLimit : 1;
    case RunShape::Scattered:
        break;
    }
    return 1;
}

std::size_t run_length(const StickArrays& sticks, std::size_t first, RunShape shape) {
    const std::uint32_t a = sticks.a[first], b = sticks.b[first];
    const std::size_t most = std::min(longest_run(shape, a, b), sticks.count() - first);
    std::size_t n = 1;
    for (; n < most; ++n) {
        const std::pair expected = nth_stick(shape, a, b, static_cast<std::uint32_t>(n));
        if (std::pair(sticks.a[first + n], sticks.b[first + n]) != expected) break;
        if (sticks.share_a[first + n] != sticks.share_a[first]) break;
        if (sticks.share_b[first + n] != sticks.share_b[first]) break;
        if (sticks.yield[first + n] != sticks.yield[first]) break;
    }
    return n;
}

StickRun longest_run_from(const StickArrays& sticks, std::size_t first) {
    StickRun run{.a = sticks.a[first],
                 .b = sticks.b[first],
                 .first = first,
                 .count = 1,
                 .share_a = sticks.share_a[first],
                 .share_b = sticks.share_b[first],
                 .yield = sticks.yield[first]};
    for (const RunShape shape : {RunShape::SideBySide, RunShape::Neighbours, RunShape::EverySecond}) {
        const std::size_t count = run_length(sticks, first, shape);
        if (count < kShortestRun || count <= run.count) continue;
        run.shape = shape;
        run.count = count;
    }
    return run;
}

std::vector<StickRun> runs_of(const StickArrays& sticks) {
    std::vector<StickRun> runs;
    for (std::size_t first = 0; first < sticks.count(); first += runs.back().count) {
        const StickRun run = longest_run_from(sticks, first);
        const bool continues =
            !runs.empty() && run.shape == RunShape::Scattered && runs.back().shape == RunShape::Scattered;
        if (!continues) {
            runs.push_back(run);
            continue;
        }
        first = runs.back().first;
        ++runs.back().count;
    }
    return runs;
}

/// How the ends share the correction, and what is left to the goal.
struct Shares {
    double a, b, yield;
};

/// Jakobsen 2001, section 4.
Shares shares_of_stick(double inverse_mass_a, double inverse_mass_b, double stiffness) {
    const double sum = inverse_mass_a + inverse_mass_b;
    return {stiffness * inverse_mass_a / sum, stiffness * inverse_mass_b / sum, 0};
}

Shares shares_of_spring(double inverse_mass_a, double inverse_mass_b, double compliance, double substep) {
    const double scaled_compliance = compliance / (substep * substep);
    const double sum = inverse_mass_a + inverse_mass_b + scaled_compliance;
    return {inverse_mass_a / sum, inverse_mass_b / sum, scaled_compliance / sum};
}

} // namespace

bool StickArrays::gives_way() const {
    return std::any_of(yield.begin(), yield.end(), [](float share) { return share != 0; });
}

StickArrays weighted_sticks(const Deformable& deformable, const SimulationOptions& options) {
    const double substep = options.time_step / options.substep_count;
    StickArrays sticks;
    for (const Stick& stick : deformable.sticks) {
        const double mass_a = deformable.inverse_masses[stick.a];
        const double mass_b = deformable.inverse_masses[stick.b];
        if (mass_a + mass_b == 0) continue; // both pinned
        const auto kind = static_cast<std::size_t>(stick.kind);
        const Shares shares = options.solver == SolverKind::Verlet
                                  ? shares_of_stick(mass_a, mass_b, options.stiffness[kind])
                                  : shares_of_spring(mass_a, mass_b, options.compliance[kind], substep);
        sticks.a.push_back(stick.a);
        sticks.b.push_back(stick.b);
        sticks.share_a.push_back(static_cast<float>(shares.a));
        sticks.share_b.push_back(static_cast<float>(shares.b));
        // After the last relaxation the goal is not used any more.
        const bool asked_again = options.iteration_count > 1;
        sticks.yield.push_back(asked_again ? static_cast<float>(shares.yield) : 0.0F);
        sticks.rest_lengths.push_back(stick.rest_length);
    }
    sticks.runs = runs_of(sticks);
    sticks.rest_lengths.resize(sticks.count() + PointArrays::kPadding);
    sticks.goal_lengths = sticks.rest_lengths;
    return sticks;
}

} // namespace echinus
