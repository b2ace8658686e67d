#include "rivals/dense_grid/dense_grid.hpp"
#include "support/expectations.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace echinus;
using rivals::DenseGrid;
using rivals::DenseGridOptions;
using rivals::SampleFormat;
using test::expect_error;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

DenseGridOptions in(SampleFormat format) {
    DenseGridOptions options;
    options.format = format;
    return options;
}

constexpr SampleFormat kFormats[] = {SampleFormat::Float32, SampleFormat::Snorm16};

std::vector<Vec3f> points_in_cube(std::size_t count, float half_width) {
    test::Random random(3);
    std::vector<Vec3f> points(count);
    for (Vec3f& p : points) p = test::in_cube(random, half_width);
    return points;
}

/// Inside, outside, on the border of the box, and not finite.
std::vector<Vec3f> all_kinds_of_points() {
    std::vector<Vec3f> points = points_in_cube(1000, 1.3F);
    for (const float v : {-1.0F, 1.0F, 0.0F, -0.0F}) points.push_back({v, v, v});
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        points.push_back({bad, 0, 0});
        points.push_back({0, bad, 0});
        points.push_back({0, 0, bad});
    }
    return points;
}

float signed_distance(const ExactMap& map, const Vec3f& point) {
    return -contact(map, point, 100).depth;
}

} // namespace

TEST(DenseGrid, OfASphereIsWithinTheSecondOrderBoundOfItsFormula) {
    const TriangleMesh mesh = make_sphere(1, 96, 48);
    // How far the middle of a face lies below the sphere: its corners are at most this far from its middle.
    const double corner = 2 * std::sin(3.15 / 96), flattening = 1 - std::sqrt(1 - corner * corner);
    for (const SampleFormat format : kFormats) {
        const DenseGrid grid = DenseGrid::with_samples(mesh, 31, in(format));
        const double h = grid.spacing();
        for (const Vec3f& p : points_in_cube(3000, 0.99F)) {
            const double radius = length(Vec3d(p)), nearest = radius - 2 * h;
            if (nearest < 0.2) continue; // the formula's second derivatives, 2 / radius, grow without bound
            const double interpolation = h * h / 8 * (2 / nearest);
            ASSERT_NEAR(grid.sample(p).distance, radius - 1,
                        interpolation + flattening + 2 * grid.sample_error_bound());
        }
    }
}

TEST(DenseGrid, OfASphereHasAGradientThatPointsAwayFromItsCentre) {
    const TriangleMesh mesh = make_sphere(1, 96, 48);
    for (const SampleFormat format : kFormats) {
        const DenseGrid grid = DenseGrid::with_samples(mesh, 31, in(format));
        for (const Vec3f& p : points_in_cube(3000, 0.99F)) {
            const float radius = length(p);
            if (radius < 0.3F) continue;
            const Vec3f gradient = grid.sample(p).gradient;
            // The gradient turns by the curvature, 1 / radius, and is a mean over a cell.
            const double h = grid.spacing();
            ASSERT_NEAR(length(gradient), 1, h / (radius - 2 * h));
            ASSERT_GT(dot(gradient, p) / (length(gradient) * radius), 0.99F)
                << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
}

TEST(DenseGrid, OfABoxIsExactWhereOneSideIsNearest) {
    const DenseGrid grid = DenseGrid::with_samples(make_box({2, 2, 2}), 21);
    test::Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const float depth = test::uniform(random, 0.02F, 0.4F);
        const Vec3f p{1 - depth, test::uniform(random, -0.4F, 0.4F), test::uniform(random, -0.4F, 0.4F)};
        const auto [distance, gradient] = grid.sample(p);
        ASSERT_NEAR(distance, -depth, 1e-5);
        ASSERT_LT(length(gradient - Vec3f{1, 0, 0}), 1e-4F);
    }
}

TEST(DenseGrid, ErrsNowhereByMoreThanItsBound) {
    const TriangleMesh mesh = make_torus(0.7, 0.3, 24, 12);
    const ExactMap exact = ExactMap::build(mesh);
    for (const SampleFormat format : kFormats)
        for (const std::uint32_t sample_count : {2U, 5U, 17U, 40U}) {
            const DenseGrid grid = DenseGrid::with_samples(mesh, sample_count, in(format));
            double worst = 0;
            for (Vec3f p : points_in_cube(1000, 1)) {
                p.z *= 0.3F;
                const auto [distance, gradient] = grid.sample(p);
                if (gradient == Vec3f{}) continue; // beyond the box, which is a little smaller
                worst = std::max(worst, std::abs(double{distance} - signed_distance(exact, p)));
            }
            EXPECT_LE(worst, grid.value_error_bound()) << sample_count;
            EXPECT_GT(worst, 0) << "nothing was compared";
        }
}

TEST(DenseGrid, SamplesTheExactDistanceAtItsNodes) {
    const TriangleMesh mesh = make_box({2, 1, 0.5}, 2);
    const ExactMap exact = ExactMap::build(mesh);
    for (const SampleFormat format : kFormats) {
        const DenseGrid grid = DenseGrid::with_samples(mesh, 17, in(format));
        EXPECT_EQ(grid.spacing(), 0.125);
        for (std::size_t z = 0; z < grid.node_count(2); ++z)
            for (std::size_t y = 0; y < grid.node_count(1); ++y)
                for (std::size_t x = 0; x < grid.node_count(0); ++x) {
                    const Vec3f node(Vec3d(-1, -0.5, -0.25) + Vec3d(x, y, z) * 0.125);
                    ASSERT_NEAR(grid.sample(node).distance, signed_distance(exact, node),
                                grid.sample_error_bound());
                }
    }
}

TEST(DenseGrid, BatchesGiveTheBitsOfSingleQueriesUnderEachInstructionSet) {
    const TriangleMesh mesh = make_torus(0.7, 0.3, 24, 12);
    const std::vector<Vec3f> points = all_kinds_of_points();
    for (const SampleFormat format : kFormats) {
        const DenseGrid grid = DenseGrid::with_samples(mesh, 30, in(format));
        test::under_each_instruction_set([&](std::string_view set) {
            for (const std::size_t count : {points.size(), std::size_t{1}, std::size_t{7}, std::size_t{0}}) {
                const auto some = std::span(points).last(count);
                std::vector<std::uint8_t> inside(count, 2);
                std::vector<Contact> contacts(count);
                grid.contains_batch(some, inside);
                grid.contacts_batch(some, contacts);
                for (std::size_t i = 0; i < count; ++i) {
                    const auto [distance, gradient] = grid.sample(some[i]);
                    ASSERT_EQ(inside[i], distance < 0) << set << ' ' << i;
                    ASSERT_EQ(contacts[i].inside, distance < 0) << set << ' ' << i;
                    ASSERT_EQ(contacts[i].depth, distance < 0 ? -distance : 0) << set << ' ' << i;
                    if (distance >= 0) continue;
                    ASSERT_NEAR(length(contacts[i].normal), 1, 1e-5) << set << ' ' << i;
                    ASSERT_LT(length(contacts[i].normal * length(gradient) - gradient), 1e-5F);
                    ASSERT_EQ(contacts[i].point, some[i] + contacts[i].normal * contacts[i].depth);
                }
            }
        });
    }
}

TEST(DenseGrid, HasAsManySamplesAlongTheLongestSideAsAskedFor) {
    for (const std::uint32_t sample_count : {2U, 3U, 10U, 50U}) {
        const DenseGrid grid = DenseGrid::with_samples(make_box({0.3, 0.7, 0.1}), sample_count);
        EXPECT_EQ(grid.node_count(1), sample_count);
        EXPECT_LE(grid.node_count(0), sample_count);
        EXPECT_GE(grid.node_count(2), 2);
    }
}

TEST(DenseGrid, DoesNotDependOnTheNumberOfThreads) {
    const TriangleMesh mesh = make_torus(0.7, 0.3, 24, 12);
    DenseGridOptions many;
    many.thread_count = 4;
    const DenseGrid one = DenseGrid::with_samples(mesh, 60), four = DenseGrid::with_samples(mesh, 60, many);
    for (const Vec3f& p : points_in_cube(2000, 1)) ASSERT_EQ(one.sample(p).distance, four.sample(p).distance);
}

TEST(DenseGrid, SeesTheMeshFromBesideItsBoxWhenPadded) {
    const TriangleMesh mesh = make_box({2, 2, 2});
    DenseGridOptions padded;
    padded.padding = 0.25;
    const std::vector<Vec3f> points{{0.1F, 0.2F, 1.1F}, {-1.2F, 0.3F, 0.1F}, {0, 1.3F, 0}};
    std::vector<Contact> contacts(points.size());
    DenseGrid::with_samples(mesh, 26).contacts_batch(points, 0.5F, contacts);
    for (const Contact& contact : contacts) EXPECT_FALSE(contact.found());
    DenseGrid::with_samples(mesh, 26, padded).contacts_batch(points, 0.5F, contacts);
    EXPECT_NEAR(contacts[0].depth, -0.1, 1e-3);
    EXPECT_NEAR(contacts[1].depth, -0.2, 1e-3);
    EXPECT_GT(contacts[0].normal.z, 0.999F);
    EXPECT_LT(contacts[1].normal.x, -0.999F);
    EXPECT_FALSE(contacts[2].found()); // beyond the padding
}

TEST(DenseGrid, RefusesPaddingThatIsNone) {
    for (const double padding : {-0.1, 1.1, double{kNan}, double{kInfinity}}) {
        DenseGridOptions options;
        options.padding = padding;
        expect_error(ErrorCode::InvalidOptions, "padding", [&] {
            DenseGrid::with_samples(make_box({1, 1, 1}), 10, options);
        });
    }
}

TEST(DenseGrid, RefusesSizesThatNoGridHas) {
    const TriangleMesh mesh = make_box({1, 1, 1});
    for (const std::uint32_t count : {0U, 1U, DenseGrid::kMaxSamples + 1})
        expect_error(ErrorCode::InvalidOptions, std::to_string(count),
                     [&] { DenseGrid::with_samples(mesh, count); });
    expect_error(ErrorCode::InvalidOptions, "nodes", [&] { DenseGrid::with_samples(mesh, 2000); });
    expect_error(ErrorCode::InvalidOptions, "32 to", [&] { DenseGrid::with_bytes(mesh, 31); });
    EXPECT_EQ(DenseGrid::with_bytes(mesh, 32).byte_count(), 32);
    EXPECT_EQ(DenseGrid::with_bytes(mesh, 16, in(SampleFormat::Snorm16)).byte_count(), 16);
    expect_error(ErrorCode::InvalidOptions, "budget",
                 [&] { DenseGrid::with_bytes(mesh, std::numeric_limits<std::size_t>::max()); });
    for (const double spacing : {0.0, -1.0, 1.5, double{kNan}, double{kInfinity}, 1e-9})
        EXPECT_THROW(DenseGrid::with_spacing(mesh, spacing), Error) << spacing;
}

TEST(DenseGrid, MayBeAsSmallOrAsLargeAsAMap) {
    for (const float scale : {1e-14F, 1e14F}) {
        TriangleMesh mesh = make_sphere(1, 32, 16);
        for (Vec3f& v : mesh.vertices) v *= scale;
        for (const SampleFormat format : kFormats) {
            const DenseGrid grid = DenseGrid::with_samples(mesh, 20, in(format));
            std::vector<Vec3f> points{{0.5F * scale, 0, 0}, {0, 0.7F * scale, 0.69F * scale}};
            std::vector<Contact> contacts(2);
            grid.contacts_batch(points, contacts);
            EXPECT_NEAR(contacts[0].depth / scale, 0.5, 0.02);
            EXPECT_GT(contacts[0].normal.x, 0.99F);
            EXPECT_TRUE(contacts[1].inside);
        }
    }
}
