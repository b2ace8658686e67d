#include "comparison.hpp"

#include <fmt/format.h>
#include <time.h>

#include <cmath>

using namespace echinus;

namespace {

constexpr std::size_t kSmall = 100'000; // sets of so few particles are quick: more passes

const char* name_of(Role role) {
    switch (role) {
    case Role::Ours:
        return "ours";
    case Role::Rival:
        return "rival";
    case Role::Floor:
        return "floor";
    }
    return "";
}

/// The particles that a racer was timed with.
std::vector<std::uint32_t> asked_of(const Racer& racer) {
    std::vector<std::uint32_t> asked;
    for (const Part& part : racer.parts)
        for (std::size_t i = part.begin; i < part.end; ++i) asked.push_back(static_cast<std::uint32_t>(i));
    return asked;
}

ErrorSummary judge(Task task, const Subject& subject, const Truth& truth, const Competitor& competitor,
                   const std::vector<std::uint32_t>& asked) {
    std::vector<std::uint8_t> inside;
    std::vector<float> depth;
    for (const std::uint32_t i : asked) {
        const DepthNormal answer = competitor.way.answered(i);
        inside.push_back(answer.depth > 0 ? 1 : 0);
        if (task == Task::Contacts) depth.push_back(answer.depth);
    }
    return errors_of(truth, subject.radius, asked, inside, depth);
}

/// Builds a structure, several times over when that is quick.
/// @returns milliseconds of processor time, the median; `structure` is the last that was built
double time_build(const System& system, Structure& structure) {
    constexpr double kEnough = 0.1; // seconds
    constexpr std::size_t kMost = 9;
    std::vector<double> times;
    for (double sum = 0; times.empty() || (sum < kEnough && times.size() < kMost); sum += times.back()) {
        structure = {};
        const double start = process_seconds();
        structure = system.build();
        times.push_back(process_seconds() - start);
    }
    return 1e3 * median_of(times);
}

std::string digits(double value) {
    return std::isnan(value) ? "" : fmt::format("{:.4g}", value);
}

} // namespace

double process_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

const char* name_of(Task task) {
    return task == Task::Contains ? "contains" : "contacts";
}

std::vector<Competitor> build_all(const std::vector<System>& systems, std::size_t point_count, bool one_way) {
    std::vector<Competitor> competitors;
    for (const System& system : systems) {
        Structure structure{};
        const double build_ms = time_build(system, structure);
        Ways ways = structure.ways(point_count);
        if (one_way) ways.resize(1);
        for (Way& way : ways)
            competitors.push_back({system.name, system.role, build_ms, structure, std::move(way)});
    }
    return competitors;
}

Records comparison_records() {
    return Records({"task", "mesh", "faces", "set", "particles", "system", "way", "role", "ns", "spread",
                    "bytes", "build_ms", "asked", "wrong_share", "farthest_wrong", "depth_mean", "depth_99",
                    "depth_worst"});
}

std::vector<Racer> racers_for(const std::vector<Competitor>& competitors, const ParticleSet& set,
                              double patience_seconds) {
    std::vector<Racer> racers;
    for (const Competitor& competitor : competitors) {
        const auto run = [&](Part part) {
            competitor.way.answer(std::span(set.points).subspan(part.begin, part.size()), part.begin);
        };
        const std::size_t count = set.points.size();
        racers.push_back({run, competitor.way.as_whole ? std::vector<Part>{{0, count}}
                                                       : parts_for(run, count, patience_seconds)});
    }
    return racers;
}

void compare(const Comparison& comparison, const Subject& subject, const ParticleSet& set,
             const std::vector<Competitor>& competitors, Records& records) {
    const Truth truth = truth_of(subject, set, comparison.truth_cache);
    TurnOptions options;
    options.passes = comparison.effort.passes * (set.points.size() <= kSmall ? 3 : 1);
    options.enough_seconds = comparison.effort.enough_seconds;
    options.report_progress = [&](double fraction) {
        comparison.report_progress(fmt::format("{} {} {}", name_of(comparison.task), subject.name, set.name),
                                   fraction);
    };

    const std::vector<Racer> racers = racers_for(competitors, set, comparison.effort.patience_seconds);
    const std::vector<Pace> paces = take_turns(racers, options);

    for (std::size_t k = 0; k < competitors.size(); ++k) {
        const Competitor& competitor = competitors[k];
        const std::vector<std::uint32_t> asked = asked_of(racers[k]);
        Records::Record record{{"task", name_of(comparison.task)},
                               {"mesh", subject.name},
                               {"faces", fmt::format("{}", subject.mesh.faces.size())},
                               {"set", set.name},
                               {"particles", fmt::format("{}", set.points.size())},
                               {"system", competitor.system},
                               {"way", competitor.way.name},
                               {"role", name_of(competitor.role)},
                               {"ns", digits(paces[k].ns)},
                               {"spread", digits(paces[k].spread)},
                               {"bytes", fmt::format("{}", competitor.structure.byte_count)},
                               {"build_ms", digits(competitor.build_ms)},
                               {"asked", fmt::format("{}", asked.size())}};
        if (competitor.role != Role::Floor) {
            const ErrorSummary errors = judge(comparison.task, subject, truth, competitor, asked);
            record["wrong_share"] = digits(errors.wrong_share);
            record["farthest_wrong"] = digits(errors.farthest_wrong);
            if (comparison.task == Task::Contacts) {
                record["depth_mean"] = digits(errors.depth_mean);
                record["depth_99"] = digits(errors.depth_99);
                record["depth_worst"] = digits(errors.depth_worst);
            }
        }
        records.add(std::move(record));
    }
}
