#pragma once

#include "directions/octahedral_cells.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

/// Tables about the 16 parts of a cell, for covering cells by strips of parts.
///
/// A row of parts across a square of two cells is a *strip* of eight triangles, in the order of the row:
/// parts that are not turned have even numbers, turned ones odd numbers. In rows 0 to 3, the first 7, 5, 3
/// and 1 belong to the *up* cell, the others to the *down* cell, which numbers its own rows and parts from
/// the other end.
namespace echinus {

inline constexpr std::size_t kPartRows = OctahedralCells::kPartsPerSide;
inline constexpr int kStripLength = 2 * OctahedralCells::kPartsPerSide;
/// The first part of each row.
inline constexpr std::array<std::uint32_t, kPartRows> kRowBegin{0, 7, 12, 15};

/// Converts the touched triangles of a strip to parts of the two cells: those of the up cell are in the lower
/// 16 bits, those of the down cell in the upper ones.
inline constexpr auto kPartsOfStrip = [] {
    std::array<std::array<std::uint32_t, 1U << kStripLength>, kPartRows> table{};
    for (std::size_t row = 0; row < kPartRows; ++row)
        for (std::uint32_t strip = 0; strip < table[row].size(); ++strip)
            for (std::uint32_t place = 0; place < kStripLength; ++place) {
                if ((strip >> place & 1U) == 0) continue;
                const auto up_count = static_cast<std::uint32_t>(7 - 2 * row);
                const std::uint32_t bit = place < up_count
                                              ? kRowBegin[row] + place
                                              : 16 + kRowBegin[kPartRows - 1 - row] + (7 - place);
                table[row][strip] |= 1U << bit;
            }
    return table;
}();

/// Represents the part of a row that has none.
inline constexpr std::uint8_t kNoPart = OctahedralCells::kPartCount;

/// The first and the last part of each row in a set of parts, or kNoPart.
class RowEnds {
  public:
    constexpr RowEnds() {
        for (std::uint32_t set = 0; set < top_.size(); ++set)
            for (std::size_t end = 0; end < 2; ++end) top_[set][end] = end_of(set, 0, end);
        for (std::uint32_t set = 0; set < others_.size(); ++set)
            for (std::size_t end = 0; end < 2; ++end)
                for (std::size_t row = 1; row < kPartRows; ++row)
                    others_[set][end][row - 1] = end_of(set << kTopCount, row, end);
    }

    /// @param end  0 for the first, 1 for the last
    constexpr std::array<std::uint8_t, kPartRows> of(std::uint32_t set, std::size_t end) const {
        const auto& others = others_[set >> kTopCount][end];
        return {top_[set & ((1U << kTopCount) - 1)][end], others[0], others[1], others[2]};
    }

  private:
    static constexpr std::uint32_t kTopCount = 7; ///< parts in row 0

    static constexpr std::uint8_t end_of(std::uint32_t set, std::size_t row, std::size_t end) {
        const auto count = static_cast<std::uint32_t>(7 - 2 * row);
        const std::uint32_t in_row = set >> kRowBegin[row] & ((1U << count) - 1);
        if (in_row == 0) return kNoPart;
        const int place = end == 0 ? std::countr_zero(in_row) : std::bit_width(in_row) - 1;
        return static_cast<std::uint8_t>(kRowBegin[row] + static_cast<std::uint32_t>(place));
    }

    std::array<std::array<std::uint8_t, 2>, 1U << kTopCount> top_{};
    std::array<std::array<std::array<std::uint8_t, kPartRows - 1>, 2>, 1U << 9> others_{};
};

inline constexpr RowEnds kRowEnds;

/// The origins of the parts of an up cell, in widths of a part and relative to the cell's origin, and which
/// parts are turned. Each number has its own array, so that a loop over the parts is vectorised.
struct PartPlaces {
    std::array<double, OctahedralCells::kPartCount> x{}, y{}, upright{}, turned{};

    constexpr PartPlaces() {
        for (std::size_t row = 0, part = 0; row < kPartRows; ++row)
            for (std::size_t place = 0; place < 7 - 2 * row; ++place, ++part) {
                const std::size_t is_turned = place % 2;
                x[part] = static_cast<double>(row + is_turned);
                y[part] = static_cast<double>(place / 2 + is_turned);
                turned[part] = static_cast<double>(is_turned);
                upright[part] = 1 - turned[part];
            }
    }
};

inline constexpr PartPlaces kPartPlaces;

} // namespace echinus
