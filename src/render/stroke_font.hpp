#pragma once

#include <array>
#include <vector>

namespace echinus {

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

/// The letter for a printable ASCII character; a box for any other.
const Glyph& glyph_of(char character);

} // namespace echinus
