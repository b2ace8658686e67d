#pragma once

#include <echinus/mesh.hpp>

#include <vector>

namespace echinus::test {

/// Integers: in the coordinates of a country (UTM), and farther.
inline std::vector<Vec3d> places_far_away() {
    return {{448262, 5411932, 112}, {1e7, -2e7, 3e6}, {-1e9, 7, 1e9}, {1e12, -4, 7e11}};
}

inline std::vector<TriangleMesh> shapes_far_away() {
    return {make_torus(1, 0.4, 24, 12), make_sphere(0.7, 12, 7), make_box({1, 0.9, 0.8}, 2)};
}

/// Where a mesh of floats is after a move in double.
inline std::vector<Vec3d> positions_at(const TriangleMesh& mesh, const Vec3d& offset) {
    std::vector<Vec3d> positions;
    for (const Vec3f& vertex : mesh.vertices) positions.push_back(Vec3d(vertex) + offset);
    return positions;
}

} // namespace echinus::test
