#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus::rivals {

/// A mesh with fewer faces. Each is one of the original's, at corners that may have moved to other vertices.
struct SimplifiedMesh {
    TriangleMesh mesh;                       ///< the vertices are all of the original's
    std::vector<std::uint32_t> face_numbers; ///< [face_count] in the original, ascending
};

/// Collapses edges, each time the one that moves the surface least by the quadric error of Garland and
/// Heckbert
/// ("Surface simplification using quadric error metrics", SIGGRAPH 1997), one end onto the other, until at
/// most so many faces are left or no edge can go without turning a face over or changing the topology. Faces
/// without an area are left out first. Time O(n log n). The same mesh gives the same result.
/// @pre indices are in range, positions finite
SimplifiedMesh simplify(const TriangleMesh& mesh, std::size_t face_limit);

} // namespace echinus::rivals
