#pragma once

#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Meshes of many long faces that lie close together, so that each is seen through most cells of a map and
/// each cell sees most of them: what they share grows with the square of their number.
namespace echinus::test {

/// Parallel plates of half a spacing's thickness, 12 faces each, that together fill a unit cube.
inline TriangleMesh make_fins(std::uint32_t count) {
    const TriangleMesh fin = make_box({0.5 / count, 1, 1});
    TriangleMesh whole;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto offset = static_cast<std::uint32_t>(whole.vertices.size());
        const float x = (static_cast<float>(i) + 0.5F) / static_cast<float>(count) - 0.5F;
        for (const Vec3f& v : fin.vertices) whole.vertices.push_back(v + Vec3f{x, 0, 0});
        for (const auto& [a, b, c] : fin.faces) whole.faces.push_back({a + offset, b + offset, c + offset});
    }
    return whole;
}

/// A saw of unit length with pointed teeth, half as long as the saw, 8 faces each. The strip below the teeth
/// is a fan of slivers around one of its corners.
inline TriangleMesh make_comb(std::uint32_t teeth) {
    constexpr float kTooth = 0.5F, kStrip = 0.1F, kThickness = 0.1F;
    std::vector<Vec3f> outline;
    for (std::uint32_t i = 0; i <= 2 * teeth; ++i)
        outline.push_back(
            {static_cast<float>(i) / static_cast<float>(2 * teeth), i % 2 == 0 ? 0 : kTooth, 0});
    outline.push_back({1, -kStrip, 0});
    outline.push_back({0, -kStrip, 0});
    const auto count = static_cast<std::uint32_t>(outline.size());

    TriangleMesh comb{outline, {}};
    for (const Vec3f& v : outline) comb.vertices.push_back(v + Vec3f{0, 0, kThickness});
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        comb.faces.push_back({i, i + count, next});
        comb.faces.push_back({next, i + count, next + count});
    }
    const auto add_to_both_sides = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        comb.faces.push_back({a, b, c});
        comb.faces.push_back({a + count, c + count, b + count});
    };
    for (std::uint32_t i = 0; i < teeth; ++i) {
        add_to_both_sides(2 * i, 2 * i + 1, 2 * i + 2);
        add_to_both_sides(count - 1, 2 * i, 2 * i + 2);
    }
    add_to_both_sides(count - 1, 2 * teeth, 2 * teeth + 1);
    return comb;
}

inline const TriangleMesh kTriangle{{{}, {}, {}}, {{0, 1, 2}}};
inline const TriangleMesh kTetrahedron{{{}, {}, {}, {}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

/// Parts with random corners, as large as the whole: each face passes through a good share of all cells.
/// @param part  of which the faces count
inline TriangleMesh make_tangle(std::size_t part_count, const TriangleMesh& part) {
    Random random(3);
    TriangleMesh whole;
    for (std::size_t i = 0; i < part_count; ++i) {
        const auto offset = static_cast<std::uint32_t>(whole.vertices.size());
        for (std::size_t k = 0; k < part.vertices.size(); ++k) whole.vertices.push_back(in_sphere(random, 1));
        for (const auto& [a, b, c] : part.faces) whole.faces.push_back({a + offset, b + offset, c + offset});
    }
    return whole;
}

/// With as many cells as usual, a map of any of these takes more bytes than a default map may. All but the
/// triangles are closed.
inline std::vector<std::pair<std::string, TriangleMesh>> crowded_meshes() {
    return {{"fins", make_fins(260)},
            {"comb", make_comb(700)},
            {"tetrahedra", make_tangle(300, kTetrahedron)},
            {"triangles", make_tangle(60, kTriangle)}};
}

} // namespace echinus::test
