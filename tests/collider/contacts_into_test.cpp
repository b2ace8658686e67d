#include <echinus/collider.hpp>

#include <gtest/gtest.h>

#ifndef _WIN32
#include <pthread.h>
#endif

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <vector>

using namespace echinus;

namespace {

/// A unit ball of the user's own.
class Ball : public CustomMap {
  public:
    void contains_batch(std::span<const Vec3f> points_local,
                        std::span<std::uint8_t> inside) const noexcept override {
        for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = length(points_local[i]) < 1 ? 1 : 0;
    }
    void contacts_batch(std::span<const Vec3f> points_local, float margin,
                        std::span<Contact> contacts) const noexcept override {
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            contacts[i] = {};
            const float distance = length(points_local[i]);
            if (!(distance > 0 && distance <= 1 + margin)) continue;
            contacts[i].normal = points_local[i] * (1 / distance);
            contacts[i].point = contacts[i].normal;
            contacts[i].depth = 1 - distance;
            contacts[i].inside = distance < 1;
        }
    }
};

std::vector<Collider> colliders_of_all_kinds() {
    const TriangleMesh torus = make_torus(1, 0.4, 24, 12);
    const RigidTransform pose{Rotation::about({3, -1, 2}, 1.1), {1, -2, 3}};
    const DistanceMap distance = DistanceMap::build(torus, {.longitude_count = 64, .colatitude_count = 64});
    return {{.map = ExactMap::build(torus)},
            {.map = ExactMap::build(torus), .pose = pose, .scale = {2, 1, -0.5}},
            {.map = distance, .pose = pose, .scale = {2, 2, 2}},
            {.map = std::make_shared<const Ball>(), .pose = pose}};
}

std::vector<Vec3f> points_about(const Collider& collider, std::size_t count) {
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> coordinate(-1.6, 1.6);
    std::vector<Vec3f> points;
    while (points.size() < count)
        points.emplace_back(
            collider.pose.to_world({coordinate(engine), coordinate(engine), coordinate(engine)}));
    for (std::size_t i = 5; i < count; i += 97) points[i].y = std::numeric_limits<float>::quiet_NaN();
    return points;
}

template <typename T = float>
struct Arrays {
    explicit Arrays(std::size_t room)
        : particles(room), points(room), normals(room), depths(room), faces(room), inside(room),
          colliders(room) {}

    ContactArrays<T> all() { return {particles, points, normals, depths, faces, inside, colliders}; }

    std::vector<std::uint32_t> particles;
    std::vector<Vec3<T>> points;
    std::vector<Vec3f> normals;
    std::vector<float> depths;
    std::vector<std::uint32_t> faces;
    std::vector<std::uint8_t> inside;
    std::vector<std::uint32_t> colliders;
};

/// The single queries are the reference.
void expect_contacts_of(std::span<const Collider> colliders, const std::vector<Vec3f>& points, float margin,
                        std::size_t least_count) {
    Arrays into(colliders.size() * points.size());
    const std::size_t count = contacts_into(colliders, points, margin, into.all());
    std::size_t at = 0;
    for (std::size_t k = 0; k < colliders.size(); ++k)
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Contact expected = contact(colliders[k], points[i], margin);
            if (!expected.found()) continue;
            ASSERT_LT(at, count);
            ASSERT_EQ(into.colliders[at], k);
            ASSERT_EQ(into.particles[at], i);
            ASSERT_EQ(into.points[at], expected.point);
            ASSERT_EQ(into.normals[at], expected.normal);
            ASSERT_EQ(into.depths[at], expected.depth);
            ASSERT_EQ(into.faces[at], expected.face);
            ASSERT_EQ(into.inside[at] != 0, expected.inside);
            ++at;
        }
    ASSERT_EQ(at, count);
    ASSERT_GE(count, least_count) << "too few for a test";
}

} // namespace

TEST(ContactsInto, AreThoseOfSingleQueriesBitForBitWithoutTheOthers) {
    for (const Collider& collider : colliders_of_all_kinds())
        for (const std::size_t count : {0U, 1U, 255U, 256U, 5000U})
            for (const float margin : {0.0F, 0.2F})
                expect_contacts_of({&collider, 1}, points_about(collider, count), margin,
                                   count == 5000U ? 100 : 0);
}

TEST(ContactsInto, OfSeveralCollidersFollowOneAnother) {
    const std::vector<Collider> colliders = colliders_of_all_kinds();
    for (const float margin : {0.0F, 0.2F})
        expect_contacts_of(colliders, points_about(colliders[1], 2000), margin, 200);
    expect_contacts_of({}, points_about(colliders[1], 10), 1, 0);
}

TEST(ContactsInto, LackNoneOfCollidersThatTheirBallsOnlyJustReach) {
    // A needle's tip is its bounding ball's, too.
    TriangleMesh needle = make_box({0.02, 0.02, 2});
    for (Vec3f& v : needle.vertices) v.x += 3; // the ball's centre is not the map's origin
    TriangleMesh open = needle;
    open.faces.pop_back();
    const std::array<ExactMap, 2> maps{ExactMap::build(needle), ExactMap::build(open)};
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> number(-1, 1);
    std::size_t found_count = 0;
    for (int trial = 0; trial < 400; ++trial) {
        std::vector<Collider> colliders;
        for (const ExactMap& map : maps)
            colliders.push_back({.map = map,
                                 .pose = {Rotation::about({number(engine), number(engine), 1}, 3),
                                          {1e5 * number(engine), 1e5 * number(engine), 1e5 * number(engine)}},
                                 .scale = {1, -2, 1 + 0.5 * number(engine)}});
        const Collider& collider = colliders[0];
        const Vec3d tip = collider.pose.to_world({3, 0, collider.scale.z});
        const Vec3d out = collider.pose.rotation.apply({0, 0, 1});
        const std::vector<Vec3d> points{tip + out * (0.1 * (1 + 1e-5 * number(engine)))};
        // Beside a second collider each is asked only where its ball reaches; alone always.
        std::size_t alone = 0;
        for (const Collider& one : colliders) alone += contacts_into({&one, 1}, points, 0.1F, {});
        ASSERT_EQ(contacts_into(colliders, points, 0.1F, {}), alone) << "trial " << trial;
        found_count += alone;
    }
    EXPECT_GT(found_count, 100U);
    EXPECT_LT(found_count, 700U) << "some are to be out of reach";
}

TEST(ContactsInto, InDoubleAreTheSameAMillionAway) {
    // So that moving there and back rounds nothing.
    const auto on_lattice = [](float x) { return std::ldexp(std::round(std::ldexp(x, 20)), -20); };
    const Vec3d away{1048576, -2097152, 524288};
    for (const Collider& here : colliders_of_all_kinds()) {
        Collider there = here;
        there.pose.translation += away;
        std::vector<Vec3f> points = points_about(here, 3000);
        for (Vec3f& p : points) p = {on_lattice(p.x), on_lattice(p.y), on_lattice(p.z)};
        std::vector<Vec3d> moved;
        for (const Vec3f& p : points) moved.push_back(Vec3d(p) + away);
        Arrays<float> near(points.size());
        Arrays<double> far(points.size());
        const std::size_t count = contacts_into({&here, 1}, points, 0.2F, near.all());
        ASSERT_EQ(contacts_into({&there, 1}, moved, 0.2F, far.all()), count);
        ASSERT_GT(count, 100U);
        EXPECT_EQ(far.particles, near.particles);
        EXPECT_EQ(far.normals, near.normals);
        EXPECT_EQ(far.depths, near.depths);
        EXPECT_EQ(far.faces, near.faces);
        EXPECT_EQ(far.inside, near.inside);
        for (std::size_t k = 0; k < count; ++k)
            ASSERT_LT(length(far.points[k] - away - Vec3d(near.points[k])), 1e-6) << k;
    }
}

TEST(ContactsInto, InDoubleAtFloatPlacesAreThoseInFloat) {
    for (const Collider& collider : colliders_of_all_kinds()) {
        const std::vector<Vec3f> points = points_about(collider, 1000);
        const std::vector<Vec3d> exact(points.begin(), points.end());
        Arrays<float> in_float(points.size());
        Arrays<double> in_double(points.size());
        const std::size_t count = contacts_into({&collider, 1}, points, 0.1F, in_float.all());
        ASSERT_EQ(contacts_into({&collider, 1}, exact, 0.1F, in_double.all()), count);
        for (std::size_t k = 0; k < count; ++k) {
            ASSERT_EQ(in_double.particles[k], in_float.particles[k]);
            ASSERT_EQ(Vec3f(in_double.points[k]), in_float.points[k]);
            ASSERT_EQ(in_double.normals[k], in_float.normals[k]);
        }
    }
}

TEST(ContactsInto, WritesOnlyTheArraysThatAreThereAndAsFarAsTheyGo) {
    const Collider collider{.map = ExactMap::build(make_sphere(1, 16, 8))};
    const std::vector<Vec3f> points{{0, 0, 5}, {0, 0, 0.9F}, {5, 0, 0}, {0.9F, 0, 0}};
    EXPECT_EQ(contacts_into({&collider, 1}, points, 0, {}), 2U);
    std::vector<float> depths(4, -7);
    std::vector<std::uint32_t> particles(1);
    EXPECT_EQ(contacts_into({&collider, 1}, points, 0, {.particles = particles, .depths = depths}), 2U);
    EXPECT_EQ(particles[0], 1U);
    EXPECT_GT(depths[0], 0);
    EXPECT_GT(depths[1], 0);
    EXPECT_EQ(depths[2], -7) << "beyond the contacts nothing is written";
}

TEST(ContactsInto, TakesPointsInPlaceFromVertexStructs) {
    struct Vertex {
        double weight;
        Vec3f place;
    };
    const Collider collider{.map = ExactMap::build(make_sphere(1, 16, 8))};
    const std::array<Vertex, 3> vertices{{{1, {4, 0, 0}}, {2, {0.5F, 0, 0}}, {3, {0, 0.2F, 0}}}};
    std::array<std::uint32_t, 3> particles{};
    const StridedSpan<const Vec3f> places(&vertices[0].place, vertices.size(), sizeof(Vertex));
    ASSERT_EQ(contacts_into({&collider, 1}, places, 0, {particles}), 2U);
    EXPECT_EQ(particles[0], 1U);
    EXPECT_EQ(particles[1], 2U);
}

// Frames of a sanitizer's build are larger.
#if !defined(_WIN32) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

TEST(ContactsInto, NeedsOnlyASmallStack) {
    constexpr std::size_t kStack = 64 * 1024;
    struct Question {
        std::vector<Collider> colliders = colliders_of_all_kinds();
        std::vector<Vec3f> points = points_about(colliders[0], 3000);
        std::vector<std::uint32_t> particles = std::vector<std::uint32_t>(4 * points.size());
        std::size_t count = 0;

        std::size_t ask() {
            ContactArrays<float> arrays{particles};
            return contacts_into(colliders, points, 0.1F, arrays);
        }
    } question;
    TriangleMesh torn = make_torus(1, 0.4, 24, 12);
    torn.faces.resize(torn.faces.size() - 40);
    question.colliders.push_back({.map = ExactMap::build(torn)});
    pthread_attr_t small;
    ASSERT_EQ(pthread_attr_init(&small), 0);
    ASSERT_EQ(pthread_attr_setstacksize(&small, kStack), 0);
    const auto ask = [](void* given) -> void* {
        auto& asked = *static_cast<Question*>(given);
        asked.count = asked.ask();
        return nullptr;
    };
    pthread_t thread{};
    ASSERT_EQ(pthread_create(&thread, &small, ask, &question), 0);
    ASSERT_EQ(pthread_join(thread, nullptr), 0);
    pthread_attr_destroy(&small);
    EXPECT_GT(question.count, 0U);
    EXPECT_EQ(question.count, question.ask());
}

#endif
