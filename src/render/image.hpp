#pragma once

#include <echinus/render.hpp>

#include <cstdint>
#include <string>

namespace echinus {

/// "640 x 480 pixels"
std::string size_text(std::uint64_t width, std::uint64_t height);

/// @throws Error InvalidOptions for a size outside the limits of RenderOptions
void require_drawable(std::uint64_t width, std::uint64_t height);

/// @throws Error InvalidOptions when the picture is empty or its size is not that of its data
void require_consistent(const Image& image);

} // namespace echinus
