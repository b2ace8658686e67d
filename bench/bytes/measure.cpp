#include "measurements.hpp"
#include "systems/systems.hpp"

using namespace echinus;

Records measure_bytes(const Setting& setting) {
    constexpr std::size_t kPointCount = 200'000;
    const Subject horse = horse_subject(setting.meshes, setting.debian_horse);
    const std::size_t count = std::min(kPointCount, setting.effort.point_count);
    Records records = comparison_records();
    const std::vector<ParticleSet> sets = horse.sets(count);
    for (const Task task : {Task::Contains, Task::Contacts}) {
        setting.report_progress("bytes: building", 0);
        const std::vector<Competitor> competitors = build_all(sizes_for(task, horse.mesh), count, true);
        for (const ParticleSet& set : sets)
            compare(comparison_of(task, setting), horse, set, competitors, records);
    }
    return records;
}
