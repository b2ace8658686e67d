#pragma once

#include "page.hpp"

#include <filesystem>

/// Reads what `echinus simulate` left in FOLDER/horse and FOLDER/torus. Adds the table rates.
/// @throws echinus::Error Unreadable or Damaged
void read_simulations(const std::filesystem::path& folder, Values& values);
