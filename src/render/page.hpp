#pragma once

#include <echinus_render/render.hpp>

#include <span>

namespace echinus {

/// A place on a picture, in pixels from its upper left corner.
struct PagePoint {
    double x = 0, y = 0;
};

struct PageStroke {
    PagePoint start, end;
};

/// Draws strokes of one width with round ends as one shape: overlaps do not show. Parts outside the picture
/// are not drawn.
void draw_strokes(Image& image, std::span<const PageStroke> strokes, double width_px, Colour colour);

} // namespace echinus
