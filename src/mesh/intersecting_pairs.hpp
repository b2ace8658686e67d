#pragma once

#include <echinus/intersections.hpp>

#include <cstddef>
#include <vector>

namespace echinus {

// The public functions, with a limit of the number of pairs.

/// @throws Error InvalidMesh also if there are more than `most` pairs
std::vector<FacePair> intersecting_pairs(const TriangleMesh& a, const TriangleMesh& b, std::size_t most);
std::vector<FacePair> self_intersecting_pairs(const TriangleMesh& mesh, std::size_t most);

} // namespace echinus
