// Which vertices, edges and faces are looked at, of surfaces that move: all that come near.

#include "simulation/contact/pair_set.hpp"
#include "simulation/surfaces/near_pairs.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>
#include <vector>

using namespace echinus;
using namespace echinus::test;

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
