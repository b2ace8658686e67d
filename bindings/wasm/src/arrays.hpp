#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace echinus::wasm {

/// Lists of numbers for JavaScript; the function that makes them documents their contents.
struct Arrays {
    std::array<std::vector<std::uint32_t>, 5> numbers;
    std::array<std::vector<float>, 1> floats;
};

} // namespace echinus::wasm
