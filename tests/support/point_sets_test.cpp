#include "support/point_sets.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

namespace {

const TriangleMesh& torus() {
    static const TriangleMesh mesh = make_torus(1, 0.4, 60, 24);
    return mesh;
}

} // namespace

TEST(PortableRandom, HasTheMomentsAndTailsOfTheNormalDistribution) {
    test::PortableRandom random(1);
    constexpr int kCount = 200'000;
    double sum = 0, squares = 0, fourths = 0;
    int beyond_one = 0, beyond_two = 0;
    for (int i = 0; i < kCount; ++i) {
        const double x = random.normal();
        sum += x;
        squares += x * x;
        fourths += x * x * x * x;
        beyond_one += std::abs(x) > 1;
        beyond_two += std::abs(x) > 2;
    }
    EXPECT_NEAR(sum / kCount, 0, 0.01);
    EXPECT_NEAR(squares / kCount, 1, 0.015);
    EXPECT_NEAR(fourths / kCount, 3, 0.1);
    EXPECT_NEAR(static_cast<double>(beyond_one) / kCount, std::erfc(1 / std::sqrt(2.0)), 0.004);
    EXPECT_NEAR(static_cast<double>(beyond_two) / kCount, std::erfc(2 / std::sqrt(2.0)), 0.002);
}

TEST(PointSets, UniformPointsFillTheBoundingSphereEvenly) {
    const Sphere sphere = inspect(torus()).bounding_sphere;
    const auto points = test::uniform_points(torus(), 50'000);
    int in_half_radius = 0, above = 0;
    for (const Vec3f& p : points) {
        const double r = length(Vec3d(p) - sphere.centre);
        ASSERT_LE(r, sphere.radius * (1 + 1e-6));
        in_half_radius += r < sphere.radius / 2;
        above += p.z > 0;
    }
    EXPECT_NEAR(in_half_radius / 50'000.0, 0.125, 0.006);
    EXPECT_NEAR(above / 50'000.0, 0.5, 0.01);
}

TEST(PointSets, SurfacePointsScatterAboutTheSurfaceOnBothSides) {
    const double radius = inspect(torus()).bounding_sphere.radius;
    const auto points = test::surface_points(torus(), 600);
    double squares = 0;
    int inside = 0;
    for (const Vec3f& p : points) {
        const double distance = unsigned_distance(torus(), Vec3d(p)) / radius;
        squares += distance * distance;
        inside += winding_number(torus(), Vec3d(p)) > 0.5;
    }
    EXPECT_NEAR(std::sqrt(squares / 600), 0.01, 0.001);
    EXPECT_NEAR(inside / 600.0, 0.5, 0.08);
}

TEST(PointSets, SurfacePointsWithoutSpreadLieOnFacesInProportionToTheirArea) {
    const TriangleMesh box = make_box({1, 1, 3});
    const auto points = test::surface_points(box, 20'000, 0);
    int on_ends = 0;
    for (const Vec3f& p : points) {
        ASSERT_LT(unsigned_distance(box, Vec3d(p)), 1e-6);
        on_ends += std::abs(std::abs(p.z) - 1.5F) < 1e-6F;
    }
    EXPECT_NEAR(on_ends / 20'000.0, 2.0 / 14, 0.01);
}

TEST(PointSets, ClothLiesOnTheTopmostSurfaceAndOnTheFloorWhereThereIsNone) {
    const auto points = test::cloth_points(torus(), 100, 80, test::Axis::Z, 0);
    ASSERT_EQ(points.size(), 8'000U);
    for (const Vec3f& p : points) {
        const double rim = std::abs(std::hypot(p.x, p.y) - 1);
        if (rim < 0.38) ASSERT_NEAR(p.z, std::sqrt(0.16 - rim * rim), 0.05);
        if (rim > 0.41) ASSERT_NEAR(p.z, -0.4, 1e-6);
    }
    EXPECT_LT(points[0].x, points[99].x); // row by row
    EXPECT_EQ(points[0].y, points[99].y);
    EXPECT_LT(points[0].y, points[100].y);
}

TEST(PointSets, SmoothingSinksTheClothIntoWhatIsConvexAndKeepsItsVolume) {
    const auto taut = test::cloth_points(torus(), 90, 90, test::Axis::Z, 0);
    const auto smooth = test::cloth_points(torus(), 90, 90, test::Axis::Z, 0.01);
    double difference = 0;
    int sunk = 0, on_crest = 0;
    for (std::size_t i = 0; i < taut.size(); ++i) {
        difference += smooth[i].z - taut[i].z;
        if (std::abs(std::hypot(taut[i].x, taut[i].y) - 1) > 0.1) continue;
        ++on_crest;
        sunk += smooth[i].z < taut[i].z;
    }
    EXPECT_GT(sunk, on_crest * 9 / 10);
    EXPECT_LT(difference, 0); // what leaves by the rim
    EXPECT_GT(difference, -0.005 * static_cast<double>(taut.size()));
}

TEST(PointSets, AreAClothThatCutsInHoweverFewTheyAre) {
    // The share inside and the deviation from the taut cloth, on the flanks of the ring, in R.
    const auto cut_of = [](std::size_t side) {
        const auto taut = test::cloth_points(torus(), side, side, test::Axis::Z, 0);
        const auto smooth = test::cloth_points(torus(), side, side, test::Axis::Z, 0.01);
        double deviation = 0, inside = 0;
        for (std::size_t i = 0; i < taut.size(); ++i) {
            deviation += std::abs(smooth[i].z - taut[i].z);
            inside += winding_number(torus(), Vec3d(smooth[i])) > 0.5 ? 1 : 0;
        }
        const auto count = static_cast<double>(taut.size());
        return std::pair{deviation / count, inside / count};
    };
    const auto [fine_deviation, fine_inside] = cut_of(61);
    const auto [coarse_deviation, coarse_inside] = cut_of(30);
    EXPECT_GT(fine_inside, 0.2);
    EXPECT_NEAR(coarse_inside, fine_inside, 0.06);
    EXPECT_GT(fine_deviation, 0.002);
    EXPECT_NEAR(coarse_deviation, fine_deviation, 0.3 * fine_deviation);
}

TEST(PointSets, AxesAreTakenInCyclicOrder) {
    const TriangleMesh tall = make_box({1, 2, 3}, 2);
    for (const auto& [up, height] :
         {std::pair{test::Axis::X, 0.5F}, {test::Axis::Y, 1.0F}, {test::Axis::Z, 1.5F}})
        for (const Vec3f& p : test::cloth_points(tall, 10, 10, up, 0))
            ASSERT_EQ((std::array{p.x, p.y, p.z}[static_cast<std::size_t>(up)]), height);
}

TEST(PointSets, AreTheSameOnEveryMachine) {
    // In hexadecimal, because every bit counts.
    const TriangleMesh box = make_box({1, 2, 3}, 2);
    EXPECT_EQ(test::uniform_points(box, 1000).back(),
              (Vec3f{0x1.17dfa6p+0F, 0x1.a8346ap-3F, 0x1.3d50b4p+0F}));
    EXPECT_EQ(test::surface_points(box, 1000).back(),
              (Vec3f{0x1.ff0cf4p-2F, -0x1.fb0038p-4F, 0x1.522b76p-1F}));
    EXPECT_EQ(test::cloth_points(torus(), 40, 25, test::Axis::Y, 0.05)[321],
              (Vec3f{-0x1.cac082p-2F, 0x1.c4678ap-3F, -0x1.7ae148p-2F}));
}
