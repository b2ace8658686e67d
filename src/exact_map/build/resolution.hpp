#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace echinus {

/// The default divisions of each octant for a mesh. docs/performance.md has the sweep behind the rule.
/// @param open  the surface has a border
std::uint32_t default_divisions(std::size_t face_count, bool open);

/// Bytes that a map stays within when nothing else is asked for: some ten times what a mesh usually takes.
/// Where faces are long and lie close together, as the teeth of a comb, a map grows with the square of their
/// number otherwise.
///
/// Every mesh has a map that stays within, that of one division. Let it have f faces. Its surface takes at
/// most 91 bytes a face: up to 3 vertices of 12 bytes, 3 corners and a number of 4, 3 border edges of 12, and
/// 128/56 of the tree. A face lies in 8 cells at most. There it is listed once or, when its band is split,
/// twice, at 6 bytes; and it makes one band at most, or two halves, of 10 bytes each. That is 91 + 8 (2 * 6 +
/// 2 * 10) = 347. In a map of an open surface no band is split. There a face makes one band, which may need
/// another without faces to mark what is beyond it, and the gap below the band may be cut into two pieces
/// (GapStates): 91 + 8 (6 + 3 * 10) = 379. What does not grow with the faces is a few cells and nodes of the
/// tree.
/// @param vertex_count  of the mesh; those beyond 3 a face, which no face uses, come on top
std::size_t default_byte_limit(std::size_t face_count, std::size_t vertex_count);

/// How far up it is worth going when only bytes count: of an open surface the default, as its build takes
/// long and gets no surer with more cells.
std::uint32_t most_useful_divisions(std::size_t face_count, bool open);

/// Bytes that are to be reached and not to be exceeded.
struct ByteRange {
    std::size_t enough, limit;
};

/// The most divisions whose bands keep within the limit, or fewer when those reach enough. Goes from coarse
/// to fine, so that all maps that are tried take about three times as long as the last alone.
/// @param most        how far to go
/// @param byte_count  of the bands of a map with so many divisions; nothing when it exceeds the limit
/// @returns  the divisions that `byte_count` was last asked about with success; nothing if there are none
std::optional<std::uint32_t>
finest_within(const ByteRange& bytes, std::uint32_t most,
              const std::function<std::optional<std::size_t>(std::uint32_t divisions)>& byte_count);

} // namespace echinus
