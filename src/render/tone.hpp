#pragma once

#include <echinus/render.hpp>

#include <cstdint>

namespace echinus {

/// Linear light (Rec. 709 primaries, as sRGB) of a colour.
Vec3f to_linear(const Colour& colour);

/// The nearest 8-bit sRGB values of linear light; what lies outside [0, 1] is clamped.
std::array<std::uint8_t, 3> to_srgb8(const Vec3f& linear);

/// Bends light above 0.9 softly below 1 and turns it paler, and leaves the rest as it is, so that a colour
/// of the palette keeps its hue and value. The shoulder of the Khronos PBR Neutral tone mapper (2024);
/// without its treatment of reflections, of which matte surfaces have none.
Vec3f compress_highlights(const Vec3f& linear);

} // namespace echinus
