#include "exact_map/query/ray_crossing.hpp"
#include "support/random_points.hpp"

#include <echinus/collider.hpp>
#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <variant>
#include <vector>

using namespace echinus;

namespace {

/// The first crossing of the segment with a face, by intersecting all planes in double, up to rounding.
double first_parameter(const TriangleMesh& mesh, const Vec3d& from, const Vec3d& to) {
    double first = 2;
    for (const Triangle& face : mesh.faces) {
        const Vec3d a(mesh.vertices[face[0]]), b(mesh.vertices[face[1]]), c(mesh.vertices[face[2]]);
        const Vec3d normal = cross(b - a, c - a);
        const double start = dot(normal, from - a), end = dot(normal, to - a);
        if ((start > 0) == (end > 0)) continue;
        const double t = start / (start - end);
        const Vec3d p = from + (to - from) * t;
        const auto left_of = [&](const Vec3d& v, const Vec3d& w) {
            return dot(cross(w - v, p - v), normal) >= 0;
        };
        if (left_of(a, b) && left_of(b, c) && left_of(c, a)) first = std::min(first, t);
    }
    return first;
}

Vec3f between(const Vec3f& from, const Vec3f& to, float t) {
    return from + (to - from) * t;
}

} // namespace

TEST(ExactMapSweep, FindsTheFirstCrossingThatAnyFaceHas) {
    test::Random random(5);
    for (const TriangleMesh& mesh : {make_torus(1, 0.4, 30, 12), make_box({2, 1, 0.25}, 3)}) {
        const ExactMap map = ExactMap::build(mesh);
        for (int n = 0; n < 5000; ++n) {
            const Vec3f from = test::in_sphere(random, 1.5F * map.view().radius);
            const Vec3f step = test::in_sphere(random, n % 2 == 0 ? 0.1F : 3.0F);
            const Vec3f to = from + step;
            const double expected = first_parameter(mesh, Vec3d(from), Vec3d(to));
            const SweepHit hit = sweep(map, from, to);
            const double tolerance = 1e-4 * map.view().radius / length(Vec3d(step));
            if (hit.found() != (expected <= 1)) {
                // The two endpoints decide, to the lattice's resolution.
                const double end =
                    std::min(unsigned_distance(mesh, Vec3d(from)), unsigned_distance(mesh, Vec3d(to)));
                ASSERT_LT(end, 1e-5 * map.view().radius);
            } else if (hit.found() && std::fabs(hit.fraction - expected) > tolerance) {
                // A grazed edge may be missed narrowly.
                ASSERT_LT(unsigned_distance(mesh, Vec3d(from) +
                                                      Vec3d(step) * std::min<double>(hit.fraction, expected)),
                          1e-5 * map.view().radius);
            }
        }
    }
}

TEST(ExactMapSweep, AgreesWithContainsOnVerticesEdgesAndFaces) {
    // Grid corners lie on the box's vertices, edges and faces, and on the lines between them.
    const TriangleMesh mesh = make_box({2, 2, 2}, 2);
    const ExactMap map = ExactMap::build(mesh);
    test::Random random(6);
    std::uniform_int_distribution<int> coordinate(-6, 6);
    const auto grid_point = [&] {
        return Vec3f{0.25F * static_cast<float>(coordinate(random)),
                     0.25F * static_cast<float>(coordinate(random)),
                     0.25F * static_cast<float>(coordinate(random))};
    };
    for (int n = 0; n < 50'000; ++n) {
        const Vec3f from = grid_point(), to = grid_point();
        const SweepHit hit = sweep(map, from, to);
        const bool starts_inside = contains(map, from);
        if (starts_inside != contains(map, to)) ASSERT_TRUE(hit.found());
        if (!hit.found()) continue;
        ASSERT_EQ(hit.entering, !starts_inside);
        ASSERT_NEAR(unsigned_distance(mesh, Vec3d(hit.point)), 0, 1e-5);
        for (float share : {0.1F, 0.5F, 0.9F}) {
            const Vec3f before = between(from, to, hit.fraction * share);
            if (unsigned_distance(mesh, Vec3d(before)) > 1e-5)
                ASSERT_EQ(contains(map, before), starts_inside);
        }
    }
}

TEST(ExactMapSweep, CutsWaysThatBeginAndEndFarAway) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    const SweepHit hit = sweep(map, {-1e6F, 0.1F, 0.2F}, {1e6F, 0.1F, 0.2F});
    ASSERT_TRUE(hit.found());
    EXPECT_TRUE(hit.entering);
    EXPECT_NEAR(hit.point.x, -1, 0.1); // float has no finer step there
    EXPECT_NEAR(hit.fraction, 0.5F, 1e-6F);
    EXPECT_EQ(hit.normal, (Vec3f{-1, 0, 0}));
    EXPECT_FALSE(sweep(map, {-1e6F, 5, 0}, {1e6F, 5, 0}).found());
}

TEST(ExactMapSweep, MeetsTheSamePlaceFromAnyDistance) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    test::Random random(8);
    for (int n = 0; n < 500; ++n) {
        // Ways through the centre: multiples of a power of two are exact.
        const Vec3f direction = test::unit_vector(random);
        const SweepHit near = sweep(map, direction * 4, direction * -4);
        ASSERT_TRUE(near.found());
        for (int exponent = 10; exponent < 127; exponent += 13) {
            const float far = std::ldexp(1.0F, exponent);
            const SweepHit hit = sweep(map, direction * far, direction * (far / -2));
            ASSERT_TRUE(hit.found()) << exponent;
            ASSERT_TRUE(hit.entering);
            ASSERT_LT(length(hit.point - near.point), 1e-5) << exponent;
            ASSERT_NEAR(hit.fraction, 2.0F / 3, 2 / far + 1e-6F);
        }
    }
}

TEST(ExactMapSweep, TellsFromAnyDistanceWhatPassesBesideTheSurface) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    constexpr float kBeside = 1e-5F; // three lattice steps
    for (int exponent = 3; exponent < 38; ++exponent) {
        const float far = std::pow(10.0F, static_cast<float>(exponent));
        for (const float x : {far, -far})
            for (const float y : {far, -far}) {
                const float below = 1 - kBeside, above = 1 + kBeside;
                const SweepHit hit = sweep(map, {x, y, below}, {-x / 4, -y / 4, below});
                ASSERT_TRUE(hit.found()) << far;
                ASSERT_NEAR(hit.point.x, std::copysign(1, x), 1e-5);
                ASSERT_NEAR(hit.point.y, std::copysign(1, y), 1e-5);
                ASSERT_NEAR(hit.point.z, below, 2e-6);
                ASSERT_FALSE(sweep(map, {x, y, above}, {-x / 4, -y / 4, above}).found()) << far;
                ASSERT_FALSE(sweep(map, {x, y, below}, {x / 2, y / 2, below}).found()) << far;
            }
    }
}

TEST(ExactMapSweep, PassesThroughTheCentre) {
    const TriangleMesh mesh = make_torus(1, 0.4, 30, 12);
    const ExactMap map = ExactMap::build(mesh);
    const Vec3f c = map.view().centre;
    const SweepHit hit = sweep(map, c, c + Vec3f{2, 0, 0});
    ASSERT_TRUE(hit.found());
    EXPECT_TRUE(hit.entering);
    EXPECT_NEAR(hit.point.x, 0.6F, 0.02F);
    EXPECT_TRUE(sweep(map, c - Vec3f{2, 0, 0}, c + Vec3f{2, 0, 0}).found());
    EXPECT_FALSE(sweep(map, c - Vec3f{0, 0, 2}, c + Vec3f{0, 0, 2}).found());
}

TEST(ExactMapSweep, MeetsNothingFromNowhere) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(sweep(map, {nan, 0, 0}, {0, 0, 0}).found());
    EXPECT_FALSE(sweep(map, {0, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}).found());
    EXPECT_FALSE(sweep(map, {0, 0, 0}, {0, 0, 0}).found());
}

TEST(ExactMapSweep, EndsWhereContainsSeesTheParticleHoweverFarItCameFrom) {
    const ExactMap map = ExactMap::build(make_box({1, 1, 1}));
    test::Random random(9);
    for (int n = 0; n < 2000; ++n) {
        const float far = std::pow(10.0F, static_cast<float>(n % 38));
        const Vec3f from = test::in_cube(random, far) + Vec3f{2 * far, 0, 0};
        const Vec3f to = test::in_sphere(random, 0.7F);
        if (contains(map, from) != contains(map, to)) ASSERT_TRUE(sweep(map, from, to).found());
    }
}

namespace {

/// Faces and particles of all sizes, on a lattice coarse enough that many are degenerate.
class RandomCase {
  public:
    explicit RandomCase(unsigned seed) : random_(seed) {}

    LatticePoint point() {
        const std::int64_t unit = std::int64_t{1} << std::uniform_int_distribution<int>(0, 17)(random_);
        const std::int64_t extent = kLatticeExtent / unit;
        std::uniform_int_distribution<std::int64_t> coordinate(-std::min<std::int64_t>(extent, 4),
                                                               std::min<std::int64_t>(extent, 4));
        return LatticePoint{coordinate(random_), coordinate(random_), coordinate(random_)} * unit;
    }
    std::array<LatticePoint, 3> face() {
        std::array<LatticePoint, 3> corners{point(), point(), point()};
        if (std::uniform_int_distribution<int>(0, 1)(random_) == 1)
            for (LatticePoint& corner : corners) corner += fine_shift();
        return corners;
    }
    /// Often on the plane, on an edge's line or at a corner of the face.
    LatticePoint particle(const std::array<LatticePoint, 3>& face) {
        switch (std::uniform_int_distribution<int>(0, 3)(random_)) {
        case 0:
            return face[0];
        case 1:
            return clamped(face[0] + face[1] - face[2]);
        case 2:
            return {(face[0].x + face[1].x) / 2, (face[0].y + face[1].y) / 2, (face[0].z + face[1].z) / 2};
        default:
            return point();
        }
    }

  private:
    LatticePoint fine_shift() {
        std::uniform_int_distribution<std::int64_t> step(-3, 3);
        return {step(random_), step(random_), step(random_)};
    }
    static LatticePoint clamped(const LatticePoint& p) {
        const auto clamp = [](std::int64_t c) { return std::clamp(c, -kLatticeExtent, kLatticeExtent); };
        return {clamp(p.x), clamp(p.y), clamp(p.z)};
    }

    std::mt19937_64 random_;
};

std::array<std::int32_t, 3> stored(const LatticePoint& p) {
    return {static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y), static_cast<std::int32_t>(p.z)};
}

} // namespace

TEST(CrossingFilter, IsRightWhereverItIsSure) {
    RandomCase random(1);
    int sure_count = 0;
    constexpr int kCount = 400'000;
    for (int n = 0; n < kCount; ++n) {
        std::array<LatticePoint, 3> face = random.face();
        for (LatticePoint& corner : face)
            corner = {std::clamp(corner.x, -kLatticeExtent, kLatticeExtent),
                      std::clamp(corner.y, -kLatticeExtent, kLatticeExtent),
                      std::clamp(corner.z, -kLatticeExtent, kLatticeExtent)};
        const LatticePoint p = random.particle(face);
        const auto a = stored(face[0]), b = stored(face[1]), c = stored(face[2]);
        const CrossingFilter filter(p);
        for (RaySide side : {RaySide::Before, RaySide::Beyond}) {
            const auto [crossing, sure] = filter(side, a.data(), b.data(), c.data());
            if (!sure) continue;
            ++sure_count;
            ASSERT_EQ(crossing, crossing_on(side, face, p)) << "case " << n;
        }
    }
    EXPECT_GT(sure_count, kCount / 4) << "the filter is there to decide most cases";
}

TEST(CrossingFilter, IsNearlyAlwaysSureOfFacesInGeneralPosition) {
    std::mt19937_64 random(2);
    std::uniform_int_distribution<std::int64_t> coordinate(-kLatticeExtent, kLatticeExtent);
    const auto point = [&] {
        return LatticePoint{coordinate(random), coordinate(random), coordinate(random)};
    };
    int unsure = 0;
    for (int n = 0; n < 100'000; ++n) {
        const auto a = stored(point()), b = stored(point()), c = stored(point());
        unsure += CrossingFilter(point())(RaySide::Beyond, a.data(), b.data(), c.data()).sure ? 0 : 1;
    }
    EXPECT_LE(unsure, 1);
}

// Any ray and segment crosses a closed surface equally often inwards and outwards, even through vertices and
// along edges and faces.
TEST(ExactCrossings, OfAClosedSurfaceAddUp) {
    RandomCase random(3);
    for (int n = 0; n < 50'000; ++n) {
        const LatticePoint corners[] = {random.point(), random.point(), random.point(), random.point()};
        const std::array<std::array<int, 3>, 4> faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
        const LatticePoint from = random.point(), to = random.point();
        int before = 0, beyond = 0, crossed = 0;
        for (const auto& [i, j, k] : faces) {
            const std::array<LatticePoint, 3> face{corners[i], corners[j], corners[k]};
            before += crossing_on(RaySide::Before, face, from);
            beyond += crossing_on(RaySide::Beyond, face, from);
            if (const auto crossing = crossing_with_face(face, from, to))
                crossed += crossing->entering() ? 1 : -1;
        }
        int winding_to = 0;
        for (const auto& [i, j, k] : faces)
            winding_to += crossing_on(RaySide::Beyond, {corners[i], corners[j], corners[k]}, to);
        // The origin must not lie on a face; then every ray gives the same winding number.
        bool on_face = false;
        for (const auto& [i, j, k] : faces)
            on_face = on_face || dot(corners[i], cross(corners[j], corners[k])) == 0;
        if (on_face) continue;
        ASSERT_LE(std::abs(before + beyond), 1) << "case " << n;
        ASSERT_LE(std::abs(beyond), 1) << "case " << n;
        ASSERT_EQ(beyond + crossed, winding_to) << "case " << n;
    }
}

TEST(ExactMapSweep, AnswersInBatchesAsOneByOneOnAnyNumberOfThreads) {
    TriangleMesh open = make_torus(1, 0.4, 24, 12);
    open.faces.resize(open.faces.size() - 40);
    const Collider collider{.map = ExactMap::build(open), .pose = {Rotation::about({1, 2, 3}, 1), {1, 0, 0}}};
    const ExactMap& map = std::get<ExactMap>(collider.map.kind);
    const RigidTransform before{Rotation::about({1, 2, 3}, 0.9), {1, 0.1, 0}};
    constexpr std::size_t kCount = 33'000; // so many that threads share them
    test::Random random(42);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < 2 * kCount; ++i) points.push_back(test::in_cube(random, 1.5F));
    const StridedSpan<const Vec3f> all(points), from = all.subspan(0, kCount),
                                                to = all.subspan(kCount, kCount);
    for (const unsigned thread_count : {1U, 2U}) {
        std::vector<SweepHit> hits(kCount), hits_in_world(kCount);
        std::vector<Containment> answers(kCount);
        std::vector<std::uint8_t> inside(kCount);
        std::vector<Contact> contacts(kCount);
        sweep_batch(map, from, to, hits, thread_count);
        classify_batch(map, from, answers, thread_count);
        sweep_batch(collider, before, from, to, hits_in_world, thread_count);
        contains_batch(collider, from, inside, thread_count);
        contacts_batch(collider, from, 0.2F, contacts, thread_count);
        for (std::size_t i = 0; i < kCount; i += 37) {
            const SweepHit hit = sweep(map, from[i], to[i]);
            EXPECT_EQ(hits[i].face, hit.face) << i;
            EXPECT_EQ(hits[i].point, hit.point) << i;
            const Containment answer = classify(map, from[i]);
            EXPECT_EQ(answers[i].inside, answer.inside) << i;
            EXPECT_EQ(answers[i].certain, answer.certain) << i;
            EXPECT_EQ(hits_in_world[i].point, sweep(collider, before, from[i], to[i]).point) << i;
            EXPECT_EQ(inside[i] != 0, contains(collider, from[i])) << i;
            EXPECT_EQ(contacts[i].point, contact(collider, from[i], 0.2F).point) << i;
        }
    }
}
