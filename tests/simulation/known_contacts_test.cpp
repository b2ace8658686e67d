#include "exact_map/query/stretched_contact.hpp"
#include "simulation/known_contacts.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

namespace {

constexpr double kWideThickness = 0.02;

Particles particles_around(const Vec3f& centre, std::size_t count, float half_width, test::Random& random) {
    Deformable deformable;
    for (std::size_t i = 0; i < count; ++i) {
        deformable.positions.push_back(centre + test::in_cube(random, half_width));
        deformable.previous_positions.push_back(deformable.positions.back() + test::in_cube(random, 0.05F));
        deformable.inverse_masses.push_back(i % 7 == 3 ? 0.0F : 1.0F);
    }
    return Particles(deformable);
}

/// Asks the map about every particle that is not pinned.
KnownContacts known_of(const Particles& particles, const ColliderNow& collider, float reach) {
    KnownContacts known(particles, {});
    for (std::size_t i = 0; i < particles.count(); ++i) {
        if (particles.pinned(i)) continue;
        const Vec3f position = particles.positions[i];
        const Contact nearest =
            stretched_contact(collider.map, collider.local.point_to_local(position), reach, collider.scale);
        known.remember(i, collider, position, !nearest.found() ? reach : nearest.inside ? 0 : -nearest.depth);
        if (!nearest.found()) continue;
        const Vec3f over_plane = known.asked_at_body[i] - collider.to_body(nearest.point);
        known.remember_plane(i, collider, nearest.normal, dot(over_plane, nearest.normal));
    }
    return known;
}

std::vector<Vec3f> as_points(const PointArrays& arrays, std::size_t count) {
    std::vector<Vec3f> points(count);
    arrays.store(points);
    return points;
}

void jiggle(PointArrays& points, std::size_t count, float half_width, test::Random& random) {
    for (std::size_t i = 0; i < count; ++i) points.set(i, points[i] + test::in_cube(random, half_width));
}

} // namespace

TEST(KnownContacts, PushAndListTheSameParticlesUnderEachInstructionSet) {
    const Collider box{.map = ExactMap::build(make_box({1, 1, 1}, 2)),
                       .pose = {Rotation::about({1, 2, 3}, 1), {0.1, 0.2, 0.3}}};
    const RigidTransform before{Rotation::about({1, 2, 3}, 0.9), {0.1, 0.2, 0.31}};
    const ColliderNow now(box, before, {.thickness = kWideThickness});
    for (std::size_t count = 1; count < 200; count += 11) {
        test::Random random(static_cast<unsigned>(count));
        Particles start = particles_around({}, count, 0.8F, random);
        const KnownContacts known = known_of(start, now, 0.1F);
        jiggle(start.positions, count, 0.001F, random);
        std::vector<std::vector<Vec3f>> results;
        std::vector<std::vector<std::uint32_t>> lists;
        test::under_each_instruction_set([&](std::string_view) {
            Particles particles = start;
            ParticleList list(2 * count);
            const std::size_t pushed = push_known(known, now, 0, particles.count(), particles, list);
            EXPECT_LE(pushed + list.count, count);
            list_unproven(known, now, particles.positions, start.positions, list);
            results.push_back(as_points(particles.positions, count));
            results.push_back(as_points(particles.previous, count));
            lists.emplace_back(list.all().begin(), list.all().end());
        });
        for (std::size_t k = 0; k < results.size(); ++k) EXPECT_EQ(results[k], results[k % 2]);
        for (const auto& list : lists) EXPECT_EQ(list, lists.front());
    }
}

TEST(KnownContacts, PutAParticleAtTheThicknessOverItsPlane) {
    const Collider box{.map = ExactMap::build(make_box({1, 1, 1}))};
    const ColliderNow now(box, box.pose, {.thickness = kWideThickness});
    Deformable deformable{.positions = {{0.1F, 0.2F, 0.51F}},
                          .previous_positions = {{0.1F, 0.2F, 0.53F}},
                          .inverse_masses = {1},
                          .sticks = {},
                          .faces = {}};
    Particles particles(deformable);
    const KnownContacts known = known_of(particles, now, 0.1F);
    ParticleList to_ask(1);
    EXPECT_EQ(push_known(known, now, 0, particles.count(), particles, to_ask), 1u);
    EXPECT_EQ(to_ask.count, 0u);
    EXPECT_NEAR(particles.positions[0].z, 0.5 + kWideThickness, 1e-6);
}

TEST(KnownContacts, AskAgainAboutParticlesThatMovedAlongTheSurface) {
    const Collider box{.map = ExactMap::build(make_box({1, 1, 1}))};
    const ColliderNow now(box, box.pose, {.thickness = kWideThickness});
    Deformable deformable{.positions = {{0.1F, 0.2F, 0.51F}, {0.1F, 0.2F, 1.2F}},
                          .previous_positions = {{0.1F, 0.2F, 0.51F}, {0.1F, 0.2F, 1.2F}},
                          .inverse_masses = {1, 1},
                          .sticks = {},
                          .faces = {}};
    Particles particles(deformable);
    const KnownContacts known = known_of(particles, now, 0.1F);
    for (std::size_t i : {0U, 1U}) particles.positions.x[i] += 0.01F;
    ParticleList to_ask(2);
    EXPECT_EQ(push_known(known, now, 0, particles.count(), particles, to_ask), 0u);
    ASSERT_EQ(to_ask.count, 1u); // the other one is far away
    EXPECT_EQ(to_ask.particles[0], 0u);
}

TEST(KnownContacts, ProveNoWayFreeThatCrossesTheSurfaceEvenFarFromTheOrigin) {
    // The collider turns after the map was asked. Ways lead from beside that place to the edge of the ball
    // that was called free, and a little beyond.
    const ExactMap box = ExactMap::build(make_box({1, 1, 1}));
    test::Random random(3);
    for (const Vec3f& centre : {Vec3f{}, Vec3f{30, 20, -10}, Vec3f{1000, -700, 500}}) {
        Collider collider{.map = box, .pose = {Rotation::about({3, 2, 1}, 2), Vec3d(centre)}};
        const ColliderNow then(collider, collider.pose, {.thickness = kWideThickness});
        const Particles particles = particles_around(centre, 5000, 0.8F, random);
        KnownContacts known = known_of(particles, then, 0.1F);
        collider.pose.rotation = Rotation::about({1, -1, 2}, 0.7);
        const ColliderNow now(collider, collider.pose, {.thickness = kWideThickness});
        known.follow(now);
        std::size_t proven_count = 0;
        std::size_t crossing_count = 0;
        for (std::size_t i = 0; i < particles.count(); ++i) {
            if (particles.pinned(i) || known.height[i] == KnownContacts::kNoPlane || known.clearance[i] <= 0)
                continue;
            const Vec3f before = known.asked_at[i] + test::in_cube(random, known.clearance[i] / 2);
            const float share = 1 + test::uniform(random, -0.01F, 0.001F);
            const Vec3f edge = known.asked_at[i] - known.normal[i] * (known.clearance[i] * share);
            const Vec3f from = now.local.point_to_local(before), to = now.local.point_to_local(edge);
            const bool crosses = contains(now.map, from) || sweep(now.map, from, to).found();
            const bool is_proven = is_known_free(known, now, i, edge, before);
            EXPECT_FALSE(crosses && is_proven);
            proven_count += is_proven ? 1 : 0;
            crossing_count += crosses ? 1 : 0;
        }
        EXPECT_GT(crossing_count, 20u);
        if (centre == Vec3f{}) EXPECT_GT(proven_count, 100u);
    }
}
