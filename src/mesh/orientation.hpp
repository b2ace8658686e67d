#pragma once

#include "mesh/edges.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Which way faces run, as seen across edges with exactly two faces. Faces joined by such edges are a patch.
struct Orientation {
    std::vector<std::uint32_t> patch_of_face; ///< [face_count] numbered in the order of their first faces
    std::vector<bool> is_turned;              ///< [face_count] against the first face of the patch
    std::vector<bool> is_orientable; ///< [patch_count] all ways from one face to another agree about that
    std::vector<bool> is_closed;     ///< [patch_count] orientable, and a closed surface by itself
};

/// Time O(faces).
/// @param edge_uses  sorted_edge_uses() of the faces
Orientation find_orientation(std::span<const EdgeUse> edge_uses, std::size_t face_count);

/// Which of the sets that faces are divided into are closed surfaces by themselves: along each edge equally
/// many faces of the set run each way. Time O(faces).
/// @param is_turned  [face_count] faces to be taken as turned; or empty: none
std::vector<bool> find_closed_sets(std::span<const EdgeUse> edge_uses,
                                   std::span<const std::uint32_t> set_of_face, std::size_t set_count,
                                   const std::vector<bool>& is_turned = {});

} // namespace echinus
