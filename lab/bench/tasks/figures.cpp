// The task figures: every figure of the README's tables, on freely available meshes: Debian's horse and a
// generated torus. Calls of four sizes, and the cloth on each system.

#include "cloth_run.hpp"
#include "queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

using namespace echinus;
using namespace echinus::comparison;

namespace {

bool is_chosen(const std::string& name) {
    constexpr std::array kNames{"exact map",         "distance map", "dense grid 0.63 MB 16 bit", "Embree",
                                "dense grid 16 bit", "Embree's tree"}; // the last two: of the cloth
    return std::ranges::find(kNames, name) != kNames.end();
}

void add_query_figures(const Subject& subject, const Setting& setting, Records& records) {
    std::vector<BenchSystem> chosen = systems_on(subject);
    std::erase_if(chosen, [](const BenchSystem& system) { return !is_chosen(system.name); });
    setting.report_progress("figures: building " + subject.name, 0);
    const BuiltSystems systems = build_all(std::move(chosen));
    const auto add = [&](std::vector<JudgedSet> sets, std::size_t call_size, bool one_by_one) {
        for (JudgedSet& set : sets)
            for (const Question question : {Question::Sides, Question::Contacts}) {
                Effort effort = effort_for(question, setting);
                effort.call_size = call_size;
                effort.one_by_one = one_by_one;
                add_queries(setting, subject, set, systems, effort, records);
            }
    };
    add(subject.sets(setting.point_count), 0, false);
    const std::size_t count = std::max<std::size_t>(setting.point_count / 10, 10'000);
    for (const std::size_t call_size : {10'000U, 1000U})
        add(subject.sets_for_calls(count, call_size), call_size, false);
    add(subject.sets(count), 0, true);
}

void add_cloth_figures(const Subject& subject, const char* scene_file, const Setting& setting,
                       Records& records) {
    const ClothScene scene{read_scene(setting.scenes / scene_file), subject.mesh};
    std::vector<ClothSystem> systems = cloth_systems(scene.mesh, scene.scene.simulation.thickness.value());
    std::erase_if(systems, [](const ClothSystem& system) { return !is_chosen(system.name); });
    ClothLimits limits;
    if (setting.is_short) limits = {.frame_limit = 200, .first_timed = 180, .timed_count = 20};
    const std::vector<ClothOutcome> outcomes = run_cloths(scene, systems, limits, [&](double fraction) {
        setting.report_progress("cloth on the " + subject.name, fraction);
    });
    for (std::size_t k = 0; k < systems.size(); ++k)
        records.add(
            {{"task", "cloth"},
             {"mesh", subject.name},
             {"particles", fmt::format("{}", scene.scene.cloth.column_count * scene.scene.cloth.row_count)},
             {"system", systems[k].name},
             {"bytes", fmt::format("{}", systems[k].bytes)},
             {"frame_ms", fmt::format("{:.4g}", outcomes[k].frame_ms)},
             {"frames", fmt::format("{}", outcomes[k].frames)},
             {"rested", outcomes[k].rested ? "yes" : "no"},
             {"inside_at_end", fmt::format("{}", outcomes[k].inside_at_end)},
             {"deepest", fmt::format("{:.3g}", outcomes[k].deepest)}});
}

} // namespace

Records measure_figures(const Setting& setting) {
    Records records = query_records({"frame_ms", "frames", "rested", "inside_at_end", "deepest"});
    const Subject horse = public_horse(setting.debian_horse), torus = torus_subject();
    for (const Subject* subject : {&horse, &torus}) add_query_figures(*subject, setting, records);
    add_cloth_figures(horse, "horse.json", setting, records);
    add_cloth_figures(torus, "torus.json", setting, records);
    return records;
}
