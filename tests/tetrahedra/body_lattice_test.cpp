#include "tetrahedra/body_lattice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

using namespace echinus;

namespace {

constexpr double kSize = 0.5;

BodyLattice lattice() {
    return {{-1, 0, 2}, {1, 1.3, 2.6}, kSize};
}

} // namespace

TEST(BodyLattice, NumbersItsPlacesWithoutGaps) {
    const BodyLattice bcc = lattice();
    for (BodyLattice::Vertex vertex = 0; vertex < bcc.vertex_count(); ++vertex) {
        const BodyLattice::Place place = bcc.place_of(vertex);
        ASSERT_TRUE(bcc.contains(place));
        ASSERT_EQ(bcc.vertex_at(place), vertex);
        ASSERT_TRUE(place.x % 2 == place.y % 2 && place.y % 2 == place.z % 2);
    }
    EXPECT_EQ(static_cast<double>(bcc.vertex_count()),
              BodyLattice::vertex_count_around({-1, 0, 2}, {1, 1.3, 2.6}, kSize));
}

TEST(BodyLattice, HasItsHullOutsideOfTheBox) {
    const BodyLattice bcc = lattice();
    const auto is_in_box = [](const Vec3d& p, double margin) {
        return p.x > -1 - margin && p.x < 1 + margin && p.y > -margin && p.y < 1.3 + margin &&
               p.z > 2 - margin && p.z < 2.6 + margin;
    };
    for (BodyLattice::Vertex vertex = 0; vertex < bcc.vertex_count(); ++vertex) {
        const BodyLattice::Place place = bcc.place_of(vertex);
        bool is_hull = false; // some neighbour is missing
        for (const BodyLattice::Place& edge : kEdges)
            is_hull = is_hull || !bcc.contains(place + edge) || !bcc.contains(place - edge);
        if (is_hull) ASSERT_FALSE(is_in_box(bcc.position(vertex), kSize / 2 - 1e-9));
    }
}

TEST(BodyLattice, FillsSpaceWithEqualPositiveTetrahedra) {
    const BodyLattice bcc = lattice();
    double volume = 0;
    std::set<std::array<BodyLattice::Vertex, 4>> seen;
    // Around one corner of cubes far from the hull: its share is one cube.
    const BodyLattice::Place corner = bcc.place_of(bcc.vertex_at({6, 4, 4}));
    for_each_tetrahedron_at(corner, [&](const std::array<BodyLattice::Place, 4>& places) {
        const Vec3d a = bcc.position(places[0]);
        const auto way_to = [&](std::size_t i) { return bcc.position(places[i]) - a; };
        const double one = dot(cross(way_to(1), way_to(2)), way_to(3)) / 6;
        EXPECT_NEAR(one, kSize * kSize * kSize / 12, 1e-12);
        EXPECT_NEAR(length(way_to(1)), kSize, 1e-12);
        EXPECT_NEAR(length(bcc.position(places[3]) - bcc.position(places[2])), kSize, 1e-12);
        volume += one;
        std::array<BodyLattice::Vertex, 4> numbers{};
        for (std::size_t i = 0; i < 4; ++i) numbers[i] = bcc.vertex_at(places[i]);
        std::sort(numbers.begin(), numbers.end());
        EXPECT_TRUE(seen.insert(numbers).second);
    });
    EXPECT_EQ(seen.size(), 12U);
    EXPECT_NEAR(volume, kSize * kSize * kSize, 1e-12);
}
