#pragma once

#include "compare/compare.hpp"
#include "console/json.hpp"

#include <functional>
#include <string>
#include <vector>

namespace echinus::comparison {

/// A column of a table with a row for each system.
struct Column {
    std::string group; ///< the common heading of neighbouring columns, with the unit
    std::string head;
    std::function<std::string(const Figures&)> cell;
};

/// Bytes, build time, and time per particle for each set.
std::vector<Column> time_columns(const Comparison& comparison);

/// Share of wrong signs for each set; errors of depth and normal on S, where they matter.
std::vector<Column> error_columns(const Comparison& comparison);

/// The notes of a table: systems that exceed the budget and why, systems that refused the mesh, and whether
/// systems define inside differently.
std::vector<std::string> remarks_on(const Comparison& comparison);

} // namespace echinus::comparison
/// The result of `compare`, as the object of --json.
Json to_json(const echinus::comparison::Comparison& comparison,
             const echinus::comparison::CompareOptions& options, const std::string& mesh_name);

/// The same as two tables for people.
std::string to_text(const echinus::comparison::Comparison& comparison,
                    const echinus::comparison::CompareOptions& options, const std::string& mesh_name);
