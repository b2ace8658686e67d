#include "queries.hpp"

#include "truth.hpp"

#include <echinus/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace echinus;
using namespace echinus::comparison;

namespace {

std::string digits(double value) {
    return std::isnan(value) ? "" : fmt::format("{:.4g}", value);
}

} // namespace

const char* name_of(Question question) {
    return question == Question::Sides ? "contains" : "contacts";
}

Effort effort_for(Question question, const Setting& setting) {
    Effort effort = setting.effort;
    effort.sides = question == Question::Sides;
    effort.contacts = question == Question::Contacts;
    return effort;
}

std::vector<const rivals::System*> BuiltSystems::pointers() const {
    std::vector<const rivals::System*> result;
    for (const TimedBuild& build : builds) result.push_back(build.system.get());
    return result;
}

BuiltSystems build_all(std::vector<BenchSystem> systems) {
    BuiltSystems result;
    for (const BenchSystem& system : systems) result.builds.push_back(build_timed(system.builder));
    result.list = std::move(systems);
    return result;
}

Records query_records(const std::vector<std::string>& more) {
    std::vector<std::string> columns{"task",       "mesh",     "faces",      "set",         "particles",
                                     "call",       "system",   "role",       "ns",          "spread",
                                     "bytes",      "build_ms", "asked",      "wrong_share", "farthest_wrong",
                                     "depth_mean", "depth_99", "depth_worst"};
    columns.insert(columns.end(), more.begin(), more.end());
    return Records(columns);
}

void add_queries(const Setting& setting, const Subject& subject, JudgedSet& set, const BuiltSystems& systems,
                 const Effort& effort, Records& records) {
    const std::string call = effort.one_by_one      ? "1"
                             : effort.call_size > 0 ? fmt::format("{}", effort.call_size)
                                                    : "whole set";
    if (set.truth.inside.empty()) judge(subject, setting.truth_cache, set);
    const char* const task = name_of(effort.sides ? Question::Sides : Question::Contacts);
    const std::vector<SetFigures> figures =
        measure(systems.pointers(), set, subject.radius, effort, [&](double fraction) {
            setting.report_progress(fmt::format("{} {} {} {}", task, subject.name, set.name, call), fraction);
        });
    for (std::size_t k = 0; k < figures.size(); ++k) {
        const Pace& pace = effort.sides ? figures[k].contains : figures[k].contacts;
        const ErrorSummary& errors = figures[k].errors;
        Records::Record record{{"task", task},
                               {"mesh", subject.name},
                               {"faces", fmt::format("{}", subject.mesh.faces.size())},
                               {"set", set.name},
                               {"particles", fmt::format("{}", set.points.size())},
                               {"call", call},
                               {"system", systems.list[k].name},
                               {"role", systems.list[k].is_ours ? "ours" : "rival"},
                               {"ns", digits(pace.ns)},
                               {"spread", digits(pace.spread)},
                               {"bytes", fmt::format("{}", systems.builds[k].system->byte_count())},
                               {"build_ms", digits(systems.builds[k].ms)},
                               {"asked", fmt::format("{}", errors.asked_count)},
                               {"wrong_share", digits(errors.wrong_share)},
                               {"farthest_wrong", digits(errors.farthest_wrong)}};
        if (effort.contacts) {
            record["depth_mean"] = digits(errors.depth.mean);
            record["depth_99"] = digits(errors.depth.most);
            record["depth_worst"] = digits(errors.depth.worst);
        }
        records.add(std::move(record));
    }
}

// The tasks contains and contacts: all systems on all meshes and sets.

namespace {

constexpr std::size_t kSmallCall = 10'000; // particles

void measure_on(const Subject& subject, Question question, const Setting& setting, Records& records) {
    setting.report_progress(fmt::format("{} {}: building", name_of(question), subject.name), 0);
    const BuiltSystems systems = build_all(systems_on(subject));
    const std::size_t count = subject.large ? setting.large_point_count : setting.point_count;
    for (JudgedSet& set : subject.sets(count))
        add_queries(setting, subject, set, systems, effort_for(question, setting), records);
    if (subject.large) return;
    Effort effort = effort_for(question, setting);
    effort.call_size = kSmallCall;
    for (JudgedSet& set : subject.sets_for_calls(std::max(count / 10, kSmallCall), kSmallCall))
        add_queries(setting, subject, set, systems, effort, records);
}

Records measure_all(Question question, const Setting& setting) {
    Records records = query_records();
    for (const auto& make_subject : subjects(setting.meshes, setting.debian_horse)) {
        const Subject subject = make_subject();
        if (!subject.large || !setting.is_short) measure_on(subject, question, setting, records);
    }
    return records;
}

} // namespace

Records measure_contains(const Setting& setting) {
    return measure_all(Question::Sides, setting);
}

Records measure_contacts(const Setting& setting) {
    return measure_all(Question::Contacts, setting);
}

// The task bytes: time and errors near the surface over the sizes of each system that has sizes.

namespace {

/// A system in all sizes that double from 40 KB on, as far as it has them. @pre `sizes` outlives the result
std::vector<BenchSystem> sizes_of(const SystemType& type, Sizes& sizes, std::size_t max_bytes) {
    std::vector<BenchSystem> list;
    for (std::size_t budget = 40'000; budget <= max_bytes; budget *= 2) {
        try {
            list.push_back({std::string(type.title),
                            type.name.starts_with("distance") || type.name == "exact", sizes.within(budget)});
        } catch (const Error& error) { // a smaller budget than the coarsest needs
            if (error.code() != ErrorCode::InvalidOptions) throw;
        }
    }
    return list;
}

} // namespace

Records measure_bytes(const Setting& setting) {
    const std::size_t max_bytes = setting.is_short ? 700'000 : 6'000'000;
    const std::size_t point_count = std::min<std::size_t>(100'000, setting.point_count);
    const Subject horse = first_subject(setting.meshes, setting.debian_horse);
    JudgedSet near_surface = horse.sets(point_count)[1];
    Records records = query_records();
    for (const SystemType& type : all_systems()) {
        if (!type.available() || !type.has_sizes) continue;
        setting.report_progress("bytes: building " + std::string(type.title), 0);
        const auto sizes = type.on(horse.mesh, {}, [](std::string_view, double) {});
        BuiltSystems systems = build_all(sizes_of(type, *sizes, max_bytes));
        for (const Question question : {Question::Sides, Question::Contacts})
            add_queries(setting, horse, near_surface, systems, effort_for(question, setting), records);
    }
    return records;
}
