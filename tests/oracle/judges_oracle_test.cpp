#include "judges/exact_judge.hpp"
#include "oracle/test_meshes.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

using namespace echinus;

TEST(JudgesOracle, WindingNumberAgreesWithCgalOnTheSide) {
    for (const auto& [name, mesh] : test::generated_meshes()) {
        const test::ExactJudge judge(mesh);
        for (const auto& points : {test::uniform_points(mesh, 300), test::surface_points(mesh, 300)})
            for (const Vec3f& p : points) {
                if (judge.side(Vec3d(p)) == test::ExactSide::OnSurface) continue;
                ASSERT_NEAR(winding_number(mesh, Vec3d(p)), judge.inside(p) ? 1 : 0, 1e-9) << name;
            }
    }
}

TEST(JudgesOracle, UnsignedDistanceAgreesWithCgal) {
    for (const auto& [name, mesh] : test::generated_meshes()) {
        const test::ExactJudge judge(mesh);
        for (const auto& points : {test::uniform_points(mesh, 300), test::surface_points(mesh, 300)})
            for (const Vec3f& p : points)
                ASSERT_NEAR(unsigned_distance(mesh, Vec3d(p)), judge.distance(Vec3d(p)), 1e-12) << name;
    }
}

TEST(JudgesOracle, RecognisesTheSurface) {
    const test::ExactJudge judge(make_box({2, 2, 2}));
    EXPECT_EQ(judge.side({1, 0.25, 0.5}), test::ExactSide::OnSurface);
    EXPECT_EQ(judge.side({1, 1, 1}), test::ExactSide::OnSurface);
    EXPECT_EQ(judge.side({1 + 1e-15, 0.25, 0.5}), test::ExactSide::Outside);
    EXPECT_EQ(judge.side({1 - 1e-15, 0.25, 0.5}), test::ExactSide::Inside);
}
