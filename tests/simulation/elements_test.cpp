// The faces, edges and vertices of surfaces: who owns what, what is near what, and lists of pairs.

#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/near_elements.hpp"
#include "support/cloth_meshes.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

const Workers kOneThread;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::size_t edge_count_of(const Element& element) {
    return element.vertex_count == 3 ? 3 : element.vertex_count - 1u;
}

/// Every vertex and every edge belongs to one element, and each element knows its edges.
void expect_each_owned_once(const Elements& elements) {
    std::vector<int> vertex_owners(elements.vertex_count()), edge_owners(elements.edges.size());
    for (const Element& element : elements.all) {
        for (std::size_t k = 0; k < element.vertex_count; ++k)
            vertex_owners[element.vertices[k]] += element.owns_vertex(k) ? 1 : 0;
        for (std::size_t k = 0; k < edge_count_of(element); ++k) {
            edge_owners[element.edges[k]] += element.owns_edge(k) ? 1 : 0;
            Edge edge{element.vertices[k], element.vertices[(k + 1) % 3]};
            std::sort(edge.begin(), edge.end());
            EXPECT_EQ(elements.edges[element.edges[k]], edge);
        }
    }
    for (const int owners : vertex_owners) EXPECT_EQ(owners, 1);
    for (const int owners : edge_owners) EXPECT_EQ(owners, 1);
    EXPECT_EQ(std::set(elements.edges.begin(), elements.edges.end()).size(), elements.edges.size());
}

/// Faces, threads and single points, spread over a cube.
struct Scattered {
    std::vector<Element> elements;
    PointArrays positions;

    Scattered(std::size_t count, std::uint32_t seed) {
        Random random(seed);
        std::vector<Vec3f> points;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec3f middle = in_cube(random, 1);
            for (int k = 0; k < 3; ++k) points.push_back(middle + in_cube(random, 0.1F));
            const std::uint32_t v = 3 * i;
            const std::array shapes{Element{{v, v + 1, v + 2}},
                                    Element{.vertices = {v, v + 1, v + 1}, .vertex_count = 2},
                                    Element{.vertices = {v, v, v}, .vertex_count = 1}};
            elements.push_back(shapes[i % 3]);
        }
        positions.load(points);
    }
    void move(float most) {
        Random random(9);
        for (std::size_t i = 0; i < 3 * elements.size(); ++i)
            positions.set(i, positions[i] + in_cube(random, most));
    }
};

} // namespace

TEST(Elements, OwnEachVertexAndEdgeOnce) {
    const TriangleMesh sheet = sheet_mesh(9, 7), sphere = make_sphere(1, 12, 6), band = band_mesh(9, 1);
    for (const TriangleMesh& mesh : {sheet, sphere, band})
        expect_each_owned_once({mesh.vertices.size(), mesh.faces, {}});
}

TEST(Elements, OwnEachVertexAndEdgeOnceWhereManyFacesShareAnEdgeAndWithThreads) {
    const std::vector<Triangle> fan{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 5}};
    // A thread from the fan, one beside it, one that is an edge of the fan, one given twice; vertex 9 is
    // alone.
    const std::vector<Edge> threads{{5, 6}, {7, 8}, {1, 0}, {2, 1}, {6, 5}};
    const Elements elements(10, fan, threads);
    expect_each_owned_once(elements);
    EXPECT_EQ(elements.edges.size(), 1 + 2 * 4 + 2u);
    EXPECT_TRUE(std::any_of(elements.all.begin(), elements.all.end(), [](const Element& element) {
        return element.vertex_count == 1 && element.vertices[0] == 9;
    }));
    EXPECT_EQ(elements.at(0).size(), 4u);
}

TEST(Elements, AreListedAroundTheirVertices) {
    const TriangleMesh sphere = make_sphere(1, 12, 6);
    const Elements elements(sphere.vertices.size(), sphere.faces, {});
    std::size_t count = 0;
    for (std::size_t v = 0; v < elements.vertex_count(); ++v)
        for (const std::uint32_t e : elements.at(v)) {
            EXPECT_TRUE(elements.all[e].has(std::uint32_t(v)));
            ++count;
        }
    EXPECT_EQ(count, 3 * sphere.faces.size());
}

namespace {

/// Elements on their way: by boxes, one after the other.
struct Moving {
    explicit Moving(std::size_t count, std::uint32_t seed) : at_start(count, seed), at_end(at_start) {
        at_end.move(0.3F);
        tree = MovingTree(at_start.elements, at_start.positions);
        tree.want([](std::uint32_t) { return true; }, kOneThread);
        tree.refit(at_start.elements, at_start.positions, at_end.positions, kOneThread);
    }

    bool may_come_near(std::uint32_t i, const Moving& other, std::uint32_t j, float reach) const {
        const auto grown = [&](const Scattered& scattered) {
            Box box = box_of(scattered.elements[i], scattered.positions);
            box.grow(reach);
            return box;
        };
        const Box from = grown(at_start), to = grown(at_end);
        const Box other_from = box_of(other.at_start.elements[j], other.at_start.positions);
        const Box other_to = box_of(other.at_end.elements[j], other.at_end.positions);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool stays_above =
                other_from.low[axis] > from.high[axis] && other_to.low[axis] > to.high[axis];
            const bool stays_below =
                other_from.high[axis] < from.low[axis] && other_to.high[axis] < to.low[axis];
            if (stays_above || stays_below) return false;
        }
        return true;
    }

    Scattered at_start, at_end;
    MovingTree tree;
};

using Found = std::vector<std::array<std::uint32_t, 2>>;

void find_all_near(const MovingTree& a, const MovingTree& b, float reach, Found& found) {
    for (std::size_t piece = 0; piece < a.piece_count(); ++piece) find_near(a, b, reach, piece, found);
}

Found sorted(Found found) {
    std::sort(found.begin(), found.end());
    return found;
}

} // namespace

TEST(NearElements, AreThoseThatMayComeNearOnTheirWaysUnderEveryInstructionSet) {
    for (const std::size_t count : {1, 8, 20, 300}) {
        Moving a(count, 5);
        const Moving b(2 * count, 6);
        for (const auto& [every, reach] : {std::pair{1U, 0.07F}, {3U, 0.07F}, {2U, kInfinity}}) {
            const auto is_wanted = [every = every](std::uint32_t i) { return i % every == 0; };
            a.tree.want(is_wanted, kOneThread);
            Found expected, expected_own;
            for (std::uint32_t i = 0; i < count; ++i) {
                for (std::uint32_t j = 0; is_wanted(i) && j < 2 * count; ++j)
                    if (a.may_come_near(i, b, j, reach)) expected.push_back({i, j});
                for (std::uint32_t j = i + 1; j < count; ++j)
                    if ((is_wanted(i) || is_wanted(j)) &&
                        (a.may_come_near(i, a, j, reach) || a.may_come_near(j, a, i, reach)))
                        expected_own.push_back({i, j});
            }
            Found first;
            under_each_instruction_set([&](std::string_view) {
                Found found, found_own;
                find_all_near(a.tree, b.tree, reach, found);
                find_all_near(a.tree, a.tree, reach, found_own);
                if (first.empty()) first = found;
                EXPECT_EQ(found, first) << "in another order";
                EXPECT_EQ(sorted(found), expected);
                for (auto& pair : found_own) std::sort(pair.begin(), pair.end());
                EXPECT_EQ(sorted(found_own), expected_own);
            });
        }
    }
}

TEST(NearElements, AreNotThoseThatMoveAlike) {
    Moving far(1, 7), beside(1, 7);
    // Both fly far along the same way, one past where the other begins, but never nearer than at first.
    const auto fly = [](Moving& moving, const Vec3f& offset) {
        for (std::size_t v = 0; v < 3 * moving.at_start.elements.size(); ++v) {
            moving.at_start.positions.set(v, moving.at_start.positions[v] + offset);
            moving.at_end.positions.set(v, moving.at_start.positions[v] + Vec3f{100, 100, 100});
        }
        moving.tree.refit(moving.at_start.elements, moving.at_start.positions, moving.at_end.positions,
                          kOneThread);
    };
    fly(far, {});
    fly(beside, {20, 20, 20});
    Found found;
    find_all_near(far.tree, beside.tree, 1, found);
    EXPECT_TRUE(found.empty());
}
