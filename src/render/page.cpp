// What is drawn over traced pictures: lettering, lines, the arrangement of several on one page.

#include "render/page.hpp"

#include "render/image.hpp"
#include "render/stroke_font.hpp"

#include <echinus/error.hpp>
#include <echinus/render.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

double distance_to(const PageStroke& stroke, double x, double y) {
    const double along_x = stroke.end.x - stroke.start.x;
    const double along_y = stroke.end.y - stroke.start.y;
    const double size_sq = along_x * along_x + along_y * along_y;
    const double projection = (x - stroke.start.x) * along_x + (y - stroke.start.y) * along_y;
    const double t = size_sq > 0 ? std::clamp(projection / size_sq, 0.0, 1.0) : 0;
    return std::hypot(x - stroke.start.x - t * along_x, y - stroke.start.y - t * along_y);
}

double distance_to_nearest(std::span<const PageStroke> strokes, double x, double y) {
    double distance = std::numeric_limits<double>::infinity();
    for (const PageStroke& stroke : strokes) distance = std::min(distance, distance_to(stroke, x, y));
    return distance;
}

/// Blends in a colour. In sRGB, not in linear light, which would make dark letters on a pale page thinner.
void mix_in(std::uint8_t* rgb, const Colour& colour, double share) {
    const float parts[] = {colour.red, colour.green, colour.blue};
    for (std::size_t k = 0; k < 3; ++k) {
        const double target = 255 * std::clamp(parts[k], 0.0F, 1.0F);
        rgb[k] = static_cast<std::uint8_t>(std::lround(rgb[k] + (target - rgb[k]) * share));
    }
}

void fill(Image& image, const Colour& colour) {
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) mix_in(&image.rgb[i], colour, 1);
}

/// The range of pixels along one axis that strokes can touch.
struct PixelRange {
    double low = std::numeric_limits<double>::infinity(), high = -low;

    void add(double a, double b) {
        low = std::min({low, a, b});
        high = std::max({high, a, b});
    }
    std::uint32_t begin(double reach, std::uint32_t size) const { return clip(low - reach, size); }
    std::uint32_t end(double reach, std::uint32_t size) const { return clip(high + reach + 1, size); }

  private:
    static std::uint32_t clip(double value, std::uint32_t size) {
        return static_cast<std::uint32_t>(std::clamp(value, 0.0, static_cast<double>(size)));
    }
};

} // namespace

void draw_strokes(Image& image, std::span<const PageStroke> strokes, double width_px, Colour colour) {
    PixelRange columns, rows;
    for (const PageStroke& stroke : strokes) {
        columns.add(stroke.start.x, stroke.end.x);
        rows.add(stroke.start.y, stroke.end.y);
    }
    const double reach = width_px / 2 + 1;
    for (std::uint32_t y = rows.begin(reach, image.height); y < rows.end(reach, image.height); ++y) {
        for (std::uint32_t x = columns.begin(reach, image.width); x < columns.end(reach, image.width); ++x) {
            const double clear = distance_to_nearest(strokes, x + 0.5, y + 0.5) - width_px / 2;
            const double share = std::clamp(0.5 - clear, 0.0, 1.0);
            if (share > 0) mix_in(&image.rgb[3 * (std::size_t{y} * image.width + x)], colour, share);
        }
    }
}

double text_width(std::string_view text, double height_px) {
    double width = 0;
    for (char character : text) width += glyph_of(character).width + kLetterGap;
    return std::max(width - kLetterGap, 0.0) * height_px / kCapitalHeight;
}

void draw_text(Image& image, double x, double y, std::string_view text, double height_px, Colour colour,
               TextAlign align) {
    const double unit = height_px / kCapitalHeight;
    const double width = text_width(text, height_px);
    double left = x;
    if (align == TextAlign::Centre) left -= width / 2;
    if (align == TextAlign::Right) left -= width;
    for (char character : text) {
        const Glyph& glyph = glyph_of(character);
        std::vector<PageStroke> strokes;
        for (const Stroke& stroke : glyph.strokes) {
            strokes.push_back({{left + stroke.start[0] * unit, y - stroke.start[1] * unit},
                               {left + stroke.end[0] * unit, y - stroke.end[1] * unit}});
        }
        draw_strokes(image, strokes, kStrokeWidth * unit, colour);
        left += (glyph.width + kLetterGap) * unit;
    }
}

Image arrange(std::span<const Image> pictures, std::uint32_t column_count) {
    if (pictures.empty() || column_count == 0) {
        throw Error(ErrorCode::InvalidOptions, "a page needs at least one picture and one column");
    }
    const Image& first = pictures.front();
    for (const Image& picture : pictures) {
        require_consistent(picture);
        if (picture.width == first.width && picture.height == first.height) continue;
        throw Error(ErrorCode::InvalidOptions, "pictures on one page must have one size; found " +
                                                   size_text(first.width, first.height) + " and " +
                                                   size_text(picture.width, picture.height));
    }
    const auto columns = std::min<std::uint64_t>(column_count, pictures.size());
    const std::uint64_t rows = (pictures.size() + columns - 1) / columns;
    require_drawable(columns * first.width, rows * first.height);
    Image page{static_cast<std::uint32_t>(columns * first.width),
               static_cast<std::uint32_t>(rows * first.height),
               {}};
    page.rgb.resize(std::size_t{3} * page.width * page.height);
    fill(page, palette::kPage);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const std::size_t left = i % columns * first.width;
        const std::size_t top = i / columns * first.height;
        for (std::size_t y = 0; y < first.height; ++y) {
            std::copy_n(&pictures[i].rgb[3 * y * first.width], std::size_t{3} * first.width,
                        &page.rgb[3 * ((top + y) * page.width + left)]);
        }
    }
    return page;
}

} // namespace echinus
