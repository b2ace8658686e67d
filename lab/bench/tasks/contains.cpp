// The tasks contains and contacts: all systems on all meshes and sets.

#include "queries.hpp"

#include <fmt/format.h>

#include <algorithm>

using namespace echinus;
using namespace echinus::comparison;

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
