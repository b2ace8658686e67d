#pragma once

#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

/// Meshes made from other meshes.
namespace echinus::test {

inline TriangleMesh translated(TriangleMesh mesh, const Vec3f& offset) {
    for (Vec3f& vertex : mesh.vertices) vertex += offset;
    return mesh;
}

inline TriangleMesh joined(std::initializer_list<TriangleMesh> parts) {
    TriangleMesh whole;
    for (const TriangleMesh& part : parts) {
        const auto offset = static_cast<std::uint32_t>(whole.vertices.size());
        whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const auto& [a, b, c] : part.faces) whole.faces.push_back({a + offset, b + offset, c + offset});
    }
    return whole;
}

inline TriangleMesh turned_inside_out(TriangleMesh mesh) {
    for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

/// A cube whose top exists twice: faces 0 to 11 are the cube's, 12 and 13 fill the top again along the other
/// diagonal.
inline TriangleMesh cube_with_doubled_top() {
    return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
            {{0, 2, 1},
             {0, 3, 2}, // bottom
             {0, 1, 5},
             {0, 5, 4}, // front
             {1, 2, 6},
             {1, 6, 5}, // right
             {2, 3, 7},
             {2, 7, 6}, // back
             {3, 0, 4},
             {3, 4, 7}, // left
             {4, 5, 6},
             {4, 6, 7}, // top
             {5, 6, 7},
             {5, 7, 4}}}; // top again
}

} // namespace echinus::test

/// Shapes with faces in planes through their centre, such as machine parts have.
namespace echinus::test {

struct OutlinePoint {
    float x, y;
};

/// A prism of height 2 around z = 0.
/// @param outline  counter-clockwise, and seen whole from its first point
inline TriangleMesh make_prism(const std::vector<OutlinePoint>& outline) {
    const auto count = static_cast<std::uint32_t>(outline.size());
    TriangleMesh prism;
    for (float z : {-1.0F, 1.0F})
        for (const auto& [x, y] : outline) prism.vertices.push_back({x, y, z});
    for (std::uint32_t a = 0; a < count; ++a) {
        const std::uint32_t b = (a + 1) % count;
        prism.faces.push_back({a, b, b + count});
        prism.faces.push_back({a, b + count, a + count});
    }
    for (std::uint32_t a = 1; a + 1 < count; ++a) {
        prism.faces.push_back({0, a + 1, a});
        prism.faces.push_back({count, count + a, count + a + 1});
    }
    return prism;
}

/// A cube of side 2, cut by a plane through its centre into parts that touch.
inline TriangleMesh make_two_wedges() {
    return joined({make_prism({{-1, -1}, {1, -1}, {1, 1}}), make_prism({{-1, -1}, {1, 1}, {-1, 1}})});
}

/// The same by two planes.
inline TriangleMesh make_four_wedges() {
    return joined({make_prism({{0, 0}, {-1, -1}, {1, -1}}), make_prism({{0, 0}, {1, -1}, {1, 1}}),
                   make_prism({{0, 0}, {1, 1}, {-1, 1}}), make_prism({{0, 0}, {-1, 1}, {-1, -1}})});
}

/// A plate from which an eighth is cut, one part.
inline TriangleMesh make_open_mouth() {
    return make_prism({{0, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}});
}

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

/// A Klein bottle, a surface that cannot exist without intersecting itself.
inline TriangleMesh klein_bottle() {
    constexpr std::uint32_t kAround = 36, kAcross = 16;
    TriangleMesh bottle;
    for (std::uint32_t i = 0; i < kAround; ++i)
        for (std::uint32_t j = 0; j < kAcross; ++j) {
            const double u = 2 * std::numbers::pi * i / kAround,
                         v = 2 * std::numbers::pi * (j + 0.5) / kAcross;
            const double out = 3 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
            bottle.vertices.emplace_back(
                Vec3d{out * std::cos(u), out * std::sin(u),
                      std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v)});
        }
    const auto at = [](std::uint32_t i, std::uint32_t j) {
        j %= kAcross;
        return i < kAround ? i * kAcross + j : kAcross - 1 - j; // the end is joined to the start turned over
    };
    for (std::uint32_t i = 0; i < kAround; ++i)
        for (std::uint32_t j = 0; j < kAcross; ++j) {
            bottle.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            bottle.faces.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return bottle;
}

} // namespace echinus::test
