#pragma once

#include <echinus/intersections.hpp>

#include <vector>

/// Which faces intersect, by CGAL's exact predicates; shares no code with Echinus. Its definitions are those
/// of <echinus/intersections.hpp>.
namespace echinus::test {

bool triangles_intersect_by_cgal(const std::array<Vec3f, 3>& a, const std::array<Vec3f, 3>& b);

/// @pre indices are in range, vertices finite; as below
std::vector<FacePair> intersecting_pairs_by_cgal(const TriangleMesh& a, const TriangleMesh& b);

std::vector<FacePair> self_intersecting_pairs_by_cgal(const TriangleMesh& mesh);

} // namespace echinus::test
