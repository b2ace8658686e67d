#include "simulation/sticks.hpp"

#include <algorithm>
#include <array>
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
    case RunShape::Disjoint:
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
    case RunShape::Disjoint:
    case RunShape::Scattered:
        break;
    }
    return 1;
}

std::size_t run_length(const StickArrays& sticks, std::size_t first, std::size_t end, RunShape shape) {
    const std::uint32_t a = sticks.a[first], b = sticks.b[first];
    const std::size_t most = std::min(longest_run(shape, a, b), end - first);
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

StickRun longest_run_from(const StickArrays& sticks, std::size_t first, std::size_t end) {
    StickRun run{.a = sticks.a[first],
                 .b = sticks.b[first],
                 .first = first,
                 .count = 1,
                 .share_a = sticks.share_a[first],
                 .share_b = sticks.share_b[first],
                 .yield = sticks.yield[first]};
    for (const RunShape shape : {RunShape::SideBySide, RunShape::Neighbours, RunShape::EverySecond}) {
        const std::size_t count = run_length(sticks, first, end, shape);
        if (count < kShortestRun || count <= run.count) continue;
        run.shape = shape;
        run.count = count;
    }
    return run;
}

/// Adds a run, or makes the last one longer where both are scattered.
void add(std::vector<StickRun>& runs, const StickRun& run) {
    const bool continues =
        !runs.empty() && run.shape == RunShape::Scattered && runs.back().shape == RunShape::Scattered;
    if (continues)
        runs.back().count += run.count;
    else
        runs.push_back(run);
}

/// Cuts a scattered run where a stick shares a particle with an earlier one, and adds the pieces.
void add_cut(std::vector<StickRun>& runs, const StickRun& scattered, const StickArrays& sticks,
             DisjointRun& particles) {
    for (std::size_t first = scattered.first, end = first; first < scattered.first + scattered.count;
         first = end) {
        particles.begin();
        while (end < scattered.first + scattered.count &&
               particles.add(std::array{sticks.a[end], sticks.b[end]}))
            ++end;
        const std::size_t count = whole_packs(end - first);
        end = first + count;
        add(runs, {.shape = count < kConstraintsPerPack ? RunShape::Scattered : RunShape::Disjoint,
                   .first = first,
                   .count = count});
    }
}

std::vector<StickRun> runs_of(const StickArrays& sticks, const ConstraintRun& piece, DisjointRun& particles) {
    std::vector<StickRun> runs;
    StickRun scattered;
    const auto add_scattered = [&] {
        add_cut(runs, scattered, sticks, particles);
        scattered.count = 0;
    };
    const std::size_t end = piece.first + piece.count;
    for (std::size_t first = piece.first, count = 0; first < end; first += count) {
        const StickRun run = longest_run_from(sticks, first, end);
        count = run.count;
        if (run.shape == RunShape::Scattered) {
            if (scattered.count == 0) scattered.first = first;
            ++scattered.count;
            continue;
        }
        add_scattered();
        runs.push_back(run);
    }
    add_scattered();
    return runs;
}

ConstraintSchedule<StickRun> schedule_of(const StickArrays& sticks, std::size_t particle_count) {
    const ConstraintParticles ends(sticks.count(), particle_count, [&](std::size_t i) {
        return std::array{sticks.a[i], sticks.b[i]};
    });
    DisjointRun particles(particle_count);
    return ConstraintSchedule<StickRun>::of(
        independent_pieces(ends, kSticksPerSlab),
        [&](const ConstraintRun& piece) { return runs_of(sticks, piece, particles); });
}

/// How the ends share the correction, and what is left to the goal.
struct StickShares {
    double a, b, yield;
};

/// Jakobsen 2001, section 4.
StickShares shares_of_stick(double inverse_mass_a, double inverse_mass_b, double stiffness) {
    const double sum = inverse_mass_a + inverse_mass_b;
    return {stiffness * inverse_mass_a / sum, stiffness * inverse_mass_b / sum, 0};
}

StickShares shares_of_spring(double inverse_mass_a, double inverse_mass_b, double compliance,
                             double substep) {
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
        const StickShares shares = options.solver == SolverKind::Verlet
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
    sticks.schedule = schedule_of(sticks, deformable.particle_count());
    sticks.rest_lengths.resize(sticks.count() + PointArrays::kPadding);
    sticks.goal_lengths = sticks.rest_lengths;
    return sticks;
}

} // namespace echinus
