#pragma once

#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

/// Meshes that become cloth.
namespace echinus::test {

/// A level sheet of squares with the edge length 1 / (columns - 1), around the origin, each cut along its
/// diagonal; its fronts turn up. Vertex (row, column) has the index row * columns + column.
inline TriangleMesh sheet_mesh(std::uint32_t columns, std::uint32_t rows) {
    TriangleMesh mesh;
    const float step = 1.0F / static_cast<float>(columns - 1);
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column)
            mesh.vertices.emplace_back(static_cast<float>(column) * step - 0.5F,
                                       static_cast<float>(row) * step - 0.5F, 0.0F);
    for (std::uint32_t row = 0; row + 1 < rows; ++row)
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
            const std::uint32_t corner = row * columns + column, above = corner + columns;
            mesh.faces.push_back({corner, corner + 1, above + 1});
            mesh.faces.push_back({corner, above + 1, above});
        }
    return mesh;
}

/// A strip of quadrilaterals, two rows of vertices, that runs around the z axis and meets itself again after
/// as many half turns about its own middle; an odd number makes it one-sided. Radius 1, width 0.4.
inline TriangleMesh band_mesh(std::uint32_t segments, int half_turns) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < segments; ++i) {
        const double way = 2 * std::numbers::pi * i / segments, tilt = half_turns * way / 2;
        for (const double side : {-0.2, 0.2}) {
            const double radius = 1 + side * std::sin(tilt);
            mesh.vertices.emplace_back(static_cast<float>(radius * std::cos(way)),
                                       static_cast<float>(radius * std::sin(way)),
                                       static_cast<float>(side * std::cos(tilt)));
        }
    }
    for (std::uint32_t i = 0; i < segments; ++i) {
        const bool last = i + 1 == segments, crossed = last && half_turns % 2 != 0;
        const std::uint32_t next = last ? 0 : 2 * i + 2;
        const std::uint32_t low = next + (crossed ? 1 : 0), high = next + (crossed ? 0 : 1);
        mesh.faces.push_back({2 * i, low, high});
        mesh.faces.push_back({2 * i, high, 2 * i + 1});
    }
    return mesh;
}

/// Moves each vertex by up to `size` along each axis.
inline TriangleMesh rumpled(TriangleMesh mesh, float size) {
    Random random(static_cast<std::uint32_t>(mesh.vertices.size()));
    for (Vec3f& vertex : mesh.vertices) vertex += in_cube(random, size);
    return mesh;
}

} // namespace echinus::test
