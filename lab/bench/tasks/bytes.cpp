// The task bytes: time and errors near the surface over the sizes of each system that has sizes.

#include "queries.hpp"

#include <echinus/error.hpp>

#include <algorithm>

using namespace echinus;
using namespace echinus::comparison;

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
