#include "rivals/superquadric_map/fit.hpp"
#include "rivals/superquadric_map/superquadric.hpp"
#include "support/expectations.hpp"
#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace echinus;
using namespace echinus::rivals;
using test::PortableRandom;

namespace {

constexpr double kPiDouble = std::numbers::pi;

Superquadric superquadric(const Vec3d& sizes, double eta_exponent, double omega_exponent) {
    Superquadric shape;
    shape.sizes = sizes;
    shape.eta_exponent = eta_exponent;
    shape.omega_exponent = omega_exponent;
    return shape;
}

Superquadric posed(Superquadric shape, const Rotation& rotation, const Vec3d& centre) {
    shape.rotation = rotation;
    shape.centre = centre;
    return shape;
}

std::vector<Rotation> rotations() {
    return {{}, Rotation::about({1, 2, 3}, 0.7), Rotation::about({-1, 0.2, 0.4}, 2.3)};
}

/// Points of the surface, where uniform angles have them.
std::vector<Vec3d> samples(const Superquadric& shape, std::size_t rows = 24, std::size_t columns = 48) {
    std::vector<Vec3d> points;
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < columns; ++column)
            points.push_back(shape.from_frame(shape.surface_point(
                {kPiDouble * (static_cast<double>(row) + 0.5) / static_cast<double>(rows) - kPiDouble / 2,
                 2 * kPiDouble * (static_cast<double>(column) + 0.25) / static_cast<double>(columns)})));
    return points;
}

/// How far one surface is from the other, along rays, in parts of the smallest size.
double surface_difference(const Superquadric& fitted, const Superquadric& truth) {
    double largest = 0;
    for (const Vec3d& p : samples(truth, 60, 120))
        largest = std::max(largest, std::fabs(fitted.radial_distance(p)));
    for (const Vec3d& p : samples(fitted, 60, 120))
        largest = std::max(largest, std::fabs(truth.radial_distance(p)));
    return largest / std::min({truth.sizes.x, truth.sizes.y, truth.sizes.z});
}

void expect_within_one_percent(double value, double truth, const char* what) {
    EXPECT_NEAR(value, truth, 0.01 * truth) << what;
}

struct Exponents {
    double eta, omega;
};
/// Boxes, cylinders, ellipsoids, and what is between them and double pyramids.
constexpr Exponents kExponents[] = {{0.2, 0.2}, {0.2, 1},   {1, 0.2},   {0.5, 0.9},
                                    {0.8, 0.5}, {1.3, 0.7}, {0.6, 1.5}, {1.6, 1.4}};

double beta(double a, double b) {
    return std::exp(std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b));
}

} // namespace

TEST(Superquadric, HasItsSurfaceWhereItsInsideOutsideFunctionIsOne) {
    for (const Exponents& e : kExponents) {
        const Superquadric shape = posed(superquadric({3, 2, 1}, e.eta, e.omega), rotations()[1], {4, 5, 6});
        for (const Vec3d& p : samples(shape)) {
            EXPECT_NEAR(shape.log_inside_outside(shape.to_frame(p)), 0, 1e-9);
            EXPECT_NEAR(shape.radial_distance(p), 0, 1e-9);
            EXPECT_NEAR(shape.radial_distance(shape.centre + (p - shape.centre) * 1.5),
                        length(p - shape.centre) / 2, 1e-9);
        }
    }
}

TEST(Superquadric, FindsTheAnglesOfEveryPlaceOnARay) {
    for (const Exponents& e : kExponents) {
        const Superquadric shape = superquadric({3, 2, 1}, e.eta, e.omega);
        for (double eta = -1.5; eta < 1.6; eta += 0.25)
            for (double omega = -3.1; omega < 3.1; omega += 0.25)
                for (const double share : {1e-6, 0.5, 1.0, 30.0}) {
                    const SuperquadricAngles found =
                        shape.angles_of(shape.surface_point({eta, omega}) * share);
                    EXPECT_NEAR(found.eta, eta, 1e-7);
                    EXPECT_NEAR(found.omega, omega, 1e-7);
                }
    }
}

TEST(Superquadric, StaysFiniteFarAwayAndAtTheCentre) {
    const Superquadric box = superquadric({1, 1, 1}, 0.1, 0.1);
    EXPECT_NEAR(box.radial_distance({1e30, 0, 0}) / 1e30, 1, 1e-9);
    EXPECT_NEAR(box.radial_distance({1e-30, 0, 0}), -1, 1e-9);
    EXPECT_EQ(box.log_inside_outside({0, 0, 0}), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(box.angles_of({0, 0, 0}).eta, 0);
    EXPECT_EQ(box.angles_of({0, 0, 0}).omega, 0);
}

TEST(Superquadric, HasTrianglesThatEncloseTheVolumeOfTheFormula) {
    // 2 a1 a2 a3 e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2): Jaklic, Leonardis and Solina, "Segmentation and
    // Recovery of Superquadrics" (2000), section 2.4.
    for (const Exponents& e : kExponents) {
        const Superquadric shape = posed(superquadric({3, 2, 1}, e.eta, e.omega), rotations()[2], {1, 2, 3});
        const MeshReport report = inspect(tessellate(shape, 100, 200));
        const double volume =
            12 * e.eta * e.omega * beta(e.eta / 2 + 1, e.eta) * beta(e.omega / 2, e.omega / 2);
        EXPECT_TRUE(report.closed);
        EXPECT_NEAR(report.signed_volume, volume, 0.01 * volume) << e.eta << " " << e.omega;
    }
}

TEST(SuperquadricFit, HasTheDerivativesOfItsResiduals) {
    PortableRandom random(1);
    std::vector<Vec3d> points;
    for (int i = 0; i < 60; ++i)
        points.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const FitResiduals residuals(points);
    const auto count = static_cast<Eigen::Index>(points.size());
    for (const Exponents& e : kExponents) {
        const Superquadric shape =
            posed(superquadric({0.9, 0.5, 0.7}, e.eta, e.omega), rotations()[1], {0.1, 0.2, -0.1});
        Eigen::VectorXd parameters = FitParameters::of(shape);
        parameters.tail(4) *= 1.3; // a quaternion of another length stands for the same rotation
        Eigen::MatrixXd jacobian(count, FitParameters::kCount);
        residuals.df(parameters, jacobian);
        for (Eigen::Index k = 0; k < FitParameters::kCount; ++k) {
            constexpr double kStep = 1e-6;
            Eigen::VectorXd above = parameters, below = parameters;
            above[k] += kStep;
            below[k] -= kStep;
            Eigen::VectorXd residuals_above(count), residuals_below(count);
            residuals(above, residuals_above);
            residuals(below, residuals_below);
            const Eigen::VectorXd slopes = (residuals_above - residuals_below) / (2 * kStep);
            EXPECT_LT((slopes - jacobian.col(k)).cwiseAbs().maxCoeff(),
                      1e-5 * (1 + slopes.cwiseAbs().maxCoeff()))
                << "parameter " << k << ", exponents " << e.eta << " " << e.omega;
        }
    }
}

TEST(SuperquadricFit, RecoversASuperquadricFromItsOwnSamplesWithinOnePercent) {
    for (const Exponents& e : kExponents)
        for (const Rotation& rotation : rotations()) {
            // Three different sizes and two different exponents leave one description, but for x and y
            // exchanged.
            const Superquadric truth =
                posed(superquadric({3, 2, 1.2}, e.eta, e.omega), rotation, {10, -20, 5});
            const SuperquadricFit fit = fit_superquadric(samples(truth));
            SCOPED_TRACE(testing::Message() << "exponents " << e.eta << " " << e.omega);
            EXPECT_LT(surface_difference(fit.shape, truth), 0.01);
            EXPECT_LT(length(fit.shape.centre - truth.centre), 0.01);
            if (e.eta == e.omega) continue; // any axis may be z
            expect_within_one_percent(std::max(fit.shape.sizes.x, fit.shape.sizes.y), 3, "a1");
            expect_within_one_percent(std::min(fit.shape.sizes.x, fit.shape.sizes.y), 2, "a2");
            expect_within_one_percent(fit.shape.sizes.z, 1.2, "a3");
            expect_within_one_percent(fit.shape.eta_exponent, e.eta, "e1");
            expect_within_one_percent(fit.shape.omega_exponent, e.omega, "e2");
        }
}

TEST(SuperquadricFit, RecoversTheSurfaceWhereAxesAreAmbiguous) {
    const Superquadric shapes[] = {
        superquadric({1, 1, 1}, 1, 1),     // a sphere
        superquadric({2, 2, 1}, 1, 1),     // an ellipsoid of revolution
        superquadric({1, 2, 3}, 1, 1),     // an ellipsoid: any axis may be z
        superquadric({1, 1, 1}, 0.2, 0.2), // a cube
        superquadric({1, 1, 3}, 0.2, 0.2), // a square bar: turned by 45 degrees it is a diamond
        superquadric({1, 1, 3}, 0.2, 1),   // a cylinder
        superquadric({1, 1, 0.2}, 0.3, 1), // a disc
        superquadric({2, 2, 2}, 1.8, 1),   // a double cone
        superquadric({1, 1, 1}, 1.7, 1.7), // an octahedron, rounded
    };
    for (const Superquadric& shape : shapes)
        for (const Rotation& rotation : rotations()) {
            const Superquadric truth = posed(shape, rotation, {-3, 1, 2});
            const SuperquadricFit fit = fit_superquadric(samples(truth));
            EXPECT_LT(surface_difference(fit.shape, truth), 0.01)
                << "sizes " << shape.sizes.x << " " << shape.sizes.y << " " << shape.sizes.z << ", exponents "
                << shape.eta_exponent << " " << shape.omega_exponent;
        }
}

TEST(SuperquadricFit, SaysHowFarThePointsAreFromTheSurface) {
    // The points of two concentric spheres, as many of each: the sphere half-way is 0.1 from all of them.
    std::vector<Vec3d> points = samples(superquadric({0.9, 0.9, 0.9}, 1, 1));
    const std::vector<Vec3d> outer = samples(superquadric({1.1, 1.1, 1.1}, 1, 1));
    for (std::size_t i = 0; i < points.size(); i += 2) points[i] = outer[i];
    const SuperquadricFit fit = fit_superquadric(points);
    EXPECT_NEAR(fit.mean, 0.1, 1e-3);
    EXPECT_NEAR(fit.root_mean_square, 0.1, 1e-3);
    EXPECT_NEAR(fit.largest, 0.1, 0.01);
}

TEST(SuperquadricFit, GivesTheSameFitInEveryUnit) {
    const Superquadric truth = posed(superquadric({3, 2, 1.2}, 0.4, 0.8), rotations()[1], {1, 2, 3});
    for (const double unit : {1e-12, 1e12}) {
        std::vector<Vec3d> points = samples(truth);
        for (Vec3d& p : points) p *= unit;
        const SuperquadricFit fit = fit_superquadric(points);
        expect_within_one_percent(fit.shape.sizes.z / unit, 1.2, "a3");
        expect_within_one_percent(fit.shape.eta_exponent, 0.4, "e1");
    }
}

TEST(SuperquadricFit, TakesFlatAndLinearPointsForVeryThinSolids) {
    std::vector<Vec3d> flat, line;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j) {
            flat.emplace_back(0.1 * i, 0.1 * j, 0);
            line.emplace_back(0.1 * i + 0.005 * j, 0, 0);
        }
    for (const std::vector<Vec3d>& points : {flat, line}) {
        const Superquadric shape = fit_superquadric(points).shape;
        EXPECT_TRUE(is_finite(shape.centre) && is_finite(shape.sizes));
        EXPECT_GT(std::min({shape.sizes.x, shape.sizes.y, shape.sizes.z}), 0);
        EXPECT_GE(shape.eta_exponent, Superquadric::kMinExponent);
        EXPECT_LE(shape.eta_exponent, Superquadric::kMaxExponent);
    }
}

TEST(SuperquadricFit, RefusesPointsThatDetermineNothing) {
    const auto refuses = [](const char* words, const std::vector<Vec3d>& points) {
        test::expect_error(ErrorCode::InvalidMesh, words, [&] { (void)fit_superquadric(points); });
    };
    std::vector<Vec3d> points = samples(superquadric({1, 1, 1}, 1, 1));
    points[7].y = std::numeric_limits<double>::quiet_NaN();
    refuses("point 7", points);
    refuses("12 points", {});
    refuses("12 points", std::vector<Vec3d>(points.begin() + 20, points.begin() + 31));
    refuses("one and the same", std::vector<Vec3d>(50, Vec3d{1, 2, 3}));
}
