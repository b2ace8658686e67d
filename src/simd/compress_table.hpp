#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// For up to eight lanes, one bit each: the chosen lanes in their order, then the others.
namespace echinus {

inline constexpr auto kCompressTable = [] {
    std::array<std::array<std::uint8_t, 8>, 256> table{};
    for (std::size_t bits = 0; bits < table.size(); ++bits) {
        std::size_t count = 0;
        for (const std::size_t chosen : {1, 0})
            for (std::uint8_t lane = 0; lane < 8; ++lane)
                if ((bits >> lane & 1) == chosen) table[bits][count++] = lane;
    }
    return table;
}();

} // namespace echinus
