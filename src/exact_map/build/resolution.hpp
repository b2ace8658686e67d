#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace echinus {

/// Divisions of each octant that suit a mesh when nothing else is asked for. docs/performance.md has the
/// sweep behind the rule.
/// @param open  the surface has a border
std::uint32_t default_divisions(std::size_t face_count, bool open);

/// The most divisions whose map has at most `byte_budget` bytes, up to where more of them help no longer: of
/// an open surface that is the default, as its build takes long and gets no surer with more cells.
/// @param byte_count  of the map with so many divisions; asked some ten times
/// @throws Error InvalidOptions when one division is too many
std::uint32_t divisions_within(std::size_t byte_budget, std::size_t face_count, bool open,
                               const std::function<std::size_t(std::uint32_t divisions)>& byte_count);

} // namespace echinus
