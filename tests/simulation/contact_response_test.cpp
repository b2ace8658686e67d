#include "exact_map/query/stretched_contact.hpp"
#include "simulation/jakobsen/contact_response.hpp"
#include "simulation/jakobsen/known_contacts.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace echinus;

namespace {

/// Calls check(random, number) ten thousand times.
template <typename Check>
void at_random(const Check& check) {
    test::Random random(20260101);
    for (int i = 0; i < 10'000; ++i) check(random, i);
}

Vec3f tangential(const Vec3f& motion, const Vec3f& normal) {
    return motion - normal * dot(motion, normal);
}

} // namespace

TEST(Friction, ShortensTheTangentialMotionByTheGripAndNeverReversesIt) {
    at_random([](test::Random& random, int) {
        const Vec3f normal = test::unit_vector(random);
        const Vec3f motion = test::in_cube(random, 1);
        const float grip = test::uniform(random, 0, 1.5F);
        const Vec3f before = tangential(motion, normal);
        const Vec3f after = tangential(apply_friction(motion, normal, grip), normal);
        EXPECT_NEAR(length(after), std::max(0.0F, length(before) - grip), 1e-6);
        EXPECT_GE(dot(after, before), -1e-6F);
        EXPECT_NEAR(length(cross(after, before)), 0, 1e-6);
    });
}

TEST(Friction, LeavesTheMotionAlongTheNormal) {
    at_random([](test::Random& random, int) {
        const Vec3f normal = test::unit_vector(random);
        const Vec3f motion = test::in_cube(random, 1);
        const Vec3f left = apply_friction(motion, normal, test::uniform(random, 0, 1.5F));
        EXPECT_NEAR(dot(left, normal), dot(motion, normal), 1e-6);
    });
}

TEST(Friction, OfGripZeroChangesNothing) {
    const Vec3f motion{0.25F, -0.5F, 0.125F};
    EXPECT_EQ(apply_friction(motion, {0, 0, 1}, 0), motion);
    EXPECT_EQ(apply_friction({}, {0, 0, 1}, 0), Vec3f{});
}

TEST(WantedPush, EndsAtTheThicknessFromTheContactPlane) {
    at_random([](test::Random& random, int i) {
        Contact contact;
        contact.normal = test::unit_vector(random);
        contact.point = test::in_cube(random, 1);
        contact.inside = i % 2 == 0;
        const float thickness = test::uniform(random, 0, 0.1F);
        const Vec3f position = test::in_cube(random, 1);
        const Vec3f pushed = position + wanted_push(position, contact, thickness);
        EXPECT_NEAR(dot(pushed - contact.point, contact.normal), thickness, 1e-6);
    });
}

TEST(WantedPush, OfAParticleOutsideKeepsItOverTheSameSpot) {
    Contact contact;
    contact.normal = {0, 0.6F, 0.8F};
    contact.point = {1, 2, 3};
    const Vec3f push = wanted_push({1.5F, 2, 3.01F}, contact, 0.1F);
    EXPECT_NEAR(length(tangential(push, contact.normal)), 0, 1e-6);
}

TEST(WantedPush, OfAParticleInsideLeadsToTheMapsPoint) {
    Contact contact;
    contact.normal = {0, 0, 1};
    contact.point = {1, 2, 3};
    contact.inside = true;
    const Vec3f position{0.5F, 1.5F, 2};
    EXPECT_EQ(position + wanted_push(position, contact, 0), contact.point);
}

TEST(GrantedPush, TakesBackAnApproachInFull) {
    at_random([](test::Random& random, int i) {
        const Vec3f wanted = test::in_cube(random, 1);
        const Vec3f motion = wanted * -test::uniform(random, 1, 3) + cross(wanted, test::in_cube(random, 1));
        EXPECT_NEAR(length(granted_push(wanted, motion, i % 2 == 0) - wanted), 0, 1e-5);
    });
}

TEST(GrantedPush, OutsideNeverMakesAParticleLeave) {
    at_random([](test::Random& random, int) {
        const Vec3f wanted = test::in_cube(random, 1);
        const Vec3f motion = test::in_cube(random, 1);
        const Vec3f granted = granted_push(wanted, motion, false);
        const float before = dot(motion, wanted);
        const float after = dot(motion + granted, wanted);
        EXPECT_LE(after, std::max(0.0F, before) + 1e-5F);
        EXPECT_GE(after, before - 1e-5F);
    });
}

TEST(GrantedPush, InsideLeadsAParticleOutThatDoesNotMove) {
    Vec3f left{0, 0, 1};
    for (int relaxation = 0; relaxation < 100; ++relaxation) left -= granted_push(left, {}, true);
    EXPECT_LT(length(left), 1e-3F);
    EXPECT_EQ(granted_push({}, {1, 2, 3}, true), Vec3f{});
}

TEST(Response, NeverReversesTheTangentialMotion) {
    // The push out of a solid may have a part along the contact plane: friction may not turn that round
    // either.
    at_random([](test::Random& random, int i) {
        Contact contact;
        contact.normal = test::unit_vector(random);
        contact.point = test::in_cube(random, 1) * 0.1F;
        contact.inside = i % 2 == 0;
        const Vec3f position = test::in_cube(random, 1) * 0.1F;
        const Vec3f motion = test::in_cube(random, 1) * 0.1F;
        const ResponseRules slippery{0.01F, 0};
        const ResponseRules rough{0.01F, test::uniform(random, 0, 2)};
        const Vec3f free = tangential(respond(position, motion, contact, slippery), contact.normal);
        const Vec3f braked = tangential(respond(position, motion, contact, rough), contact.normal);
        EXPECT_GE(dot(free, braked), -1e-7F);
        EXPECT_LE(length(braked), length(free) + 1e-6F);
    });
}

TEST(Response, IsNeededInsideAndNearerThanTheThicknessOnly) {
    Contact contact;
    EXPECT_FALSE(needs_response({}, contact, 0.1F));
    contact.normal = {0, 0, 1};
    EXPECT_TRUE(needs_response({0, 0, 0.09F}, contact, 0.1F));
    EXPECT_FALSE(needs_response({0, 0, 0.11F}, contact, 0.1F));
    contact.inside = true;
    EXPECT_TRUE(needs_response({0, 0, -1}, contact, 0.1F));
}

namespace {

constexpr double kWideThickness = 0.02;

Particles particles_around(const Vec3f& centre, std::size_t count, float half_width, test::Random& random) {
    Deformable deformable;
    for (std::size_t i = 0; i < count; ++i) {
        deformable.positions.push_back(centre + test::in_cube(random, half_width));
        deformable.velocities.push_back(test::in_cube(random, 0.05F));
        deformable.inverse_masses.push_back(i % 7 == 3 ? 0.0F : 1.0F);
    }
    return Particles(deformable, 1);
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

} // namespace

TEST(KnownContacts, PutAParticleAtTheThicknessOverItsPlane) {
    const Collider box{.map = ExactMap::build(make_box({1, 1, 1}))};
    const ColliderNow now(box, box.pose, {.thickness = kWideThickness});
    Deformable deformable{.positions = {{0.1F, 0.2F, 0.51F}},
                          .velocities = {{0, 0, -0.02F}},
                          .inverse_masses = {1},
                          .constraints = {},
                          .faces = {}};
    Particles particles(deformable, 1);
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
                          .inverse_masses = {1, 1},
                          .constraints = {},
                          .faces = {}};
    Particles particles(deformable, 1);
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
