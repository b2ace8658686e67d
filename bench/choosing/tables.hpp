#pragma once

#include "models.hpp"

#include <span>
#include <string>

/// Of each model a heading and a Markdown table with a row for each system, and remarks.
std::string tables_of(std::span<const Model> models);
