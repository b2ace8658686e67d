#include "contacts/field.hpp"
#include "contains/field.hpp"
#include "measurements.hpp"

using namespace echinus;

namespace {

constexpr std::size_t kPointCount = 200'000;

} // namespace

Records measure_bytes(const Setting& setting) {
    const Subject horse = horse_subject(setting.meshes, setting.debian_horse);
    const std::size_t count = std::min(kPointCount, setting.effort.point_count);
    Comparison comparison{.task = "contains",
                          .has_depth = false,
                          .truth_cache = setting.truth_cache,
                          .effort = setting.effort,
                          .report_progress = setting.report_progress};
    Records records = comparison_records();
    const std::vector<ParticleSet> sets = horse.sets(count);
    setting.report_progress("bytes: building", 0);
    {
        const ContainsField field(horse, count, all_contains_sizes(), true);
        for (const ParticleSet& set : sets) compare(comparison, horse, set, field.competitors(), records);
    }
    comparison.task = "contacts";
    comparison.has_depth = true;
    const ContactsField field(horse, count, all_contacts_sizes(), true);
    for (const ParticleSet& set : sets) compare(comparison, horse, set, field.competitors(), records);
    return records;
}
