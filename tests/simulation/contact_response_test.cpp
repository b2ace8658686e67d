#include "simulation/contact_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace echinus;

namespace {

class Dice {
  public:
    float within(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    Vec3f vector() { return {within(-1, 1), within(-1, 1), within(-1, 1)}; }
    Vec3f unit_vector() {
        Vec3f v = vector();
        while (length(v) < 0.1F) v = vector();
        return v * (1 / length(v));
    }

  private:
    std::mt19937 engine_{20260101};
};

Vec3f tangential(const Vec3f& motion, const Vec3f& normal) {
    return motion - normal * dot(motion, normal);
}

} // namespace

TEST(Friction, ShortensTheTangentialMotionByTheGripAndNeverReversesIt) {
    Dice dice;
    for (int i = 0; i < 10'000; ++i) {
        const Vec3f normal = dice.unit_vector();
        const Vec3f motion = dice.vector();
        const float grip = dice.within(0, 1.5F);
        const Vec3f before = tangential(motion, normal);
        const Vec3f after = tangential(apply_friction(motion, normal, grip), normal);
        EXPECT_NEAR(length(after), std::max(0.0F, length(before) - grip), 1e-6);
        EXPECT_GE(dot(after, before), -1e-6F);
        EXPECT_NEAR(length(cross(after, before)), 0, 1e-6);
    }
}

TEST(Friction, LeavesTheMotionAlongTheNormal) {
    Dice dice;
    for (int i = 0; i < 10'000; ++i) {
        const Vec3f normal = dice.unit_vector();
        const Vec3f motion = dice.vector();
        const Vec3f left = apply_friction(motion, normal, dice.within(0, 1.5F));
        EXPECT_NEAR(dot(left, normal), dot(motion, normal), 1e-6);
    }
}

TEST(Friction, OfGripZeroChangesNothing) {
    const Vec3f motion{0.25F, -0.5F, 0.125F};
    EXPECT_EQ(apply_friction(motion, {0, 0, 1}, 0), motion);
    EXPECT_EQ(apply_friction({}, {0, 0, 1}, 0), Vec3f{});
}

TEST(WantedPush, EndsAtTheThicknessFromTheContactPlane) {
    Dice dice;
    for (int i = 0; i < 10'000; ++i) {
        Contact contact;
        contact.normal = dice.unit_vector();
        contact.point = dice.vector();
        contact.inside = i % 2 == 0;
        const float thickness = dice.within(0, 0.1F);
        const Vec3f position = dice.vector();
        const Vec3f pushed = position + wanted_push(position, contact, thickness);
        EXPECT_NEAR(dot(pushed - contact.point, contact.normal), thickness, 1e-6);
    }
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
    Dice dice;
    for (int i = 0; i < 10'000; ++i) {
        const Vec3f wanted = dice.vector();
        const Vec3f motion = wanted * -dice.within(1, 3) + cross(wanted, dice.vector());
        EXPECT_NEAR(length(granted_push(wanted, motion, i % 2 == 0) - wanted), 0, 1e-5);
    }
}

TEST(GrantedPush, OutsideNeverMakesAParticleLeave) {
    Dice dice;
    for (int i = 0; i < 10'000; ++i) {
        const Vec3f wanted = dice.vector();
        const Vec3f motion = dice.vector();
        const Vec3f granted = granted_push(wanted, motion, false);
        const float before = dot(motion, wanted);
        const float after = dot(motion + granted, wanted);
        EXPECT_LE(after, std::max(0.0F, before) + 1e-5F);
        EXPECT_GE(after, before - 1e-5F);
    }
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
    Dice dice;
    for (int i = 0; i < 10'000; ++i) {
        Contact contact;
        contact.normal = dice.unit_vector();
        contact.point = dice.vector() * 0.1F;
        contact.inside = i % 2 == 0;
        const Vec3f position = dice.vector() * 0.1F;
        const Vec3f motion = dice.vector() * 0.1F;
        const ResponseRules slippery{0.01F, 0};
        const ResponseRules rough{0.01F, dice.within(0, 2)};
        const Vec3f free = tangential(respond(position, motion, contact, slippery), contact.normal);
        const Vec3f braked = tangential(respond(position, motion, contact, rough), contact.normal);
        EXPECT_GE(dot(free, braked), -1e-7F);
        EXPECT_LE(length(braked), length(free) + 1e-6F);
    }
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
