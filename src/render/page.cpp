#include "render/image.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <vector>

namespace echinus::render {

// Draws lettering and lines over traced pictures, and arranges several pictures on one page.

namespace {

/// A straight piece of a letter, in units of a tenth of a capital's height: x to the right from the letter's
/// left edge, y up from the base line.
struct Stroke {
    std::array<float, 2> start, end;
};

struct Glyph {
    float width = 0; ///< without the gap to the next letter
    std::vector<Stroke> strokes;
};

inline constexpr float kCapitalHeight = 10;

inline constexpr float kLetterGap = 2.7F;

inline constexpr float kStrokeWidth = 1.15F;

using Point = std::array<float, 2>;

/// A letter as it is drawn by hand. A path is a sequence of commands, each followed by numbers:
///   M x y      lift the pen and go to (x, y)
///   L x y      line
///   V x y      quarter of an ellipse that leaves vertically and arrives horizontally
///   H x y      quarter of an ellipse that leaves horizontally and arrives vertically
///   Q c d x y  quadratic curve with the control point (c, d)
struct GlyphPath {
    float width;
    const char* path;
};

/// Plain upright letters with round strokes, as on technical drawings, from ' ' to '~'.
constexpr GlyphPath kPaths[] = {
    {1.6F, ""},
    {0.0F, "M0 10 L0 3.2 M0 .2 L0 .3"},
    {2.0F, "M0 10 L0 7.4 M2 10 L2 7.4"},
    {6.4F, "M1.6 0 L2.6 10 M4.2 0 L5.2 10 M.4 6.7 L6.4 6.7 M0 3.3 L6 3.3"},
    {5.8F,
     "M5.4 8.3 Q4.8 10 2.9 10 H.3 7.6 Q.3 5.9 2.9 5.3 Q5.8 4.7 5.8 2.6 V2.9 0 Q.7 0 0 2 M2.9 11.4 L2.9 -1.4"},
    {7.4F, "M.8 0 L6.6 10 M0 8 V1.6 10 H3.2 8 V1.6 6 H0 8 M4.2 2 V5.8 4 H7.4 2 V5.8 0 H4.2 2"},
    {6.8F,
     "M6.8 0 L1.4 6.7 Q.8 7.4 .8 8.1 V2.6 10 H4.4 8.1 Q4.4 6.8 2.4 5.6 Q0 4.2 0 2.5 V2.6 0 Q5.4 0 6 4.4"},
    {0.0F, "M0 10 L0 7.4"},
    {2.0F, "M2 11 Q-1.6 4.5 2 -2"},
    {2.0F, "M0 11 Q3.6 4.5 0 -2"},
    {4.0F, "M2 10 L2 6 M.3 9 L3.7 7 M3.7 9 L.3 7"},
    {5.0F, "M0 4.5 L5 4.5 M2.5 2 L2.5 7"},
    {0.6F, "M.6 .3 L0 -1.6"},
    {3.4F, "M0 4.2 L3.4 4.2"},
    {0.0F, "M0 .2 L0 .3"},
    {4.4F, "M0 -1 L4.4 10.8"},
    {6.0F, "M0 7 V3 10 H6 7 L6 3 V3 0 H0 3 L0 7"},
    {3.6F, "M.6 8 L3 10 L3 0"},
    {6.0F, "M.2 7.4 V3 10 H6 7.3 Q6 5.4 4 3.6 L0 0 L6 0"},
    {6.0F, "M.4 8.2 Q1.1 10 3 10 H5.7 7.7 V3 5.4 L2 5.4 M3 5.4 H6 2.7 V3 0 Q.8 0 0 2"},
    {6.2F, "M4.6 0 L4.6 10 L0 3 L6.2 3"},
    {6.0F, "M5.4 10 L1 10 L.6 5.4 Q1.6 6.3 3 6.3 H6 3.2 V3 0 Q.9 0 0 1.7"},
    {6.0F, "M5.3 9 Q4.5 10 3.2 10 H0 5 L0 3.1 V3 0 H6 3.1 V3 6.2 H0 3.1"},
    {6.0F, "M0 10 L6 10 L2 0"},
    {6.0F, "M3 5.4 H.4 7.7 V3 10 H5.6 7.7 V3 5.4 H0 2.7 V3 0 H6 2.7 V3 5.4"},
    {6.0F, "M.7 1 Q1.5 0 2.8 0 H6 5 L6 6.9 V3 10 H0 6.9 V3 3.8 H6 6.9"},
    {0.0F, "M0 .2 L0 .3 M0 5.6 L0 5.7"},
    {0.6F, "M.6 .3 L0 -1.6 M.5 5.6 L.5 5.7"},
    {5.0F, "M5 7.4 L0 4.5 L5 1.6"},
    {5.0F, "M0 5.8 L5 5.8 M0 3.2 L5 3.2"},
    {5.0F, "M0 7.4 L5 4.5 L0 1.6"},
    {5.0F, "M0 7.9 Q.4 10 2.5 10 H5 7.6 Q5 6 3.6 5 Q2.4 4.2 2.4 3 M2.4 .2 L2.4 .3"},
    {9.0F,
     "M6.5 4.7 V4.5 6.7 H2.5 4.7 V4.5 2.7 H6.5 4.7 L6.5 3.8 Q6.6 2.6 7.7 2.6 H9 5 V4.6 9.4 H0 4.4 V4.8 -.6 "
     "Q6.4 -.6 7.6 .2"},
    {7.0F, "M0 0 L3.5 10 L7 0 M1.2 3.4 L5.8 3.4"},
    {6.0F, "M0 0 L0 10 L3 10 H5.5 7.7 V3 5.4 L0 5.4 M3 5.4 H6 2.7 V3 0 L0 0"},
    {6.3F, "M6.3 8 Q5.4 10 3.4 10 H0 6.6 L0 3.4 V3.4 0 Q5.4 0 6.3 2"},
    {6.4F, "M0 0 L0 10 L2.8 10 H6.4 6.4 L6.4 3.6 V2.8 0 L0 0"},
    {5.4F, "M5.4 10 L0 10 L0 0 L5.4 0 M0 5.3 L4.7 5.3"},
    {5.2F, "M5.2 10 L0 10 L0 0 M0 5.2 L4.5 5.2"},
    {6.6F, "M6.3 8.1 Q5.4 10 3.4 10 H0 6.6 L0 3.4 V3.4 0 H6.6 3.2 L6.6 4.6 L3.8 4.6"},
    {6.2F, "M0 0 L0 10 M6.2 0 L6.2 10 M0 5.2 L6.2 5.2"},
    {0.0F, "M0 0 L0 10"},
    {4.4F, "M4.4 10 L4.4 2.6 V2.1 0 Q.6 0 0 1.6"},
    {6.0F, "M0 0 L0 10 M5.7 10 L0 3.8 M2.1 6.1 L6 0"},
    {5.0F, "M0 10 L0 0 L5 0"},
    {7.6F, "M0 0 L0 10 L3.8 3 L7.6 10 L7.6 0"},
    {6.4F, "M0 0 L0 10 L6.4 0 L6.4 10"},
    {7.0F, "M0 6.5 V3.5 10 H7 6.5 L7 3.5 V3.5 0 H0 3.5 L0 6.5"},
    {5.8F, "M0 0 L0 10 L3 10 H5.8 7.3 V3 4.6 L0 4.6"},
    {7.2F, "M0 6.5 V3.5 10 H7 6.5 L7 3.5 V3.5 0 H0 3.5 L0 6.5 M4.4 2.6 L7.2 -.6"},
    {6.0F, "M0 0 L0 10 L3 10 H5.8 7.3 V3 4.6 L0 4.6 M3 4.6 L6 0"},
    {5.8F, "M5.4 8.3 Q4.8 10 2.9 10 H.3 7.6 Q.3 5.9 2.9 5.3 Q5.8 4.7 5.8 2.6 V2.9 0 Q.7 0 0 2"},
    {6.4F, "M0 10 L6.4 10 M3.2 10 L3.2 0"},
    {6.2F, "M0 10 L0 3.1 V3.1 0 H6.2 3.1 L6.2 10"},
    {6.8F, "M0 10 L3.4 0 L6.8 10"},
    {9.6F, "M0 10 L2.4 0 L4.8 10 L7.2 0 L9.6 10"},
    {6.2F, "M0 10 L6.2 0 M6.2 10 L0 0"},
    {6.6F, "M0 10 L3.3 4.8 L6.6 10 M3.3 4.8 L3.3 0"},
    {6.0F, "M0 10 L6 10 L0 0 L6 0"},
    {2.0F, "M2 11 L0 11 L0 -2 L2 -2"},
    {4.4F, "M0 10.8 L4.4 -1"},
    {2.0F, "M0 11 L2 11 L2 -2 L0 -2"},
    {4.4F, "M0 6.6 L2.2 10 L4.4 6.6"},
    {5.4F, "M0 -1.6 L5.4 -1.6"},
    {1.6F, "M0 10.4 L1.6 8.6"},
    {5.0F, "M5 7 L5 0 M5 3.5 V2.5 7 H0 3.5 V2.5 0 H5 3.5"},
    {5.0F, "M0 10 L0 0 M0 3.5 V2.5 7 H5 3.5 V2.5 0 H0 3.5"},
    {4.6F, "M4.6 5.6 Q3.9 7 2.6 7 H0 3.5 V2.6 0 Q3.9 0 4.6 1.4"},
    {5.0F, "M5 10 L5 0 M5 3.5 V2.5 7 H0 3.5 V2.5 0 H5 3.5"},
    {5.0F, "M0 3.7 L5 3.7 V2.5 7 H0 3.5 V2.6 0 Q4 0 4.7 1.5"},
    {3.4F, "M3.4 9.9 Q1.4 10.4 1.4 8 L1.4 0 M0 6.8 L3.2 6.8"},
    {5.0F, "M5 7 L5 -.6 V2.5 -3 Q1 -3 .3 -2 M5 3.5 V2.5 7 H0 3.5 V2.5 0 H5 3.5"},
    {4.8F, "M0 10 L0 0 M0 4.4 V2.5 7 H4.8 4.4 L4.8 0"},
    {0.0F, "M0 7 L0 0 M0 9.6 L0 9.7"},
    {1.4F, "M1.4 7 L1.4 -1 Q1.4 -3 -.3 -2.9 M1.4 9.6 L1.4 9.7"},
    {4.5F, "M0 10 L0 0 M4.3 7 L0 2.6 M1.6 4.2 L4.5 0"},
    {1.4F, "M0 10 L0 1.8 V1.4 0"},
    {8.0F, "M0 7 L0 0 M0 4.6 V2.1 7 H4 4.6 L4 0 M4 4.6 V6.1 7 H8 4.6 L8 0"},
    {4.8F, "M0 7 L0 0 M0 4.4 V2.5 7 H4.8 4.4 L4.8 0"},
    {5.2F, "M0 3.5 V2.6 7 H5.2 3.5 V2.6 0 H0 3.5"},
    {5.0F, "M0 7 L0 -3 M0 3.5 V2.5 7 H5 3.5 V2.5 0 H0 3.5"},
    {5.0F, "M5 7 L5 -3 M5 3.5 V2.5 7 H0 3.5 V2.5 0 H5 3.5"},
    {3.0F, "M0 7 L0 0 M0 4.2 V2.3 7 L3 6.9"},
    {4.3F, "M4 5.8 Q3.5 7 2.1 7 H.3 5.4 Q.3 4.1 2.2 3.7 Q4.3 3.2 4.3 1.8 V2.1 0 Q.5 0 0 1.4"},
    {3.2F, "M1.2 9.2 L1.2 2 V2.6 0 L3.2 .1 M0 6.8 L3.1 6.8"},
    {4.8F, "M0 7 L0 2.6 V2.3 0 H4.8 2.6 M4.8 7 L4.8 0"},
    {4.8F, "M0 7 L2.4 0 L4.8 7"},
    {7.2F, "M0 7 L1.8 0 L3.6 7 L5.4 0 L7.2 7"},
    {4.6F, "M0 7 L4.6 0 M4.6 7 L0 0"},
    {4.8F, "M0 7 L2.4 0 M4.8 7 L1.6 -2.2 Q1.3 -3 .2 -3"},
    {4.4F, "M0 7 L4.4 7 L0 0 L4.4 0"},
    {2.6F, "M2.6 11 Q1.2 11 1.2 9 L1.2 6.4 Q1.2 4.5 0 4.5 Q1.2 4.5 1.2 2.6 L1.2 0 Q1.2 -2 2.6 -2"},
    {0.0F, "M0 11 L0 -2"},
    {2.6F, "M0 11 Q1.4 11 1.4 9 L1.4 6.4 Q1.4 4.5 2.6 4.5 Q1.4 4.5 1.4 2.6 L1.4 0 Q1.4 -2 0 -2"},
    {5.2F, "M0 3.9 Q1.3 6 2.6 4.5 Q3.9 3 5.2 5.1"},
};
constexpr GlyphPath kUnknown = {6.0F, "M0 0 L0 10 L6 10 L6 0 L0 0"};
constexpr char kFirst = ' ';
constexpr std::size_t kGlyphCount = std::size(kPaths);
static_assert(kFirst + kGlyphCount - 1 == '~');

constexpr int kCurvePieces = 8;

/// Follows a path and records the strokes that the pen draws.
class Pen {
  public:
    explicit Pen(std::vector<Stroke>& strokes) : strokes_(strokes) {}

    void move_to(const Point& end) { place_ = end; }
    void line_to(const Point& end) {
        strokes_.push_back({place_, end});
        place_ = end;
    }
    void quarter_to(const Point& end, bool leaves_vertically) {
        const Point start = place_;
        for (int piece = 1; piece <= kCurvePieces; ++piece) {
            const float angle = static_cast<float>(piece) / kCurvePieces * std::numbers::pi_v<float> / 2;
            const float along = std::sin(angle);      // of the side that the pen leaves along
            const float across = 1 - std::cos(angle); // of the other
            line_to({start[0] + (end[0] - start[0]) * (leaves_vertically ? across : along),
                     start[1] + (end[1] - start[1]) * (leaves_vertically ? along : across)});
        }
    }
    void curve_to(const Point& control, const Point& end) {
        const Point start = place_;
        for (int piece = 1; piece <= kCurvePieces; ++piece) {
            const float t = static_cast<float>(piece) / kCurvePieces;
            const auto blend = [&](std::size_t k) {
                return (1 - t) * (1 - t) * start[k] + 2 * t * (1 - t) * control[k] + t * t * end[k];
            };
            line_to({blend(0), blend(1)});
        }
    }

  private:
    std::vector<Stroke>& strokes_;
    Point place_{};
};

Point read_point(const char*& path) {
    char* after = nullptr;
    const float x = std::strtof(path, &after);
    const float y = std::strtof(after, &after);
    path = after;
    return {x, y};
}

Glyph draw_glyph(const GlyphPath& source) {
    Glyph glyph{source.width, {}};
    Pen pen(glyph.strokes);
    for (const char* path = source.path; *path != '\0';) {
        const char command = *path++;
        if (command == ' ') continue;
        const Point point = read_point(path);
        if (command == 'M') pen.move_to(point);
        if (command == 'L') pen.line_to(point);
        if (command == 'V' || command == 'H') pen.quarter_to(point, command == 'V');
        if (command == 'Q') pen.curve_to(point, read_point(path));
    }
    return glyph;
}

std::array<Glyph, kGlyphCount + 1> draw_all() {
    std::array<Glyph, kGlyphCount + 1> glyphs;
    for (std::size_t i = 0; i < kGlyphCount; ++i) glyphs[i] = draw_glyph(kPaths[i]);
    glyphs[kGlyphCount] = draw_glyph(kUnknown);
    return glyphs;
}

/// The letter for a printable ASCII character; a box for any other.
const Glyph& glyph_of(char character) {
    static const auto glyphs = draw_all();
    const bool known = character >= kFirst && character <= '~';
    return glyphs[known ? static_cast<std::size_t>(character - kFirst) : kGlyphCount];
}

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

/// Blends in a colour, in sRGB: linear light would make dark letters on a pale page look thinner.
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

} // namespace echinus::render
