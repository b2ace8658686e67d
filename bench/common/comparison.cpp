#include "common/comparison.hpp"

#include "rivals/compare/clock.hpp"

#include <fmt/format.h>

#include <cmath>

using namespace echinus;
using namespace echinus::comparison;

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

/// What a competitor said about the particles that it was timed with.
Answers answers_of(Task task, const Competitor& competitor, const Racer& racer) {
    Answers answers;
    for (const Part& part : racer.parts)
        for (std::size_t i = part.begin; i < part.end; ++i) {
            const DepthNormal answer = competitor.way.answered(i);
            answers.asked.push_back(static_cast<std::uint32_t>(i));
            answers.inside.push_back(answer.depth > 0 ? 1 : 0);
            if (task == Task::Contacts) answers.depth.push_back(answer.depth);
        }
    return answers;
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
        const Answers answers = answers_of(comparison.task, competitor, racers[k]);
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
                               {"asked", fmt::format("{}", answers.asked.size())}};
        if (competitor.role != Role::Floor) {
            const ErrorSummary errors = errors_of(truth, subject.radius, answers);
            record["wrong_share"] = digits(errors.wrong_share);
            record["farthest_wrong"] = digits(errors.farthest_wrong);
            if (comparison.task == Task::Contacts) {
                record["depth_mean"] = digits(errors.depth.mean);
                record["depth_99"] = digits(errors.depth.most);
                record["depth_worst"] = digits(errors.depth.worst);
            }
        }
        records.add(std::move(record));
    }
}
