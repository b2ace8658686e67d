#pragma once

#include "rivals/compare/compare.hpp"

#include <echinus/render.hpp>

#include <string>

/// What `compare --html` writes: one HTML document with the tables, the plots and a picture of the model. All
/// is in it, so that it can be sent by mail: it loads nothing from elsewhere and runs no script.
/// @param picture  of the model
std::string comparison_page(const echinus::comparison::Comparison& comparison,
                            const echinus::comparison::CompareOptions& options, const std::string& mesh_name,
                            const echinus::Image& picture);
