#pragma once

#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

/// Surfaces that are open nearly everywhere, as models from games and shops are.
namespace echinus::test {

/// The faces one by one, each shrunk towards its middle.
inline TriangleMesh exploded(const TriangleMesh& mesh, float size) {
    TriangleMesh soup;
    for (const auto& [a, b, c] : mesh.faces) {
        const Vec3f middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) * (1.0F / 3);
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (const std::uint32_t vertex : {a, b, c})
            soup.vertices.push_back(middle + (mesh.vertices[vertex] - middle) * size);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    return soup;
}

/// Waved sheets of size x size squares, one above the other.
inline TriangleMesh stacked_sheets(std::uint32_t count, std::uint32_t size) {
    TriangleMesh sheets;
    for (std::uint32_t sheet = 0; sheet < count; ++sheet) {
        const auto first = static_cast<std::uint32_t>(sheets.vertices.size());
        const auto share = [&](std::uint32_t i) { return static_cast<float>(i) / static_cast<float>(size); };
        const float height = static_cast<float>(sheet) / static_cast<float>(count) - 0.5F;
        for (std::uint32_t y = 0; y <= size; ++y)
            for (std::uint32_t x = 0; x <= size; ++x)
                sheets.vertices.push_back(
                    {2 * share(x) - 1, 2 * share(y) - 1, height + 0.05F * share(x) * (1 - share(x))});
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x) {
                const std::uint32_t a = first + y * (size + 1) + x, above = a + size + 1;
                sheets.faces.push_back({a, a + 1, above + 1});
                sheets.faces.push_back({a, above + 1, above});
            }
    }
    return sheets;
}

/// Boxes and rings that overlap and are not joined, half of them without some of their faces: like a car.
inline TriangleMesh assembly(int part_count) {
    Random random(2);
    TriangleMesh whole;
    for (int n = 0; n < part_count; ++n) {
        const TriangleMesh part =
            n % 3 == 0 ? make_torus(uniform(random, 0.1F, 0.3F), uniform(random, 0.02F, 0.08F), 8, 4)
                       : make_box({uniform(random, 0.1F, 1), uniform(random, 0.1F, 0.5F),
                                   uniform(random, 0.02F, 0.3F)},
                                  static_cast<std::uint32_t>(n % 2 + 1));
        const Vec3f place{uniform(random, -2, 2), uniform(random, -0.8F, 0.8F), uniform(random, -0.6F, 0.6F)};
        const std::size_t missing = n % 4 == 0 ? part.faces.size() / 6 : n % 4 == 1 ? 2 : 0;
        const auto first = static_cast<std::uint32_t>(whole.vertices.size());
        for (const Vec3f& vertex : part.vertices) whole.vertices.push_back(vertex + place);
        for (std::size_t face = missing; face < part.faces.size(); ++face) {
            const auto& [a, b, c] = part.faces[face];
            whole.faces.push_back({a + first, b + first, c + first});
        }
    }
    return whole;
}

/// Triangles anywhere in a cube, turned in any way.
inline TriangleMesh random_triangles(std::size_t count, float size) {
    Random random(1);
    TriangleMesh soup;
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3f middle = in_cube(random, 1);
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (int k = 0; k < 3; ++k) soup.vertices.push_back(middle + in_cube(random, size));
        soup.faces.push_back({first, first + 1, first + 2});
    }
    return soup;
}

struct NamedSoup {
    std::string name;
    TriangleMesh mesh;
};

inline std::vector<NamedSoup> soups() {
    TriangleMesh bowl = make_sphere(1, 40, 20);
    bowl.faces.resize(bowl.faces.size() - 100);
    return {{"an exploded torus", exploded(make_torus(1, 0.4, 40, 16), 0.97F)},
            {"stacked sheets", stacked_sheets(12, 8)},
            {"an assembly of parts", assembly(60)},
            {"random triangles", random_triangles(1000, 0.15F)},
            {"a bowl", bowl}};
}

} // namespace echinus::test
