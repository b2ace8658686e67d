// How far apart a vertex and a face or two edges are: a bound that holds, and a plane between them.

#include "simulation/surfaces/separation.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

using Points = std::array<Vec3f, 4>;

constexpr std::array kKinds{PairKind::VertexFace, PairKind::FaceVertex, PairKind::EdgeEdge};

double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const Vec3d ab = b - a;
    const double size = dot(ab, ab);
    const double share = size > 0 ? std::clamp(dot(p - a, ab) / size, 0.0, 1.0) : 0;
    return length(p - (a + ab * share));
}

/// By the borders, and above the inside: no case is left out.
double distance_to_face(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    double best =
        std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
    const Vec3d normal = cross(b - a, c - a);
    const double size = length(normal);
    if (!(size > 0)) return best;
    const auto is_left_of = [&](const Vec3d& from, const Vec3d& to) {
        return dot(cross(to - from, p - from), normal) >= 0;
    };
    if (is_left_of(a, b) && is_left_of(b, c) && is_left_of(c, a))
        best = std::min(best, std::fabs(dot(p - a, normal)) / size);
    return best;
}

/// From the ends, and where the common perpendicular meets both.
double distance_of_edges(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    double best = std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d),
                            distance_to_segment(c, a, b), distance_to_segment(d, a, b)});
    const Vec3d u = b - a, v = d - c, normal = cross(u, v);
    const double size_sq = dot(normal, normal);
    if (!(size_sq > 0)) return best;
    const double s = dot(cross(c - a, v), normal) / size_sq, t = dot(cross(c - a, u), normal) / size_sq;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
        best = std::min(best, std::fabs(dot(c - a, normal)) / std::sqrt(size_sq));
    return best;
}

double distance(PairKind kind, const Points& points) {
    std::array<Vec3d, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = Vec3d(points[k]);
    if (kind == PairKind::VertexFace) return distance_to_face(p[0], p[1], p[2], p[3]);
    if (kind == PairKind::FaceVertex) return distance_to_face(p[3], p[0], p[1], p[2]);
    return distance_of_edges(p[0], p[1], p[2], p[3]);
}

/// Along the normal, in double: how far the vertices of the one lie from those of the other.
double gap_along_normal(PairKind kind, const Points& points, const Vec3f& normal) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t k = 0; k < 4; ++k) {
        const double height = dot(Vec3d(normal), Vec3d(points[k]) - Vec3d(points[0]));
        if (k < own_count(kind))
            least = std::min(least, height);
        else
            most = std::max(most, height);
    }
    return least - most;
}

/// Random positions of all sorts: free ones, on a coarse grid, so that some coincide or lie on a line, nearly
/// parallel or flat ones, and all of these small and far from the origin.
Points random_points(Random& random) {
    Points p;
    for (Vec3f& point : p) point = in_cube(random, 1);
    const auto choice = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
    const int shape = choice(5);
    if (shape == 1)
        for (Vec3f& point : p)
            point = {std::round(2 * point.x), std::round(2 * point.y), std::round(point.z)};
    if (shape == 2) p[3] = p[2] + (p[1] - p[0]) * uniform(random, -2, 2) + in_cube(random, 1e-5F);
    if (shape == 3)
        for (Vec3f& point : p) point.z *= 1e-5F;
    if (shape == 4) p[2] = p[1] + (p[3] - p[1]) * uniform(random, 0, 1) + in_cube(random, 1e-6F);
    const float size = std::pow(10.0F, uniform(random, -4, 2));
    const Vec3f offset = choice(2) == 0 ? Vec3f{} : in_cube(random, 100 * size);
    for (Vec3f& point : p) point = point * size + offset;
    return p;
}

float extent_of(const Points& points) {
    float extent = 0;
    for (const Vec3f& p : points) extent = std::max(extent, length(p - points[0]));
    return extent;
}

} // namespace

TEST(Separation, IsALowerBoundOfTheDistanceAndProvenByItsPlane) {
    Random random(1);
    for (int i = 0; i < 200'000; ++i) {
        const PairKind kind = kKinds[std::size_t(i) % 3];
        const Points points = random_points(random);
        const Separation apart = separation(kind, points);
        if (!(apart.gap > 0)) continue;
        ASSERT_NEAR(length(Vec3d(apart.normal)), 1, 1e-6);
        ASSERT_LE(apart.gap, distance(kind, points) * (1 + 1e-12)) << i;
        ASSERT_LE(apart.gap, gap_along_normal(kind, points, apart.normal) * (1 + 1e-12)) << i;
    }
}

TEST(Separation, FindsNearlyTheWholeDistance) {
    Random random(2);
    for (int i = 0; i < 200'000; ++i) {
        const PairKind kind = kKinds[std::size_t(i) % 3];
        const Points points = random_points(random);
        const double exact = distance(kind, points);
        // A float of the normal is off by so much.
        const double lost = 1e-6 * double{extent_of(points)};
        const Separation apart = separation(kind, points);
        if (exact > 2 * lost) ASSERT_GT(apart.gap, 0.85 * exact - lost) << i;
        if (exact == 0) ASSERT_LE(apart.gap, 0) << i;
    }
}

TEST(Separation, IsAsFarWhateverTheOrderOfTheVertices) {
    Random random(3);
    for (int i = 0; i < 50'000; ++i) {
        const auto [a, b, c, d] = random_points(random);
        const auto expect_like = [&](PairKind kind, const Points& one, PairKind other_kind,
                                     const Points& other) {
            const double exact = distance(kind, one);
            const double lost = 1e-6 * double{extent_of(one)};
            if (!(exact > 4 * lost)) return;
            ASSERT_NEAR(separation(kind, one).gap, separation(other_kind, other).gap, 0.2 * exact + lost)
                << i;
        };
        expect_like(PairKind::VertexFace, {a, b, c, d}, PairKind::FaceVertex, {b, c, d, a});
        expect_like(PairKind::VertexFace, {a, b, c, d}, PairKind::VertexFace, {a, d, b, c});
        expect_like(PairKind::VertexFace, {a, b, c, d}, PairKind::VertexFace, {a, c, b, d});
        expect_like(PairKind::EdgeEdge, {a, b, c, d}, PairKind::EdgeEdge, {c, d, a, b});
        expect_like(PairKind::EdgeEdge, {a, b, c, d}, PairKind::EdgeEdge, {b, a, c, d});
    }
}

TEST(Separation, PointsFromTheOpponentToTheDeformable) {
    const Separation above = separation(PairKind::VertexFace, {{{0.2F, 0.2F, 1}, {}, {1, 0, 0}, {0, 1, 0}}});
    EXPECT_LT(length(above.normal - Vec3f{0, 0, 1}), 1e-6);
    const Separation below = separation(PairKind::FaceVertex, {{{}, {1, 0, 0}, {0, 1, 0}, {0.2F, 0.2F, 1}}});
    EXPECT_LT(length(below.normal - Vec3f{0, 0, -1}), 1e-6);
    EXPECT_NEAR(above.weights[1], 0.6, 1e-6);
    EXPECT_NEAR(below.weights[1], 0.2, 1e-6);
}

TEST(Separation, HasTheSameBitsInVectorLanes) {
    Random random(4);
    for (const std::size_t count : {1, 7, 64, 65, 3000}) {
        PointArrays own, other;
        own.resize(4 * count);
        other.resize(4 * count);
        std::vector<Pair> pairs;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Points points = random_points(random);
            const PairKind kind = kKinds[random() % 3];
            for (std::uint32_t k = 0; k < 4; ++k)
                (k < own_count(kind) ? own : other).set(4 * i + k, points[k]);
            pairs.push_back({{4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3}, kind});
        }
        under_each_instruction_set([&](std::string_view name) {
            std::vector<Separation> found(count);
            separations(pairs, own, other, found);
            for (std::size_t i = 0; i < count; ++i) {
                Points points;
                for (std::size_t k = 0; k < 4; ++k)
                    points[k] = (k < own_count(pairs[i].kind) ? own : other)[pairs[i].points[k]];
                const Separation expected = separation(pairs[i].kind, points);
                static_assert(sizeof(Separation) == 8 * sizeof(float));
                ASSERT_EQ(std::memcmp(&found[i], &expected, sizeof expected), 0) << name << ", pair " << i;
            }
        });
    }
}
