#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace echinus {

/// The default divisions of each octant for a mesh. docs/performance.md has the sweep behind the rule.
/// @param open  the surface has a border
std::uint32_t default_divisions(std::size_t face_count, bool open);

/// The most divisions whose map has at most `byte_budget` bytes, up to the number beyond which more do not
/// help: for an open surface the default, as its build is slow and more cells add no certainty.
/// @param byte_count  of the map with so many divisions; asked some ten times
/// @throws Error InvalidOptions when one division is too many
std::uint32_t divisions_within(std::size_t byte_budget, std::size_t face_count, bool open,
                               const std::function<std::size_t(std::uint32_t divisions)>& byte_count);

} // namespace echinus
