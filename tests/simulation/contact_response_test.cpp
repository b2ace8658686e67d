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

TEST(PushOut, EndsAtTheThicknessFromTheContactPlane) {
    Dice dice;
    for (int i = 0; i < 10'000; ++i) {
        Contact contact;
        contact.normal = dice.unit_vector();
        contact.point = dice.vector();
        contact.inside = i % 2 == 0;
        const float thickness = dice.within(0, 0.1F);
        const Vec3f pushed = push_out(dice.vector(), contact, thickness);
        EXPECT_NEAR(dot(pushed - contact.point, contact.normal), thickness, 1e-6);
        EXPECT_NEAR(push_length(pushed, contact, thickness), 0, 1e-6);
    }
}

TEST(PushOut, OfAParticleOutsideKeepsItOverTheSameSpot) {
    Contact contact;
    contact.normal = {0, 0.6F, 0.8F};
    contact.point = {1, 2, 3};
    const Vec3f position{1.5F, 2, 3.01F};
    const Vec3f pushed = push_out(position, contact, 0.1F);
    EXPECT_NEAR(length(tangential(pushed - position, contact.normal)), 0, 1e-6);
}

TEST(PushOut, OfAParticleInsideLeadsToTheMapsPoint) {
    Contact contact;
    contact.normal = {0, 0, 1};
    contact.point = {1, 2, 3};
    contact.inside = true;
    EXPECT_EQ(push_out({0.5F, 1.5F, 2}, contact, 0), contact.point);
}
