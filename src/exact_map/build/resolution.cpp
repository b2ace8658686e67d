#include "exact_map/build/resolution.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace echinus {

std::uint32_t default_divisions(std::size_t face_count, bool open) {
    // Cells in the ratio of 4 to 5 to faces: then map and mesh share the memory evenly. Fewer cells make
    // lists longer in proportion, more make them hardly shorter, as then each face lies in several cells.
    constexpr double kCellsPerFace = 0.8;
    const double divisions = std::sqrt(kCellsPerFace * static_cast<double>(face_count) / 8);
    // The smaller a cell, the less the winding number changes in it: what is certain depends on this.
    const std::uint32_t least = open ? 20 : 4;
    return std::clamp(static_cast<std::uint32_t>(std::lround(divisions)), least,
                      ExactMapOptions::kMaxDivisions);
}

std::uint32_t divisions_within(std::size_t byte_budget, std::size_t face_count, bool open,
                               const std::function<std::size_t(std::uint32_t divisions)>& byte_count) {
    const std::size_t least = byte_count(1);
    if (least > byte_budget)
        throw Error(ErrorCode::InvalidOptions,
                    "the budget of " + std::to_string(byte_budget) +
                        " bytes is less than the coarsest map needs: " + std::to_string(least));
    // Sixteen times as many cells as by default: nearly every band holds two or three faces.
    const std::uint32_t usual = default_divisions(face_count, open);
    std::uint32_t most = open ? usual : std::min(4 * usual, ExactMapOptions::kMaxDivisions);
    std::uint32_t fitting = 1;
    while (fitting < most) {
        const std::uint32_t middle = fitting + (most - fitting + 1) / 2;
        if (byte_count(middle) <= byte_budget)
            fitting = middle;
        else
            most = middle - 1;
    }
    return fitting;
}

} // namespace echinus
