#pragma once

#include <echinus/render.hpp>

#include <cstdint>

namespace echinus {

/// Linear light (Rec. 709 primaries, as sRGB) of a colour.
Vec3f to_linear(const Colour& colour);

/// The nearest 8-bit sRGB values of linear light, clamped to [0, 1].
std::array<std::uint8_t, 3> to_srgb8(const Vec3f& linear);

/// Compresses light above 0.9 smoothly below 1 and desaturates it; leaves the rest unchanged, so that the
/// palette's colours keep their hue and value. The shoulder of the Khronos PBR Neutral tone mapper (2024),
/// without its treatment of reflections, which matte surfaces lack.
Vec3f compress_highlights(const Vec3f& linear);

} // namespace echinus
