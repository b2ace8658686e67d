#include <echinus/collider.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
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

std::vector<Vec3f> points_around(const Collider& collider, std::size_t count) {
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> coordinate(-1.6, 1.6);
    std::vector<Vec3f> points;
    while (points.size() < count)
        points.emplace_back(
            collider.pose.to_world({coordinate(engine), coordinate(engine), coordinate(engine)}));
    for (std::size_t i = 5; i < count; i += 97) points[i].y = std::numeric_limits<float>::quiet_NaN();
    return points;
}

struct Arrays {
    explicit Arrays(std::size_t count)
        : particles(count), points(count), normals(count), depths(count), faces(count), inside(count) {}

    std::vector<std::uint32_t> particles;
    std::vector<Vec3f> points, normals;
    std::vector<float> depths;
    std::vector<std::int32_t> faces;
    std::vector<std::uint8_t> inside;
};

} // namespace

TEST(ContactsInto, AreThoseOfTheBatchBitForBitWithoutTheOthers) {
    for (const Collider& collider : colliders_of_all_kinds())
        for (const std::size_t count : {0U, 1U, 255U, 256U, 5000U})
            for (const float margin : {0.0F, 0.2F}) {
                const std::vector<Vec3f> points = points_around(collider, count);
                std::vector<Contact> batch(count);
                contacts_batch(collider, points, margin, batch);
                Arrays into(count);
                const std::size_t found = contacts_into(
                    collider, points, margin,
                    {into.particles, into.points, into.normals, into.depths, into.faces, into.inside});
                std::size_t at = 0;
                for (std::size_t i = 0; i < count; ++i) {
                    if (!batch[i].found()) continue;
                    ASSERT_LT(at, found);
                    ASSERT_EQ(into.particles[at], i);
                    ASSERT_EQ(into.points[at], batch[i].point);
                    ASSERT_EQ(into.normals[at], batch[i].normal);
                    ASSERT_EQ(into.depths[at], batch[i].depth);
                    ASSERT_EQ(into.faces[at], batch[i].face);
                    ASSERT_EQ(into.inside[at] != 0, batch[i].inside);
                    ++at;
                }
                ASSERT_EQ(at, found);
                if (count == 5000U) ASSERT_GT(found, 100U) << "too few for a test";
            }
}

TEST(ContactsInto, WritesOnlyTheArraysThatAreThere) {
    const Collider collider{.map = ExactMap::build(make_sphere(1, 16, 8))};
    const std::vector<Vec3f> points{{0, 0, 5}, {0, 0, 0.9F}, {5, 0, 0}, {0.9F, 0, 0}};
    EXPECT_EQ(contacts_into(collider, points, 0, {}), 2U);
    std::vector<float> depths(4, -7);
    EXPECT_EQ(contacts_into(collider, points, 0, {.particles = {}, .depths = depths}), 2U);
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
    ASSERT_EQ(contacts_into(collider, places, 0, {particles}), 2U);
    EXPECT_EQ(particles[0], 1U);
    EXPECT_EQ(particles[1], 2U);
}
