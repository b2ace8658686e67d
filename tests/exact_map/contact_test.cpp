#include "exact_map/query/stretched_contact.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

TEST(ExactMapContact, FindsTheNearestPointOfTheWholeSurface) {
    test::Random random(1);
    for (const TriangleMesh& mesh :
         {make_torus(1, 0.4, 40, 16), make_box({2, 1, 0.25}, 3), make_sphere(1, 20, 10)}) {
        const ExactMap map = ExactMap::build(mesh);
        const float radius = map.view().radius;
        for (int n = 0; n < 2000; ++n) {
            const Vec3f p = test::in_sphere(random, radius);
            const double expected = unsigned_distance(mesh, Vec3d(p));
            const Contact c = contact(map, p, 10 * radius);
            ASSERT_TRUE(c.found());
            ASSERT_EQ(c.inside, contains(map, p));
            ASSERT_NEAR(c.depth, c.inside ? expected : -expected, 1e-5 * radius);
            ASSERT_NEAR(length(p + c.normal * c.depth - c.point), 0, 1e-5F * radius);
            ASSERT_NEAR(unsigned_distance(mesh, Vec3d(c.point)), 0, 1e-5 * radius);
            ASSERT_LT(static_cast<std::size_t>(c.face), mesh.faces.size());
        }
    }
}

TEST(ExactMapContact, IsExactAtTheCentreOfABall) {
    const ExactMap map = ExactMap::build(make_sphere(1, 100, 50));
    const Contact c = contact(map, {0, 0, 0});
    EXPECT_TRUE(c.inside);
    EXPECT_NEAR(c.depth, unsigned_distance(make_sphere(1, 100, 50), {}), 1e-5);
}

TEST(ExactMapContact, EndsAtTheMargin) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    const Vec3f p{0.25F, 0.5F, 1.1F};
    EXPECT_FALSE(contact(map, p).found());
    EXPECT_FALSE(contact(map, p, 0.0999F).found());
    const Contact c = contact(map, p, 0.1001F);
    EXPECT_TRUE(c.found());
    EXPECT_FALSE(c.inside);
    EXPECT_NEAR(c.depth, -0.1F, 1e-5F);
    EXPECT_EQ(contact(map, p, std::nanf("")).point, p);
}

TEST(ExactMapContact, HasThePseudonormalOnTheSurface) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    const auto normal = [&](const Vec3f& p) { return contact(map, p, 1e-3F).normal; };
    const float half = std::sqrt(0.5F);
    const float third = std::sqrt(1.0F / 3);
    EXPECT_NEAR(length(normal({0.3F, 0.2F, 1}) - Vec3f{0, 0, 1}), 0, 1e-4F);
    EXPECT_NEAR(length(normal({0.3F, 1, 1}) - Vec3f{0, half, half}), 0, 1e-4F);
    EXPECT_NEAR(length(normal({1, -1, 1}) - Vec3f{third, -third, third}), 0, 1e-4F);
}

TEST(ExactMapContact, FindsANeedleThatIsThinnerThanTheLattice) {
    const TriangleMesh needle = make_box({1, 1e-7, 1e-7});
    const TriangleMesh mesh = test::joined({make_box({1, 1, 1}, 2), test::translated(needle, {1.5F, 0, 0})});
    const ExactMap map = ExactMap::build(mesh);
    EXPECT_EQ(map.statistics().dropped_faces, needle.faces.size());
    for (const Vec3f& p : {Vec3f{1.5F, 0.1F, 0}, Vec3f{2.2F, 0, 0.1F}, Vec3f{1.9F, -0.01F, 0.01F}}) {
        const Contact c = contact(map, p, 1);
        EXPECT_FALSE(c.inside);
        EXPECT_NEAR(-c.depth, unsigned_distance(mesh, Vec3d(p)), 1e-5);
    }
}

TEST(ExactMapContact, HasANormalOutOfTheSolidWhicheverWayTheFacesAreTurned) {
    const ExactMap map = ExactMap::build(test::turned_inside_out(make_box({2, 2, 2})));
    for (float x : {0.9F, 0.999999F, 1.0F, 1.000001F, 1.05F})
        EXPECT_NEAR(length(contact(map, {x, 0.2F, 0.1F}, 0.1F).normal - Vec3f{1, 0, 0}), 0, 1e-4F) << x;
    const SweepHit in = sweep(map, {1.5F, 0.2F, 0.1F}, {0.5F, 0.2F, 0.1F});
    EXPECT_TRUE(in.entering);
    EXPECT_EQ(in.normal, (Vec3f{1, 0, 0}));
    const SweepHit out = sweep(map, {0.5F, 0.2F, 0.1F}, {1.5F, 0.2F, 0.1F});
    EXPECT_FALSE(out.entering);
    EXPECT_EQ(out.normal, (Vec3f{1, 0, 0}));
}

TEST(ExactMapContact, HasTheNormalOfTheNearestFaceOnAPlateWithoutThickness) {
    TriangleMesh plate{{{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}},
                       {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}}};
    const ExactMap map = ExactMap::build(plate);
    EXPECT_EQ(std::fabs(contact(map, {1e-6F, 0.1F, 0.2F}, 0.1F).normal.x), 1);
}

TEST(ExactMapContact, LeadsOutOfAWorldThatIsStretchedOutOfShape) {
    const ExactMap map = ExactMap::build(make_box({1, 1, 1}));
    const Contact c = stretched_contact(map, {0.1F, 0.2F, -0.4F}, 0, {1, 1, 1e-7});
    EXPECT_NEAR(c.point.z, -0.5F, 1e-4F);
    EXPECT_NEAR(c.normal.z, -1, 1e-4F);
}
