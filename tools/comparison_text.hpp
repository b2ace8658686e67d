#pragma once

#include "rivals/compare/compare.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// What `compare` says, as the object of --json.
nlohmann::ordered_json to_json(const echinus::comparison::Comparison& comparison,
                               const echinus::comparison::CompareOptions& options,
                               const std::string& mesh_name);

/// The same as two tables for people.
std::string to_text(const echinus::comparison::Comparison& comparison,
                    const echinus::comparison::CompareOptions& options, const std::string& mesh_name);
