// SurfaceCollision, for a solver of one's own. Whether faces meet is judged on the positions alone.

#include "support/expectations.hpp"
#include "support/random_points.hpp"
#include "support/surface_judge.hpp"

#include <echinus/surface_collision.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

using namespace echinus;

namespace {

constexpr double kOwnThickness = 0.01, kOwnSeconds = 1.0 / 60;

/// A solver that knows no collision, and holds a sheet together by a pull of each particle to its neighbours.
struct OwnSheet {
    TriangleMesh mesh;
    std::vector<Vec3f> velocities;

    OwnSheet(std::uint32_t side, double width, const RigidTransform& pose) {
        const Deformable sheet = make_cloth(
            {.column_count = side, .row_count = side, .width = width, .height = width, .pose = pose});
        mesh = {sheet.positions, sheet.faces};
        velocities.resize(sheet.particle_count());
        for (const DistanceConstraint& constraint : sheet.constraints) constraints_.push_back(constraint);
    }
    void move(const Vec3f& acceleration) {
        std::vector<Vec3f>& places = mesh.vertices;
        const std::vector<Vec3f> before = places;
        for (std::size_t i = 0; i < places.size(); ++i)
            places[i] += (velocities[i] + acceleration * float(kOwnSeconds)) * float(kOwnSeconds);
        for (int n = 0; n < 10; ++n)
            for (const DistanceConstraint& constraint : constraints_) {
                const Vec3f across = places[constraint.b] - places[constraint.a];
                const Vec3f half = across * (0.4F * (1 - constraint.rest_length / (length(across) + 1e-9F)));
                places[constraint.a] += half;
                places[constraint.b] -= half;
            }
        for (std::size_t i = 0; i < places.size(); ++i)
            velocities[i] = (places[i] - before[i]) * float(1 / kOwnSeconds);
    }
    std::vector<std::uint32_t> correct(SurfaceCollision& collision) {
        const auto corrected = collision.correct(mesh.vertices, velocities, kOwnSeconds);
        return {corrected.begin(), corrected.end()};
    }

  private:
    std::vector<DistanceConstraint> constraints_;
};

SurfaceCollision collision_of(const OwnSheet& sheet, std::vector<Collider> colliders,
                              const SurfaceCollisionOptions& options = {}) {
    return {sheet.mesh.vertices, sheet.mesh.faces, std::move(colliders), kOwnThickness, options};
}

} // namespace

TEST(SurfaceCollision, LetsNoFaceMeetANeedleOrAnotherFaceWhileTheModelMoves) {
    const TriangleMesh needle = make_box({0.02, 0.02, 1});
    OwnSheet sheet(8, 0.7, {Rotation{}, {0, 0, 0.55}});
    SurfaceCollision collision = collision_of(sheet, {{.map = ExactMap::build(needle)}});
    std::size_t corrected_count = 0;
    for (int n = 0; n < 60; ++n) {
        sheet.move({0, 0, -9.81F});
        collision.set_collider_pose(0, {Rotation::about({1, 0, 0}, 0.005 * n), {0.002 * n, 0, 0}});
        corrected_count += sheet.correct(collision).size();
        ASSERT_EQ(intersecting_pairs(sheet.mesh, test::placed(needle, collision.colliders()[0])).size(), 0u)
            << n;
        ASSERT_EQ(self_intersecting_pairs(sheet.mesh).size(), 0u) << n;
    }
    EXPECT_GT(corrected_count, 60u);
    EXPECT_EQ(collision.unresolved_count(), 0u);
}

TEST(SurfaceCollision, StopsAtAPlateWhatNothingStretches) {
    OwnSheet sheet(4, 0.3, {Rotation{}, {0, 0, 0.3}});
    SurfaceCollision collision =
        collision_of(sheet, {{.map = ExactMap::build(make_box({1, 1, 0.001}))}}, {.friction = 0});
    for (Vec3f& velocity : sheet.velocities) velocity = {1, 0, -20};
    sheet.move({});
    EXPECT_EQ(sheet.correct(collision).size(), 16u);
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_GT(sheet.mesh.vertices[i].z, 0.0005); // contact pushes the harder the nearer
        EXPECT_LT(sheet.mesh.vertices[i].z, 0.0005 + 1.1 * kOwnThickness);
        EXPECT_NEAR(sheet.velocities[i].x, 1, 0.05);
        EXPECT_GT(sheet.velocities[i].z, -0.05);
    }
}

TEST(SurfaceCollision, ThrowsNothingBackThatAFastStepSendsThroughAModel) {
    // Within the step the contact is solved in parts, in the last of which the sheet springs back.
    OwnSheet sheet(10, 0.45, {.rotation = {}, .translation = {0, 0, 0.3}});
    const auto torus = ExactMap::build(make_torus(0.5, 0.2, 60, 24));
    SurfaceCollision collision(sheet.mesh.vertices, sheet.mesh.faces, {{.map = torus}}, 0.02, {});
    for (Vec3f& p : sheet.mesh.vertices) p.z -= 0.5F;
    sheet.velocities.assign(sheet.velocities.size(), {0, 0, -50});
    EXPECT_FALSE(collision.correct(sheet.mesh.vertices, sheet.velocities, 0.01).empty());
    for (const Vec3f& v : sheet.velocities) EXPECT_LT(v.z, 0);
}

TEST(SurfaceCollision, LeavesParticlesAloneThatMeetNothing) {
    OwnSheet sheet(5, 0.3, {Rotation{}, {0, 0, 3}});
    SurfaceCollision collision = collision_of(sheet, {{.map = ExactMap::build(make_box({1, 1, 1}))}});
    for (int n = 0; n < 20; ++n) {
        sheet.move({0, 0, -9.81F});
        const OwnSheet sent = sheet;
        EXPECT_TRUE(sheet.correct(collision).empty());
        EXPECT_EQ(sheet.mesh.vertices, sent.mesh.vertices);
        EXPECT_EQ(sheet.velocities, sent.velocities);
    }
}

TEST(SurfaceCollision, KeepsAParticleThatHasExplodedWhereItWasUntilItIsBack) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 1e20F, 3e38F}) {
        OwnSheet sheet(3, 0.3, {Rotation{}, {0, 0, 0.3}});
        SurfaceCollision collision = collision_of(sheet, {{.map = ExactMap::build(make_box({1, 1, 0.1}))}});
        const Vec3f before = collision.positions()[4];
        sheet.mesh.vertices[4].y = bad;
        EXPECT_TRUE(sheet.correct(collision).empty());
        EXPECT_FALSE(sheet.mesh.vertices[4].y < 1e12F);
        EXPECT_LT(length(collision.positions()[4] - before), 1e-6F);
        sheet.mesh.vertices[4] = {0, 0, 0.28F};
        EXPECT_TRUE(sheet.correct(collision).empty());
    }
}

TEST(SurfaceCollision, GivesTheSameBitsForAnyNumberOfThreadsAndInCopies) {
    const ExactMap torus = ExactMap::build(make_torus(0.4, 0.15, 24, 12));
    const auto run = [&](unsigned thread_count, bool copies) {
        OwnSheet sheet(12, 0.8, {Rotation{}, {0, 0, 0.2}});
        SurfaceCollision collision = collision_of(sheet, {{.map = torus}}, {.thread_count = thread_count});
        for (int n = 0; n < 10; ++n) {
            sheet.move({0, 0, -30});
            if (copies) collision = SurfaceCollision(std::as_const(collision));
            sheet.correct(collision);
        }
        return std::pair(sheet.mesh.vertices, sheet.velocities);
    };
    const auto alone = run(1, false);
    EXPECT_EQ(run(2, false), alone);
    EXPECT_EQ(run(1, true), alone);
}

TEST(SurfaceCollision, RefusesWhatItCannotWorkWithOrPartsItIfItMay) {
    const ExactMap plate = ExactMap::build(make_box({2, 2, 0.1}, 4));
    const std::vector<Vec3f> cut{{-0.3F, -0.3F, 0.03F}, {0.3F, -0.3F, 0.12F}, {0, 0.3F, 0.12F}};
    const std::vector<Triangle> face{{0, 1, 2}};
    const auto refuse = [](const std::string& words, const auto& call) {
        test::expect_error(ErrorCode::InvalidOptions, words, call);
    };
    refuse("untangle", [&] { SurfaceCollision(cut, face, {{.map = plate}}, kOwnThickness); });
    SurfaceCollision collision(cut, face, {{.map = plate}}, kOwnThickness, {.untangle = true});
    EXPECT_GT(collision.positions()[0].z, 0.05F);
    refuse("faces", [&] { SurfaceCollision(cut, {}, {{.map = plate}}, kOwnThickness); });
    refuse("thickness", [&] { SurfaceCollision(cut, face, {{.map = plate}}, -1); });
    refuse("friction", [&] { SurfaceCollision(cut, face, {{.map = plate}}, 0.01, {.friction = -1}); });
    std::vector<Vec3f> positions = collision.positions(), velocities(2);
    refuse("takes 0 seconds", [&] { collision.correct(positions, {}, 0); });
    refuse("2 velocities; it needs 3", [&] { collision.correct(positions, velocities, kOwnSeconds); });
}
