#pragma once

#include "common/comparison.hpp"

/// What a task is measured with.
struct Setting {
    std::filesystem::path meshes, debian_horse, scenes, truth_cache;
    Effort effort;
    std::function<void(const std::string& what, double fraction)> report_progress;
};

/// A comparison of the systems at a task.
Comparison comparison_of(Task task, const Setting& setting);

// One function a task; each returns the records of its CSV file.

/// The sign of every particle, all systems on all meshes and sets.
Records measure_contains(const Setting& setting);

/// Signs, depths and normals, all systems on all meshes and sets.
Records measure_contacts(const Setting& setting);

/// Build times, against the number of faces too.
Records measure_build(const Setting& setting);

/// What a second core brings to builds and batches. In a process that was never pinned: oneTBB looks only
/// once how many cores there are.
Records measure_threads(const Setting& setting);

/// Times, errors and bytes over sizes of each structure.
Records measure_bytes(const Setting& setting);

/// Frames of the cloth that falls on the horse.
Records measure_cloth(const Setting& setting);
