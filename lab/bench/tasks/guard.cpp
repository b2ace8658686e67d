// The guard: what got slower since recorded.csv was recorded? Ours and two rivals take turns, so the
// ratios of their times hardly depend on the machine's load.

#include "console/machine.hpp"
#include "queries.hpp"
#include "systems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>

using namespace echinus;
using namespace echinus::comparison;

namespace {

constexpr int kPasses = 9;
constexpr double kTolerated = 0.1; // of a ratio
constexpr double kSpreads = 3;

using Record = Records::Record;

// ---- Ratios

struct TimedSystem {
    std::string name;
    bool is_ours;
    Pace pace;
};

/// The median over the passes, and half the distance of the quartiles as a share of it.
std::pair<double, double> ratio_of(const Pace& ours, const Pace& rival) {
    std::vector<double> ratios;
    for (std::size_t pass = 0; pass < ours.pass_ns.size(); ++pass)
        ratios.push_back(ours.pass_ns[pass] / rival.pass_ns[pass]);
    std::ranges::sort(ratios);
    const double median = median_of(ratios);
    return {median, (ratios[ratios.size() * 3 / 4] - ratios[ratios.size() / 4]) / 2 / median};
}

/// Each of ours against each rival.
void add(const std::string& mesh, const std::string& task, const std::string& set,
         const std::vector<TimedSystem>& systems, Records& records) {
    for (const TimedSystem& ours : systems)
        for (const TimedSystem& rival : systems) {
            if (!ours.is_ours || rival.is_ours) continue;
            const auto [median, spread] = ratio_of(ours.pace, rival.pace);
            records.add({{"mesh", mesh},
                         {"task", task},
                         {"system", ours.name},
                         {"set", set},
                         {"against", rival.name},
                         {"ratio", fmt::format("{:.4g}", median)},
                         {"spread", fmt::format("{:.2g}", spread)}});
        }
}

void add_query_ratios(const Subject& horse, const Setting& setting, Records& records) {
    constexpr std::array kNames{"exact map", "distance map", "dense grid 0.63 MB", "Embree"};
    std::vector<BenchSystem> chosen = systems_on(horse);
    std::erase_if(chosen, [&](const BenchSystem& system) {
        return std::ranges::find(kNames, system.name) == kNames.end();
    });
    const BuiltSystems systems = build_all(std::move(chosen));
    for (const Question question : {Question::Sides, Question::Contacts})
        for (const JudgedSet& set : horse.sets(setting.point_count)) { // unjudged: only times count
            Effort effort = effort_for(question, setting);
            effort.passes = kPasses;
            effort.enough_seconds = std::numeric_limits<double>::infinity();
            const std::vector<SetFigures> figures =
                measure(systems.pointers(), set, horse.radius, effort, [&](double fraction) {
                    setting.report_progress(std::string(name_of(question)) + ' ' + set.name, fraction);
                });
            std::vector<TimedSystem> timed;
            for (std::size_t k = 0; k < figures.size(); ++k)
                timed.push_back({systems.list[k].name, systems.list[k].is_ours,
                                 question == Question::Sides ? figures[k].contains : figures[k].contacts});
            add(horse.name, name_of(question), set.name, timed, records);
        }
}

void add_build_ratios(const Subject& horse, const Setting& setting, Records& records) {
    const std::vector<TimedStructure> builds = builds_on(horse);
    const std::vector<Pace> paces = time_builds(
        builds, 3 * kPasses, [&](double fraction) { setting.report_progress("build", fraction); });
    std::vector<TimedSystem> timed;
    for (std::size_t k = 0; k < builds.size(); ++k)
        timed.push_back({builds[k].system, builds[k].is_ours, paces[k]});
    add(horse.name, "build", "", timed, records);
}

// ---- Verdict

/// A sentence for each subject, a system at a task, that became slower or faster.
struct Verdict {
    std::map<std::string, std::string> slower, faster;
    std::vector<std::string> unknown; ///< not in the record, or in it alone
};

std::string subject_of(const Record& record) {
    std::string text = record.at("system") + ", " + record.at("task");
    if (!record.at("set").empty()) text += " on " + record.at("set");
    return text;
}

std::string key_of(const Record& record) {
    return subject_of(record) + " beside " + record.at("against") + " on " + record.at("mesh");
}

/// The factor by which a ratio changed, and the tolerated one.
struct Change {
    std::string against;
    double factor, tolerance;

    bool is_slower() const { return factor > 1 + tolerance; }
    bool is_faster() const { return factor < 1 / (1 + tolerance); }
};

std::string sentence(const std::string& subject, const std::vector<Change>& changes) {
    std::string text = subject + ':';
    for (const Change& change : changes)
        text += fmt::format("{} {:.2f} times as long as recorded beside {} (up to {:.2f} is spread)",
                            &change == &changes.front() ? "" : ",", change.factor, change.against,
                            1 + change.tolerance);
    return text;
}

/// A system is slower at a task when each of its ratios there is: by more than a tenth, and by more than
/// three times the spread of both measurements. So a rival that had a bad moment raises no alarm.
Verdict compare_ratios(const Records& recorded, const Records& measured) {
    std::map<std::string, Record> by_key;
    for (const Record& record : recorded.all()) by_key[key_of(record)] = record;
    std::map<std::string, std::vector<Change>> changes;
    Verdict verdict;
    for (const Record& record : measured.all()) {
        const auto old = by_key.find(key_of(record));
        if (old == by_key.end()) {
            verdict.unknown.push_back(key_of(record) + ": nothing is recorded");
            continue;
        }
        changes[subject_of(record)].push_back(
            {record.at("against"), number(record, "ratio") / number(old->second, "ratio"),
             std::max(kTolerated, kSpreads * (number(record, "spread") + number(old->second, "spread")))});
        by_key.erase(old);
    }
    for (const auto& [key, record] : by_key) verdict.unknown.push_back(key + ": recorded, but not measured");
    for (const auto& [subject, of_subject] : changes) {
        if (std::ranges::all_of(of_subject, &Change::is_slower))
            verdict.slower[subject] = sentence(subject, of_subject);
        if (std::ranges::all_of(of_subject, &Change::is_faster))
            verdict.faster[subject] = sentence(subject, of_subject);
    }
    return verdict;
}

void print_all(const char* head, const std::map<std::string, std::string>& sentences) {
    if (!sentences.empty()) fmt::print("{}\n", head);
    for (const auto& [subject, text] : sentences) fmt::print("  {}\n", text);
}

} // namespace

Records measure_ratios(const Setting& setting) {
    Records records({"mesh", "task", "system", "set", "against", "ratio", "spread"});
    const Subject horse = first_subject(setting.meshes, setting.debian_horse);
    setting.report_progress("building", 0);
    add_query_ratios(horse, setting, records);
    add_build_ratios(horse, setting, records);
    return records;
}

int guard(const Setting& setting, const std::filesystem::path& path) {
    const Records recorded = Records::read(path);
    if (recorded.comments().front() != describe_machine())
        fmt::print(
            "Recorded on another machine: {}. Ratios depend on the processor; record anew to be sure.\n",
            recorded.comments().front());
    Verdict verdict = compare_ratios(recorded, measure_ratios(setting));
    if (!verdict.slower.empty()) { // one run alone may have met a bad moment of the machine
        fmt::print("Something seems slower; measuring again.\n");
        const Verdict second = compare_ratios(recorded, measure_ratios(setting));
        std::erase_if(verdict.slower, [&](const auto& item) { return !second.slower.contains(item.first); });
    }
    if (!verdict.unknown.empty()) fmt::print("Not compared:\n");
    for (const std::string& text : verdict.unknown) fmt::print("  {}\n", text);
    print_all("Faster than recorded:", verdict.faster);
    print_all("SLOWER than recorded:", verdict.slower);
    if (verdict.slower.empty()) fmt::print("Nothing got slower.\n");
    return verdict.slower.empty() ? 0 : 1;
}
