#include <echinus/collider.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

using namespace echinus;

namespace {

const DistanceMap& torus_map() {
    static const DistanceMap map =
        DistanceMap::build(make_torus(1, 0.4, 24, 12), {.longitude_count = 64, .colatitude_count = 64});
    return map;
}

Collider placed_torus() {
    return {.map = torus_map(),
            .pose = {Rotation::about({3, -1, 2}, 1.1), {10, -20, 30}},
            .scale = {2.5, 2.5, 2.5}};
}

std::vector<Vec3f> points_around(const Collider& collider, std::size_t count) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> coordinate(-1.6, 1.6);
    std::vector<Vec3f> points;
    while (points.size() < count) {
        const Vec3d local{coordinate(engine), coordinate(engine), coordinate(engine)};
        points.emplace_back(collider.pose.to_world(local * collider.scale.x));
    }
    return points;
}

Vec3f to_local(const Collider& collider, const Vec3f& point_world) {
    return Vec3f(collider.pose.to_local(Vec3d(point_world)) * (1 / collider.scale.x));
}

void expect_same(const Contact& a, const Contact& b) {
    EXPECT_EQ(a.point, b.point);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.depth, b.depth);
    EXPECT_EQ(a.face, b.face);
    EXPECT_EQ(a.inside, b.inside);
}

} // namespace

TEST(Collider, AnswersAsItsMapDoesInTheLocalFrame) {
    const Collider collider = placed_torus();
    constexpr float kMargin = 0.5F; // world units: 0.2 in the local frame
    int found = 0;
    int inside = 0;
    for (const Vec3f& point : points_around(collider, 2000)) {
        const Vec3f point_local = to_local(collider, point);
        const Contact local = contact(torus_map(), point_local, kMargin / 2.5F);
        const Contact world = contact(collider, point, kMargin);
        // The two ways to the local frame round differently: answers next to a surface or to a cell's border
        // may differ, for so few points that none is among these.
        ASSERT_EQ(world.inside, local.inside);
        ASSERT_EQ(world.found(), local.found());
        EXPECT_EQ(contains(collider, point), world.inside);
        if (!world.found()) continue;
        ++found;
        inside += world.inside ? 1 : 0;
        EXPECT_NEAR(world.depth, 2.5F * local.depth, 2e-4F);
        EXPECT_NEAR(length(to_local(collider, world.point) - local.point), 0, 1e-4F);
        EXPECT_NEAR(length(Vec3d(world.normal) - collider.pose.rotation.apply(Vec3d(local.normal))), 0, 2e-3);
        EXPECT_NEAR(length(world.point - point), std::abs(world.depth), 1e-4F);
    }
    EXPECT_GT(found, 200);
    EXPECT_GT(inside, 100);
}

TEST(Collider, ReturnsTheParticleItselfWhereItFindsNothing) {
    const Collider collider = placed_torus();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const Vec3f& point :
         {Vec3f{0.1F, 0.2F, 0.3F}, Vec3f{kInfinity, 0, 0}, Vec3f{3e38F, 3e38F, -3e38F}}) {
        const Contact nothing = contact(collider, point, 0.1F);
        EXPECT_FALSE(nothing.found());
        EXPECT_EQ(nothing.point, point);
        EXPECT_EQ(nothing.depth, 0);
        EXPECT_FALSE(contains(collider, point));
    }
    EXPECT_FALSE(contact(collider, {kNaN, 0, 0}, 0.1F).found());
    EXPECT_FALSE(contains(collider, {kNaN, 0, 0}));
}

TEST(Collider, AnswersABatchOfAnyLengthAsItAnswersEachPoint) {
    const Collider collider = placed_torus();
    const std::vector<Vec3f> points = points_around(collider, 1000);
    for (const std::size_t count : {0, 1, 255, 256, 257, 1000}) {
        const StridedSpan<const Vec3f> batch(points.data(), count);
        std::vector<Contact> contacts(count);
        std::vector<std::uint8_t> inside(count);
        contacts_batch(collider, batch, 0.3F, contacts);
        contains_batch(collider, batch, inside);
        for (std::size_t i = 0; i < count; ++i) {
            expect_same(contacts[i], contact(collider, points[i], 0.3F));
            EXPECT_EQ(inside[i], contains(collider, points[i]) ? 1 : 0);
        }
    }
}

TEST(Collider, AnswersWithItsMapsBitsWhereItStandsAtTheOrigin) {
    const Collider collider{.map = torus_map()};
    for (const Vec3f& point : points_around(collider, 1000))
        expect_same(contact(collider, point, 0.1F), contact(torus_map(), point, 0.1F));
}

TEST(Collider, FarFromTheOriginAnswersAsFinelyAsFloatPositionsAllow) {
    const DistanceMap map =
        DistanceMap::build(make_sphere(1, 60, 30), {.longitude_count = 64, .colatitude_count = 64});
    const Collider collider{.map = map, .pose = {Rotation{}, {0, 4096, 0}}};
    EXPECT_TRUE(contains(collider, {0.5F, 4096.5F, 0}));
    EXPECT_FALSE(contains(collider, {0.5F, 4097.5F, 0}));
    EXPECT_NEAR(contact(collider, {0, 4096.9F, 0}).depth, 0.1, 6e-3);
}
