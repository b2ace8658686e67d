#include "rivals/sparse_field/sparse_field.hpp"
#include "support/expectations.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace echinus;
using rivals::SparseField;
using test::expect_error;

namespace {

std::vector<Contact> contacts_of(const SparseField& field, const std::vector<Vec3f>& points) {
    std::vector<Contact> contacts(points.size());
    field.contacts_batch(points, contacts);
    return contacts;
}

} // namespace

TEST(SparseField, OfASphereIsWithinTheSecondOrderBoundOfItsFormula) {
    const SparseField field = SparseField::with_samples(make_sphere(1, 96, 48), 41);
    const double corner = 2 * std::sin(3.15 / 96), flattening = 1 - std::sqrt(1 - corner * corner);
    const double h = field.spacing();
    test::Random random(3);
    std::vector<Vec3f> points;
    while (points.size() < 2000) {
        const Vec3f p = test::in_sphere(random, 0.98F);
        if (length(p) > 0.3F) points.push_back(p);
    }
    const std::vector<Contact> contacts = contacts_of(field, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double radius = length(Vec3d(points[i]));
        const double interpolation = h * h / 8 * (2 / (radius - 2 * h));
        ASSERT_NEAR(contacts[i].depth, 1 - radius, interpolation + flattening + 1e-4) << i;
        ASSERT_GT(dot(contacts[i].normal, points[i]) / radius, 0.99) << i;
    }
}

TEST(SparseField, OfABoxIsExactWhereOneSideIsNearest) {
    const SparseField field = SparseField::with_samples(make_box({2, 2, 2}), 21);
    test::Random random(4);
    std::vector<Vec3f> points;
    for (int i = 0; i < 1000; ++i) {
        const float x = 1 - test::uniform(random, 0.02F, 0.4F);
        points.push_back({x, test::uniform(random, -0.4F, 0.4F), test::uniform(random, -0.4F, 0.4F)});
    }
    const std::vector<Contact> contacts = contacts_of(field, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_NEAR(contacts[i].depth, 1 - points[i].x, 1e-4);
        ASSERT_LT(length(contacts[i].normal - Vec3f{1, 0, 0}), 1e-3F);
        ASSERT_NEAR(contacts[i].point.x, 1, 1e-3);
    }
}

TEST(SparseField, ErrsNowhereByMoreThanTheBoundOfInterpolation) {
    const TriangleMesh mesh = make_torus(0.7, 0.3, 24, 12);
    const ExactMap exact = ExactMap::build(mesh);
    test::Random random(5);
    std::vector<Vec3f> points;
    while (points.size() < 1000) {
        const Vec3f p = test::in_sphere(random, 1);
        if (contains(exact, p)) points.push_back(p);
    }
    for (const std::uint32_t sample_count : {10U, 20U, 40U}) {
        const SparseField field = SparseField::with_samples(mesh, sample_count);
        const double bound = 0.8661 * field.spacing();
        const std::vector<Contact> contacts = contacts_of(field, points);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_NEAR(contacts[i].depth, contact(exact, points[i]).depth, bound) << sample_count;
    }
}

TEST(SparseField, TellsTheSameSideByContainsAndByContacts) {
    const SparseField field = SparseField::with_samples(make_torus(0.7, 0.3, 24, 12), 30);
    test::Random random(6);
    std::vector<Vec3f> points(3000);
    for (Vec3f& p : points) p = test::in_cube(random, 1.2F);
    std::vector<std::uint8_t> inside(points.size(), 2);
    field.contains_batch(points, inside);
    const std::vector<Contact> contacts = contacts_of(field, points);
    // The two round differently, one in double and one in single precision.
    for (std::size_t i = 0; i < points.size(); ++i)
        if (contacts[i].depth > 1e-5F) {
            ASSERT_EQ(inside[i], 1) << i;
        } else if (contacts[i].depth == 0 && inside[i] == 1) {
            ASSERT_NEAR(length(Vec3d(points[i])), 0.7, 0.31) << "is not even near the tube";
        }
}

TEST(SparseField, TakesNoNoticeOfWhereTheMeshLies) {
    for (const Vec3f& centre : {Vec3f{0, 0, 0}, Vec3f{-100, 50, 7}}) {
        TriangleMesh mesh = make_box({2, 2, 2});
        for (Vec3f& v : mesh.vertices) v += centre;
        const SparseField field = SparseField::with_samples(mesh, 21);
        EXPECT_LT(field.byte_count(), 1'500'000) << "more than one inner node";
        EXPECT_NEAR(contacts_of(field, {centre + Vec3f{0.75F, 0, 0}})[0].depth, 0.25, 1e-3);
    }
}

TEST(SparseField, RefusesSizesThatNoFieldHas) {
    const TriangleMesh mesh = make_box({1, 1, 1});
    for (const std::uint32_t count : {0U, 1U, SparseField::kMaxSamples + 1, 0xFFFF'FFFFU})
        expect_error(ErrorCode::InvalidOptions, std::to_string(count),
                     [&] { SparseField::with_samples(mesh, count); });
    expect_error(ErrorCode::InvalidOptions, "voxels", [&] { SparseField::with_samples(mesh, 2000); });
    expect_error(ErrorCode::InvalidOptions, "budget", [&] { SparseField::with_bytes(mesh, 10'000); });
}
