#include "queries.hpp"

#include "truth.hpp"

#include <fmt/format.h>

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
