#pragma once

#include <filesystem>
#include <string>

namespace echinus {

/// What a path's name ends in, with the dot, in lower case: ".obj" for "A/Horse.OBJ".
std::string lower_case_ending(const std::filesystem::path& path);

} // namespace echinus
