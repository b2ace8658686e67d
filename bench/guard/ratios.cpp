#include "build/system.hpp"
#include "common/comparison.hpp"
#include "guard/guard.hpp"
#include "systems/systems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

using namespace echinus;
using namespace echinus::comparison;

namespace {

constexpr int kPasses = 9;

/// Median and half the distance of the quartiles, as a share of it.
struct Ratio {
    double median, spread;
};

Ratio ratio_of(const Pace& ours, const Pace& reference) {
    std::vector<double> ratios;
    for (std::size_t pass = 0; pass < ours.pass_ns.size(); ++pass)
        ratios.push_back(ours.pass_ns[pass] / reference.pass_ns[pass]);
    std::ranges::sort(ratios);
    const double median = median_of(ratios);
    return {median, (ratios[ratios.size() * 3 / 4] - ratios[ratios.size() / 4]) / 2 / median};
}

struct Entry {
    std::string name;
    bool ours;
    Pace pace;
};

/// Each of ours against each of the others.
void add(const std::string& mesh, const std::string& task, const std::string& set,
         const std::vector<Entry>& entries, Records& records) {
    for (const Entry& ours : entries)
        for (const Entry& reference : entries) {
            if (!ours.ours || reference.ours) continue;
            const auto [median, spread] = ratio_of(ours.pace, reference.pace);
            records.add({{"mesh", mesh},
                         {"task", task},
                         {"system", ours.name},
                         {"set", set},
                         {"against", reference.name},
                         {"ratio", fmt::format("{:.4g}", median)},
                         {"spread", fmt::format("{:.2g}", spread)}});
        }
}

void measure_queries(const Subject& horse, const std::string& task, const std::vector<ParticleSet>& sets,
                     const std::vector<Competitor>& competitors, const Setting& setting, Records& records) {
    for (const ParticleSet& set : sets) {
        TurnOptions options;
        options.passes = kPasses;
        options.report_progress = [&](double fraction) {
            setting.report_progress(task + ' ' + set.name, fraction);
        };
        const std::vector<Pace> paces =
            take_turns(racers_for(competitors, set, setting.effort.patience_seconds), options);
        std::vector<Entry> entries;
        for (std::size_t k = 0; k < competitors.size(); ++k)
            entries.push_back({competitors[k].system, competitors[k].role == Role::Ours, paces[k]});
        add(horse.name, task, set.name, entries, records);
    }
}

/// Ours, the small dense grid and Embree.
std::vector<System> chosen(std::vector<System> systems) {
    constexpr std::array kNames{"exact map", "distance map", "dense grid 0.63 MB", "Embree"};
    std::erase_if(systems, [&](const System& system) {
        return std::ranges::find(kNames, system.name) == kNames.end();
    });
    return systems;
}

void measure_builds(const Subject& horse, const Setting& setting, Records& records) {
    BuildList ways;
    list_exact_map(ways, horse.mesh);
    list_distance_map(ways, horse.mesh);
    list_build_rivals(ways, horse.mesh);
    std::erase_if(ways, [](const BuildWay& way) { return way.thread_count != 1; });
    std::vector<Racer> racers;
    for (const BuildWay& way : ways) racers.push_back({[&way](Part) { way.build(); }, {{0, 1}}});
    TurnOptions options;
    options.passes = 3 * kPasses;
    options.report_progress = [&](double fraction) { setting.report_progress("build", fraction); };
    const std::vector<Pace> paces = take_turns(racers, options);
    std::vector<Entry> entries;
    for (std::size_t k = 0; k < ways.size(); ++k) {
        const bool ours = ways[k].system == "exact map" || ways[k].system == "distance map";
        entries.push_back({ours ? ways[k].system + ' ' + ways[k].way : ways[k].system, ours, paces[k]});
    }
    add(horse.name, "build", "", entries, records);
}

} // namespace

Records measure_ratios(const Setting& setting) {
    Records records({"mesh", "task", "system", "set", "against", "ratio", "spread"});
    const Subject horse = horse_subject(setting.meshes, setting.debian_horse);
    const std::size_t count = setting.effort.point_count;
    const std::vector<ParticleSet> sets = horse.sets(count);
    setting.report_progress("building", 0);
    for (const Task task : {Task::Contains, Task::Contacts})
        measure_queries(horse, name_of(task), sets, build_all(chosen(systems_for(task, horse)), count, true),
                        setting, records);
    measure_builds(horse, setting, records);
    return records;
}
