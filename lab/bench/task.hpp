#pragma once

#include "compare/measuring.hpp"
#include "records.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

/// The settings of a task.
struct Setting {
    std::filesystem::path meshes, debian_horse, scenes, truth_cache;
    bool is_short = false;                   ///< a smoke run: few particles, no large meshes
    std::size_t point_count = 1'000'000;     ///< of a set
    std::size_t large_point_count = 200'000; ///< of a set around a large mesh
    echinus::comparison::Effort effort{.passes = 5, .enough_seconds = 3, .patience_seconds = 10};
    std::function<void(const std::string& what, double fraction)> report_progress;
    /// For tasks of hours: writes what there is so far, and what an earlier run wrote, to go on from.
    std::function<void(const Records& so_far)> store;
    std::optional<Records> earlier;
};

// One function and one file a task; each returns the records of its CSV file.

Records measure_calls(const Setting& setting);
Records measure_contains(const Setting& setting);
Records measure_contacts(const Setting& setting);
Records measure_bytes(const Setting& setting);
Records measure_build(const Setting& setting);
Records measure_cloth(const Setting& setting);
Records measure_triangles(const Setting& setting);
Records measure_solvers(const Setting& setting);
Records measure_mechanics(const Setting& setting);
Records measure_surfaces(const Setting& setting);
Records measure_figures(const Setting& setting);
Records measure_reproduction(const Setting& setting);

/// Ratios of our times to those of Embree, the dense grid and CGAL: what the guard compares. Columns mesh,
/// task, system, set, against, ratio, spread.
Records measure_ratios(const Setting& setting);

/// Compares the ratios with recorded ones and reports what got slower or faster.
/// @return the exit status: 1 if something got slower, in two runs
int guard(const Setting& setting, const std::filesystem::path& recorded);
