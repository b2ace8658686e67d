#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// Sets of faces joined by shared vertices.
struct Components {
    std::size_t count = 0;
    std::vector<std::uint32_t> of_face; ///< [face_count] numbered in the order of their first faces
};

/// @pre indices are in range
Components find_components(const TriangleMesh& mesh);

} // namespace echinus
