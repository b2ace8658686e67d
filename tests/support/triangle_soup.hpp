#pragma once

#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <cstdint>
#include <random>

/// Triangles with many coincidences.
namespace echinus::test {

/// Whole coordinates from -half_width to half_width.
inline Vec3f whole_point(Random& random, int half_width) {
    std::uniform_int_distribution<int> coordinate(-half_width, half_width);
    const int x = coordinate(random), y = coordinate(random);
    return Vec3f(Vec3<int>(x, y, coordinate(random)));
}

/// Whole points, some of them equal, and faces between any three of them, some of which may be the same.
inline TriangleMesh random_soup(Random& random, std::uint32_t vertex_count, std::uint32_t face_count,
                                int half_width) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < vertex_count; ++i) mesh.vertices.push_back(whole_point(random, half_width));
    std::uniform_int_distribution<std::uint32_t> vertex(0, vertex_count - 1);
    for (std::uint32_t i = 0; i < face_count; ++i) {
        const std::uint32_t a = vertex(random), b = vertex(random);
        mesh.faces.push_back({a, b, vertex(random)});
    }
    return mesh;
}

} // namespace echinus::test
