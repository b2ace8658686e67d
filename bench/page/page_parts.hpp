#pragma once

#include "common/page.hpp"
#include "common/records.hpp"

#include <filesystem>

/// The records of all tasks.
struct Results {
    Records contains, contacts, bytes, build, threads, cloth;
};

/// Reads the CSV files of a folder. @throws echinus::Error Unreadable when a task's is missing
Results read_results(const std::filesystem::path& folder);

// Each adds values for the page's template, or writes plots.

/// Times, errors and bytes of all systems, a table for each task and mesh.
void add_comparisons(const Results& results, Values& values);

/// The goals beside what was measured.
void add_goals(const Results& results, Values& values);

/// Build times, what a second core brings, frames of the cloth.
void add_builds(const Results& results, Values& values);
void add_cloth(const Results& results, Values& values);

/// Where a rival is better.
void add_losses(const Results& results, Values& values);

void write_plots(const Results& results, const std::filesystem::path& images);

// ---- Shared by them

/// Three significant digits.
std::string shown(double value);

/// The records of one mesh and set whose system and way these are; the first of them, or none.
const Records::Record* find(const std::vector<Records::Record>& records, const std::string& system,
                            const std::string& way = {});
