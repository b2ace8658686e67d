#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>

using namespace echinus;

namespace {

using Random = std::mt19937;

std::vector<Vec3f> random_points(Random& random, std::size_t count, const Vec3f& size) {
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < count; ++i)
        points.emplace_back(size.x * unit(random), size.y * unit(random), size.z * unit(random));
    return points;
}

/// Distance from a centre to the farthest point: the radius of the smallest sphere around that centre.
double farthest(const std::vector<Vec3f>& points, const Vec3d& centre) {
    double radius = 0;
    for (const Vec3f& p : points) radius = std::max(radius, length(Vec3d(p) - centre));
    return radius;
}

// The oracle: Cramer's rule in long double over all subsets of two to four points. It shares neither the
// search nor the solver with the function under test.
struct Long {
    long double x, y, z;
};
Long minus(const Vec3f& a, const Vec3f& b) {
    return {(long double)a.x - b.x, (long double)a.y - b.y, (long double)a.z - b.z};
}
long double dot(const Long& a, const Long& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Long cross(const Long& a, const Long& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The point equally far from the origin, a, b and c; not finite when they are coplanar.
Vec3d equidistant(const Long& a, const Long& b, const Long& c) {
    const long double scale = 1 / (2 * dot(a, cross(b, c)));
    const Long bc = cross(b, c);
    const Long ca = cross(c, a);
    const Long ab = cross(a, b);
    const auto along = [&](long double u, long double v, long double w) {
        return static_cast<double>((dot(a, a) * u + dot(b, b) * v + dot(c, c) * w) * scale);
    };
    return {along(bc.x, ca.x, ab.x), along(bc.y, ca.y, ab.y), along(bc.z, ca.z, ab.z)};
}

/// The same for three points, in their plane: a sphere through 0, a and b that is cut in half by it.
Vec3d equidistant(const Long& a, const Long& b) {
    const Long n = cross(a, b);
    const long double scale = 1 / (2 * dot(n, n));
    const Long nb = cross(b, n);
    const Long na = cross(n, a);
    const auto along = [&](long double u, long double v) {
        return static_cast<double>((dot(a, a) * u + dot(b, b) * v) * scale);
    };
    return {along(nb.x, na.x), along(nb.y, na.y), along(nb.z, na.z)};
}

double brute_force_radius(const std::vector<Vec3f>& points) {
    double best = std::numeric_limits<double>::infinity();
    const auto try_centre = [&](const Vec3f& origin, const Vec3d& offset) {
        const Vec3d centre = Vec3d(origin) + offset;
        if (is_finite(centre)) best = std::min(best, farthest(points, centre));
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        try_centre(points[i], {});
        for (std::size_t j = i + 1; j < points.size(); ++j) {
            const Long a = minus(points[j], points[i]);
            try_centre(points[i], Vec3d{double(a.x / 2), double(a.y / 2), double(a.z / 2)});
            for (std::size_t k = j + 1; k < points.size(); ++k) {
                const Long b = minus(points[k], points[i]);
                try_centre(points[i], equidistant(a, b));
                for (std::size_t l = k + 1; l < points.size(); ++l)
                    try_centre(points[i], equidistant(a, b, minus(points[l], points[i])));
            }
        }
    }
    return best;
}

} // namespace

TEST(EnclosingSphere, IsAsSmallAsTheBestOfAllSubsets) {
    Random random(1);
    for (const Vec3f size : {Vec3f{1, 1, 1}, Vec3f{1e9F, 1e9F, 1e9F}, Vec3f{1e-9F, 1e-9F, 1e-9F},
                             Vec3f{1, 1, 1e-6F}, Vec3f{1, 1e-6F, 1e-6F}, Vec3f{1, 1, 0}, Vec3f{1, 0, 0}})
        for (int round = 0; round < 60; ++round) {
            const auto points = random_points(random, 1 + random() % 9, size);
            const double expected = brute_force_radius(points);
            ASSERT_NEAR(smallest_enclosing_sphere(points).radius, expected, 1e-14 * expected);
        }
}

TEST(EnclosingSphere, SurvivesPointsOnALatticeWithDuplicatesAndCospherical) {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        std::vector<Vec3f> points;
        for (unsigned i = 0, count = 2 + random() % 8; i < count; ++i)
            points.emplace_back(float(random() % 3), float(random() % 3), float(random() % 2));
        const double expected = brute_force_radius(points);
        ASSERT_NEAR(smallest_enclosing_sphere(points).radius, expected, 1e-14 * expected);
    }
}

TEST(EnclosingSphere, EnclosesEveryPointAsComputedInDouble) {
    Random random(3);
    for (int round = 0; round < 50; ++round) {
        auto points = random_points(random, 1000, {3, 2, 1});
        for (Vec3f& p : points) p += Vec3f{100, -200, 300};
        const Sphere sphere = smallest_enclosing_sphere(points);
        ASSERT_EQ(farthest(points, sphere.centre), sphere.radius);
    }
}

TEST(EnclosingSphere, CannotShrinkByMovingItsCentre) {
    Random random(4);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const TriangleMesh& mesh :
         {make_torus(1, 0.4, 60, 24), make_sphere(2, 40, 20), make_box({1, 2, 3}, 4)}) {
        const Sphere sphere = smallest_enclosing_sphere(mesh.vertices);
        for (double step : {1e-1, 1e-3, 1e-5})
            for (int i = 0; i < 50; ++i) {
                const Vec3d moved = sphere.centre + Vec3d{unit(random), unit(random), unit(random)} * step;
                ASSERT_GE(farthest(mesh.vertices, moved), sphere.radius * (1 - 1e-15));
            }
    }
}

TEST(EnclosingSphere, IsThatOfTheFormulaForABoxAndASegment) {
    const Sphere box = smallest_enclosing_sphere(make_box({2, 4, 4}, 3).vertices);
    EXPECT_NEAR(box.radius, 3, 1e-15);
    EXPECT_NEAR(length(box.centre), 0, 1e-15);
    const Sphere segment = smallest_enclosing_sphere(std::array{Vec3f{1, 1, 1}, Vec3f{1, 1, 5}});
    EXPECT_EQ(segment.radius, 2);
    EXPECT_EQ(segment.centre, (Vec3d{1, 1, 3}));
}

TEST(EnclosingSphere, OfOnePointOrEqualPointsHasRadiusZero) {
    const std::vector<Vec3f> equal(5, Vec3f{1e9F, -3, 1e-9F});
    for (std::size_t count : {1U, 5U}) {
        const Sphere sphere = smallest_enclosing_sphere(std::span(equal).first(count));
        EXPECT_EQ(sphere.radius, 0);
        EXPECT_EQ(sphere.centre, Vec3d(equal[0]));
    }
}

TEST(EnclosingSphere, OfNoPointsIsAtTheOrigin) {
    const Sphere sphere = smallest_enclosing_sphere({});
    EXPECT_EQ(sphere.radius, 0);
    EXPECT_EQ(sphere.centre, Vec3d{});
}

TEST(EnclosingSphere, HandlesTheLargestAndSmallestFloats) {
    const float huge = std::numeric_limits<float>::max();
    const float tiny = std::numeric_limits<float>::denorm_min();
    for (float size : {huge, tiny}) {
        const std::vector<Vec3f> corners{{-size, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, -size}};
        EXPECT_NEAR(smallest_enclosing_sphere(corners).radius / size, 1, 1e-15);
    }
}

TEST(EnclosingSphere, DoesNotDependOnTheOrderOfPointsBeyondRounding) {
    Random random(5);
    auto points = random_points(random, 300, {1, 1, 1});
    const Sphere first = smallest_enclosing_sphere(points);
    std::shuffle(points.begin(), points.end(), random);
    const Sphere second = smallest_enclosing_sphere(points);
    EXPECT_NEAR(first.radius, second.radius, 1e-15);
    EXPECT_NEAR(length(first.centre - second.centre), 0, 1e-13);
}
