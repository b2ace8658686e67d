#pragma once

#include "compare/compare.hpp"
#include "console/json.hpp"

#include <echinus_render/render.hpp>

#include <string>

/// The result of `compare`, as the object of --json.
Json to_json(const echinus::comparison::Comparison& comparison,
             const echinus::comparison::CompareOptions& options, const std::string& mesh_name);

/// The same as two tables for people.
std::string to_text(const echinus::comparison::Comparison& comparison,
                    const echinus::comparison::CompareOptions& options, const std::string& mesh_name);

/// The same as one HTML document with tables, plots and a picture of the model. It is self-contained and can
/// be sent by mail: it loads nothing and runs no script.
std::string to_html(const echinus::comparison::Comparison& comparison,
                    const echinus::comparison::CompareOptions& options, const std::string& mesh_name,
                    const echinus::Image& picture);
