// The tasks contains and contacts.

#include "measurements.hpp"
#include "systems/systems.hpp"

#include <fmt/format.h>

using namespace echinus;

namespace {

/// Small sets, so small calls.
std::vector<ParticleSet> small_sets(const Subject& subject, std::size_t thousands) {
    std::vector<ParticleSet> sets = subject.sets(thousands * 1000);
    for (ParticleSet& set : sets) set.name += fmt::format(" {}k", thousands);
    return sets;
}

/// On one mesh, of so many particles in a set.
void measure(const Comparison& comparison, const Subject& subject, std::size_t point_count,
             Records& records) {
    comparison.report_progress(fmt::format("{} {}: building", name_of(comparison.task), subject.name), 0);
    std::vector<Competitor> competitors = build_all(systems_for(comparison.task, subject), point_count);
    for (const ParticleSet& set : subject.sets(point_count))
        compare(comparison, subject, set, competitors, records);
    if (subject.large) return;
    for (const ParticleSet& set : small_sets(subject, 10))
        compare(comparison, subject, set, competitors, records);
    if (point_count <= 100'000) return;
    std::erase_if(competitors, [](const Competitor& competitor) { return !competitor.way.as_whole; });
    for (const ParticleSet& set : small_sets(subject, 100))
        compare(comparison, subject, set, competitors, records);
}

Records measure(Task task, const Setting& setting) {
    Records records = comparison_records();
    const Effort& effort = setting.effort;
    for (const auto& make_subject : subjects(setting.meshes, setting.debian_horse)) {
        const Subject subject = make_subject();
        if (subject.large && effort.large_point_count == 0) continue;
        measure(comparison_of(task, setting), subject,
                subject.large ? effort.large_point_count : effort.point_count, records);
    }
    return records;
}

} // namespace

Comparison comparison_of(Task task, const Setting& setting) {
    return {.task = task,
            .truth_cache = setting.truth_cache,
            .effort = setting.effort,
            .report_progress = setting.report_progress};
}

Records measure_contains(const Setting& setting) {
    return measure(Task::Contains, setting);
}

Records measure_contacts(const Setting& setting) {
    return measure(Task::Contacts, setting);
}
