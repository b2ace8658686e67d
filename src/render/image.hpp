#pragma once

#include <echinus_render/render.hpp>

#include <cstdint>
#include <span>
#include <string>

namespace echinus::render {

/// The linear light of a colour (Rec. 709 primaries, as in sRGB).
Vec3f to_linear(const Colour& colour);

/// The nearest 8-bit sRGB values of linear light, clamped to [0, 1].
std::array<std::uint8_t, 3> to_srgb8(const Vec3f& linear);

/// Compresses light above 0.9 smoothly below 1 and desaturates it; leaves the rest unchanged, so that the
/// palette's colours keep their hue and value. The shoulder of the Khronos PBR Neutral tone mapper (2024),
/// without its treatment of reflections, which matte surfaces lack.
Vec3f compress_highlights(const Vec3f& linear);

/// "640 x 480 pixels"
std::string size_text(std::uint64_t width, std::uint64_t height);

/// @throws Error InvalidOptions for a size outside the limits of RenderOptions
void require_drawable(std::uint64_t width, std::uint64_t height);

/// @throws Error InvalidOptions if the picture is empty or its size does not match its data
void require_consistent(const Image& image);

/// A position on a picture, in pixels from its upper left corner.
struct PagePoint {
    double x = 0, y = 0;
};

struct PageStroke {
    PagePoint start, end;
};

/// Draws strokes of one width with round ends as one shape: overlaps do not show. Parts outside the picture
/// are not drawn.
void draw_strokes(Image& image, std::span<const PageStroke> strokes, double width_px, Colour colour);

} // namespace echinus::render
