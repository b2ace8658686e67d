#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace echinus {

/// The default divisions of each octant for a mesh. docs/performance.md contains the measurements behind the
/// rule.
/// @param open  the surface has a border
std::uint32_t default_divisions(std::size_t face_count, bool open);

/// The limit of a map's bytes if the options set none: about ten times the usual size. Without it, a map of
/// long faces that lie close together, like the teeth of a comb, would grow with the square of their number.
///
/// Every mesh has a map within the limit, that of one division. Let it have f faces. Its surface takes at
/// most 91 bytes per face: up to 3 vertices of 12 bytes, 3 corners and a number of 4, 3 border edges of 12,
/// and 128/56 of the tree. A face lies in at most 8 cells. In each it is listed once or, if its band is
/// split, twice, at 6 bytes; and it makes at most one band or two halves, of 10 bytes each. That is 91 + 8 (2
/// * 6 + 2 * 10) = 347. In a map of an open surface no band is split. There a face makes one band, which may
/// need a second one without faces to mark the space beyond it, and the gap below the band may be cut into
/// two pieces (GapStates): 91 + 8 (6 + 3 * 10) = 379. Only a few cells and nodes of the tree do not grow with
/// the number of faces.
/// @param vertex_count  vertices of the mesh; those beyond 3 per face, which no face uses, raise the limit
std::size_t default_byte_limit(std::size_t face_count, std::size_t vertex_count);

/// The most divisions worth trying if only bytes are limited: for an open surface the default, since its
/// build takes long and more cells make no answer more certain.
std::uint32_t most_useful_divisions(std::size_t face_count, bool open);

/// A size that should be reached and one that must not be exceeded.
struct ByteRange {
    std::size_t enough, limit;
};

/// The most divisions whose bands keep within the limit, or fewer if those suffice. Tries coarse maps first,
/// so that all attempts together take about three times as long as the last one alone.
/// @param most        the most divisions to try
/// @param byte_count  the bytes of the bands of a map with this many divisions; nothing if they exceed the
///                    limit
/// @returns  the divisions for which `byte_count` last succeeded; nothing if it never did
std::optional<std::uint32_t>
finest_within(const ByteRange& bytes, std::uint32_t most,
              const std::function<std::optional<std::size_t>(std::uint32_t divisions)>& byte_count);

} // namespace echinus
