#include "contacts/field.hpp"
#include "measurements.hpp"

using namespace echinus;

Records measure_contacts(const Setting& setting) {
    const Comparison comparison{.task = "contacts",
                                .has_depth = true,
                                .truth_cache = setting.truth_cache,
                                .effort = setting.effort,
                                .report_progress = setting.report_progress};
    constexpr std::size_t kBatch = 10'000;
    Records records = comparison_records();
    for (const auto& make_subject : subjects(setting.meshes, setting.debian_horse)) {
        const Subject subject = make_subject();
        if (subject.large && setting.effort.large_point_count == 0) continue;
        const std::size_t count =
            subject.large ? setting.effort.large_point_count : setting.effort.point_count;
        setting.report_progress("contacts " + subject.name + ": building", 0);
        const ContactsField field(subject, count, all_contacts_systems());
        for (const ParticleSet& set : subject.sets(count))
            compare(comparison, subject, set, field.competitors(), records);
        if (subject.large) continue;
        for (ParticleSet& batch : subject.sets(kBatch)) {
            batch.name += " 10k";
            compare(comparison, subject, batch, field.competitors(), records);
        }
    }
    return records;
}
