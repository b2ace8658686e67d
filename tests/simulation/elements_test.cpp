// The faces, edges and vertices of surfaces: who owns what, what is near what, and lists of pairs.

#include "simulation/contact/pair_set.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/near_elements.hpp"
#include "simulation/surfaces/near_pairs.hpp"
#include "support/instruction_sets.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <tuple>
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

namespace {

constexpr std::uint32_t kGridSide = 7;
constexpr std::size_t kGridCount = kGridSide * kGridSide;
constexpr float kGridReach = 0.08F;

std::shared_ptr<const Elements> grid() {
    std::vector<Triangle> faces;
    for (std::uint32_t row = 0; row + 1 < kGridSide; ++row)
        for (std::uint32_t column = 0; column + 1 < kGridSide; ++column) {
            const std::uint32_t a = row * kGridSide + column, b = a + 1, c = a + kGridSide, d = c + 1;
            faces.push_back({a, b, d});
            faces.push_back({a, d, c});
        }
    return std::make_shared<const Elements>(kGridCount, faces, std::vector<Edge>{});
}

/// Vertices of a grid one unit wide at a height, each somewhere near its place.
PointArrays places_at(float height, float spread, Random& random) {
    const auto off = [&] { return uniform(random, -spread, spread); };
    PointArrays places;
    places.resize(kGridCount);
    for (std::uint32_t i = 0; i < kGridCount; ++i)
        places.set(i, {static_cast<float>(i % kGridSide) / (kGridSide - 1) + off(),
                       static_cast<float>(i / kGridSide) / (kGridSide - 1) + off(), height + off()});
    return places;
}

auto order_of(const Pair& pair) {
    return std::tuple(pair.kind, pair.points);
}

std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& a, const Pair& b) { return order_of(a) < order_of(b); });
    return pairs;
}

bool are_same(const std::vector<Pair>& a, const std::vector<Pair>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Pair& x, const Pair& y) { return order_of(x) == order_of(y); });
}

/// Of all pairs of elements.
std::vector<Pair> pairs_of(const MovingElements& own, const MovingElements& other) {
    std::vector<std::array<std::uint32_t, 2>> elements;
    const bool is_of_itself = &own.elements == &other.elements;
    for (std::uint32_t a = 0; a < own.elements.all.size(); ++a)
        for (std::uint32_t b = is_of_itself ? a + 1 : 0; b < other.elements.all.size(); ++b)
            elements.push_back({a, b});
    std::vector<Pair> pairs;
    find_near_pairs(elements, own, other, kGridReach, pairs);
    return pairs;
}

/// How near the parts of a pair come on their displacements, at times that are looked at.
double nearest_on_the_way(const Pair& pair, const MovingElements& own, const MovingElements& other) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int time = 0; time <= 16; ++time) {
        std::array<Vec3d, 4> points;
        for (std::size_t k = 0; k < 4; ++k) {
            const MovingElements& of = k < own_count(pair.kind) ? own : other;
            const Vec3d from(of.from[pair.points[k]]), to(of.to[pair.points[k]]);
            points[k] = from + (to - from) * (time / 16.0);
        }
        const auto shares = nearest_points(pair.kind, points);
        Vec3d across;
        for (std::size_t k = 0; k < 4; ++k)
            across += points[k] * (k < own_count(pair.kind) ? shares[k] : -shares[k]);
        nearest = std::min(nearest, length(across));
    }
    return nearest;
}

/// The pairs of a set that are nearer than the reach where the surface is now.
std::vector<Pair> near_pairs(PairSet& set, const PointArrays& listed, const PointArrays& now,
                             const PointArrays& obstacle) {
    std::vector<float> strayed(kGridCount), ahead(kGridCount);
    for (std::size_t i = 0; i < kGridCount; ++i) strayed[i] = length(now[i] - listed[i]);
    set.measure({listed, now, now, now, strayed, ahead}, obstacle, kGridReach / 2, true, Workers(1));
    std::vector<Pair> result;
    for (std::size_t p = 0; p < set.pairs().size(); ++p)
        if (set.separations()[p].gap < kGridReach / 2) result.push_back(set.pairs()[p]);
    return sorted(std::move(result));
}

} // namespace

TEST(NearPairs, AreAllThatComeNearOnTheirDisplacements) {
    const auto own = grid(), other = grid();
    Random random(5);
    for (int trial = 0; trial < 4; ++trial) {
        const PointArrays from = places_at(0.2F, 0.05F, random), to = places_at(-0.1F, 0.05F, random),
                          at = places_at(0, 0.05F, random);
        const MovingElements moving{*own, from, to}, standing{*other, at, at};
        const std::vector<Pair> found = sorted(pairs_of(moving, standing));
        std::size_t near_count = 0;
        for (std::uint32_t v = 0; v < kGridCount; ++v)
            for (const Element& face : other->all) {
                const Pair pair{{v, face.vertices[0], face.vertices[1], face.vertices[2]},
                                PairKind::VertexFace};
                if (!(nearest_on_the_way(pair, moving, standing) < kGridReach * 0.999)) continue;
                ++near_count;
                EXPECT_TRUE(
                    std::binary_search(found.begin(), found.end(), pair, [](const Pair& a, const Pair& b) {
                        return order_of(a) < order_of(b);
                    }));
            }
        EXPECT_GT(near_count, kGridCount);
        EXPECT_LT(found.size(), own->all.size() * other->all.size());
    }
}

TEST(NearPairs, AreTheSameUnderEveryInstructionSet) {
    const auto own = grid(), other = grid();
    Random random(6);
    const PointArrays from = places_at(0.2F, 0.1F, random), to = places_at(-0.1F, 0.1F, random),
                      at = places_at(0, 0.1F, random);
    for (const MovingElements& opponent : {MovingElements{*other, at, at}, MovingElements{*own, from, to}}) {
        std::vector<std::vector<Pair>> found;
        under_each_instruction_set([&](std::string_view) {
            found.push_back(pairs_of({*own, from, to}, opponent));
        });
        EXPECT_GT(found.front().size(), 100u);
        for (const std::vector<Pair>& pairs : found) EXPECT_TRUE(are_same(pairs, found.front()));
    }
}

TEST(NearPairs, OfVerticesWhoseDisplacementsChangeAreThoseOfAListThatIsMadeAnew) {
    const auto own = grid(), other = grid();
    Random random(7);
    for (const bool starts_there : {true, false}) {
        const PointArrays from = places_at(0.3F, 0.05F, random), to = places_at(0.5F, 0.05F, random),
                          at = places_at(0, 0.05F, random);
        PairSet set(own, from, other, at);
        set.set_reach(kGridReach);
        set.list({from, to, at, at}, std::vector<std::uint8_t>(kGridCount, 1), false, Workers(1));
        // Some come near. The others go where they were going, or stay where they have got.
        const PointArrays elsewhere = places_at(0.02F, 0.05F, random);
        PointArrays start = starts_there ? from : to, end = to;
        std::vector<std::uint8_t> is_other(kGridCount);
        for (std::size_t i = 0; i < kGridCount; i += 5) {
            is_other[i] = 1;
            end.set(i, elsewhere[i]);
        }
        set.list({start, end, at, at}, is_other, starts_there, Workers(1));
        PairSet anew(own, from, other, at);
        anew.set_reach(kGridReach);
        anew.list({start, end, at, at}, std::vector<std::uint8_t>(kGridCount, 1), false, Workers(1));
        const std::vector<Pair> near = near_pairs(anew, start, end, at);
        EXPECT_GT(near.size(), 20u);
        EXPECT_TRUE(are_same(near_pairs(set, start, end, at), near)) << starts_there;
    }
}
