#include "handles.hpp"
#include "support/custom_maps.hpp"
#include "support/random_points.hpp"

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

bool same(const echinus_contact& a, const Contact& b) {
    return std::memcmp(&a, &b, offsetof(echinus_contact, feature) + 1) == 0;
}

/// One collider in both languages: turned, stretched and moving.
struct Pair {
    Pair(const CMap& c_kind, const ColliderMap& cpp_kind) : by_cpp{.map = cpp_kind} {
        echinus_collider_init(&collider, sizeof collider, c_kind.get());
        const double axis[3] = {1, 2, 3};
        expect_ok(echinus_rotation_about(axis, 0.7, collider.pose.rotation));
        by_cpp.pose = {Rotation::about({1, 2, 3}, 0.7), {100, -3, 0.5}};
        by_cpp.scale = {2, 1.5, -1};
        by_cpp.linear_velocity = {1, 0, 2};
        by_cpp.angular_velocity = {0, 3, 1};
        const auto put = [](const Vec3d& v, double* to) { std::memcpy(to, &v, sizeof v); };
        put(by_cpp.pose.translation, collider.pose.translation);
        put(by_cpp.scale, collider.scale);
        put(by_cpp.linear_velocity, collider.linear_velocity);
        put(by_cpp.angular_velocity, collider.angular_velocity);
    }

    std::vector<Vec3f> points() const {
        Random random(4);
        std::vector<Vec3f> result;
        for (int i = 0; i < 1000; ++i) result.push_back(Vec3f(by_cpp.pose.translation) + in_cube(random, 3));
        result[5].x = std::numeric_limits<float>::quiet_NaN();
        return result;
    }

    echinus_collider collider;
    Collider by_cpp;
};

void expect_answers_of_cpp(const Pair& pair) {
    const std::vector<Vec3f> points = pair.points();
    std::vector<std::uint8_t> inside(points.size()), expected_inside(points.size());
    contains_batch(pair.by_cpp, points, expected_inside);
    expect_ok(
        echinus_collider_contains(&pair.collider, &points.data()->x, points.size(), 0, 1, inside.data()));
    EXPECT_EQ(inside, expected_inside);
    EXPECT_GT(std::ranges::count(inside, 1), 0);
    std::vector<echinus_contact> contacts(points.size());
    std::vector<Contact> expected(points.size());
    contacts_batch(pair.by_cpp, points, 0.2F, expected);
    expect_ok(echinus_collider_contacts(&pair.collider, &points.data()->x, points.size(), 12, 0.2F, 1,
                                        contacts.data()));
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_TRUE(same(contacts[i], expected[i])) << i;
}

TEST(CColliders, AnswerAsInCpp) {
    const CMesh mesh = c_torus();
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    const CMap exact = c_map(mesh), distance = c_distance_map(mesh);
    expect_answers_of_cpp({exact, ExactMap::build(torus)});
    expect_answers_of_cpp({distance, DistanceMap::build(torus)});
}

TEST(CColliders, MoveAsInCpp) {
    const CMap map = c_map(c_torus());
    const Pair pair(map, ExactMap::build(make_torus(1.0, 0.4, 60, 24)));
    const Vec3d point{99, 0, 1};
    double velocity[3];
    expect_ok(echinus_collider_velocity_at(&pair.collider, Numbers(point), velocity));
    const Vec3d expected = velocity_at(pair.by_cpp, point);
    EXPECT_EQ(std::memcmp(velocity, &expected, sizeof velocity), 0);

    echinus_pose after;
    expect_ok(echinus_collider_pose_after(&pair.collider, 0.25, &after));
    const RigidTransform expected_pose = pose_after(pair.by_cpp, 0.25);
    EXPECT_EQ(std::memcmp(&after, &expected_pose, sizeof after), 0);

    const std::vector<Vec3f> points = pair.points();
    constexpr std::size_t kCount = 500;
    std::vector<echinus_sweep_hit> hits(kCount);
    expect_ok(echinus_collider_sweep(&pair.collider, &after, &points[0].x, 0, &points[kCount].x, 0, kCount, 1,
                                     hits.data()));
    std::size_t hit_count = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
        const SweepHit hit = sweep(pair.by_cpp, expected_pose, points[i], points[kCount + i]);
        ASSERT_EQ(std::memcmp(&hits[i], &hit, offsetof(echinus_sweep_hit, entering) + 1), 0) << i;
        hit_count += hit.found() ? 1 : 0;
    }
    EXPECT_GT(hit_count, 20U);
}

TEST(CColliders, AreRefusedWhenTheirPoseIsNone) {
    const CMap map = c_map(c_torus());
    echinus_collider collider;
    std::uint8_t inside = 0;
    const float point[3] = {};
    const auto expect_wrong = [&](const char* words) {
        expect_refused(echinus_collider_contains(&collider, point, 1, 0, 1, &inside),
                       ECHINUS_INVALID_ARGUMENT, words);
        echinus_collider_init(&collider, sizeof collider, map.get());
    };
    echinus_collider_init(&collider, sizeof collider, map.get());
    collider.pose.rotation[1] = 0.1;
    expect_wrong("unit length");
    collider.pose.rotation[1] = kNan;
    expect_wrong("unit length");
    collider.pose.translation[2] = kNan;
    expect_wrong("translation is not finite");
    collider.scale[1] = 0;
    expect_wrong("scale is 0");
    collider.scale[1] = kNan;
    expect_wrong("scale is 0 or not finite");
    collider.size = 3;
    expect_wrong("size of collider is 3");
    collider.map = nullptr;
    expect_wrong("the map of the collider is NULL");
    expect_ok(echinus_collider_contains(&collider, point, 1, 0, 1, &inside));

    double rotation[4];
    const double zero[3] = {};
    expect_refused(echinus_rotation_about(zero, 1, rotation), ECHINUS_INVALID_ARGUMENT, "axis is zero");
}

// ---- Custom maps

/// A ball as four functions of C.
struct Ball {
    AnalyticBall ball{1.0F};
    int released = 0;

    static std::span<const Vec3f> span_of(const float* points, std::size_t count) {
        return {reinterpret_cast<const Vec3f*>(points), count};
    }
    static void contains(void* context, const float* points, std::size_t count, std::uint8_t* inside) {
        static_cast<Ball*>(context)->ball.contains_batch(span_of(points, count), {inside, count});
    }
    static void contacts(void* context, const float* points, std::size_t count, float margin,
                         echinus_contact* contacts) {
        static_cast<Ball*>(context)->ball.contacts_batch(span_of(points, count), margin,
                                                         {reinterpret_cast<Contact*>(contacts), count});
    }
    /// With flags and a feature that C++ has not.
    static void strange_contacts(void* context, const float* points, std::size_t count, float margin,
                                 echinus_contact* contacts) {
        Ball::contacts(context, points, count, margin, contacts);
        for (std::size_t i = 0; i < count; ++i) {
            if (contacts[i].inside != 0) contacts[i].inside = 200;
            contacts[i].certain = 77;
            contacts[i].feature = 55;
        }
    }
    static void release(void* context) { ++static_cast<Ball*>(context)->released; }

    echinus_custom_map functions() {
        return {.size = sizeof(echinus_custom_map),
                .context = this,
                .contains = contains,
                .contacts = contacts,
                .release = release};
    }
};

TEST(CCustomMaps, AnswerThroughColliders) {
    Ball ball;
    for (const auto contacts : {Ball::contacts, Ball::strange_contacts}) {
        echinus_custom_map functions = ball.functions();
        functions.contacts = contacts;
        CMap map;
        expect_ok(echinus_map_from_custom(&functions, out(map)));
        expect_answers_of_cpp({map, std::make_shared<const AnalyticBall>(1.0F)});
        std::uint8_t inside = 0;
        const float point[3] = {};
        expect_refused(echinus_map_contains(map.get(), point, 1, 0, 1, &inside), ECHINUS_INVALID_ARGUMENT,
                       "only colliders can query");
        expect_refused(echinus_map_save(map.get(), "x.ech"), ECHINUS_INVALID_ARGUMENT, "no bytes to write");
        echinus_map_info info{};
        info.size = sizeof info;
        expect_ok(echinus_map_describe(map.get(), &info));
        EXPECT_EQ(info.kind, ECHINUS_MAP_CUSTOM);
    }
    EXPECT_EQ(ball.released, 2);
}

TEST(CCustomMaps, AreReleasedWithTheLastSimulation) {
    Ball ball;
    const echinus_custom_map functions = ball.functions();
    CMap map;
    expect_ok(echinus_map_from_custom(&functions, out(map)));
    echinus_collider collider;
    echinus_collider_init(&collider, sizeof collider, map.get());
    CDeformable cloth;
    expect_ok(echinus_deformable_cloth(nullptr, out(cloth)));
    CSimulation simulation, copy;
    echinus_simulation_options options;
    echinus_simulation_options_init(&options, sizeof options);
    options.solver = ECHINUS_SOLVER_JAKOBSEN;
    expect_ok(echinus_simulation_create(cloth.get(), &collider, 1, &options, out(simulation)));
    expect_ok(echinus_simulation_copy(simulation.get(), out(copy)));
    map.reset();
    simulation.reset();
    EXPECT_EQ(ball.released, 0);
    expect_ok(echinus_simulation_step(copy.get()));
    copy.reset();
    EXPECT_EQ(ball.released, 1);
}

TEST(CCustomMaps, AreNotReleasedWhenRefused) {
    Ball ball;
    echinus_custom_map functions = ball.functions();
    functions.contacts = nullptr;
    CMap map;
    expect_refused(echinus_map_from_custom(&functions, out(map)), ECHINUS_INVALID_ARGUMENT,
                   "custom.contacts is NULL");
    EXPECT_EQ(map, nullptr);
    EXPECT_EQ(ball.released, 0);
}

} // namespace
