#include "support/expectations.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

template <typename Call>
void expect_refused(Call&& call) {
    expect_error(ErrorCode::InvalidOptions, "", call);
}

} // namespace

TEST(Generators, MakeThePapersTorus) {
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    EXPECT_EQ(torus.faces.size(), 2880U);
    EXPECT_EQ(torus.vertices.size(), 1440U);
    EXPECT_NEAR(winding_number(torus, {1, 0, 0}), 1, 1e-12);
    EXPECT_NEAR(winding_number(torus, {0, 0, 0}), 0, 1e-12);
    for (const Vec3f& p : torus.vertices)
        ASSERT_NEAR(std::hypot(std::hypot(p.x, p.y) - 1.0, double{p.z}), 0.4, 1e-7);
}

TEST(Generators, MakeASphereWithAllVerticesOnIt) {
    const TriangleMesh sphere = make_sphere(3, 60, 30);
    EXPECT_EQ(sphere.faces.size(), 2U * 60 * 29);
    EXPECT_EQ(sphere.vertices.size(), 60U * 29 + 2);
    for (const Vec3f& p : sphere.vertices) ASSERT_NEAR(length(Vec3d(p)), 3, 4e-7);
}

TEST(Generators, MakeABoxWithSharedEdges) {
    for (std::uint32_t segments : {1U, 2U, 5U}) {
        const TriangleMesh box = make_box({1, 2, 3}, segments);
        EXPECT_EQ(box.faces.size(), 12U * segments * segments);
        EXPECT_EQ(box.vertices.size(), 6U * segments * segments + 2); // Euler: V = 2 + F / 2
        EXPECT_NEAR(winding_number(box, {0.49, 0.99, 1.49}), 1, 1e-12);
        EXPECT_NEAR(winding_number(box, {0.51, 0.99, 1.49}), 0, 1e-12);
    }
}

TEST(Generators, RefuseSizesThatMakeNoSolid) {
    const double infinity = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (double bad : {0.0, -1.0, 1.5, 1e-60, infinity, nan})
        expect_refused([&] { make_torus(1, bad, 8, 8); });
    for (double bad : {0.0, -1.0, 1e-60, 1e39, infinity, nan}) {
        expect_refused([&] { make_torus(bad, 0.1, 8, 8); });
        expect_refused([&] { make_sphere(bad, 8, 8); });
        expect_refused([&] { make_box({1, bad, 1}); });
    }
}

TEST(Generators, NameTheSizeThatIsTooLarge) {
    const double infinity = std::numeric_limits<double>::infinity();
    const auto expect_named = [](const char* sentence, const auto& call) {
        expect_error(ErrorCode::InvalidOptions, sentence, call);
    };
    expect_named("the major radius of a torus is inf; it must be positive and finite as a 32-bit float",
                 [&] { make_torus(infinity, 1, 8, 8); });
    expect_named("the outer radius of a torus, major + minor, is 5e+38",
                 [] { make_torus(3e38, 2e38, 8, 8); });
    expect_named("the radius of a sphere is inf", [&] { make_sphere(infinity, 8, 8); });
    expect_named("the edge length of a box is 1e+39", [] { make_box({1, 1e39, 1}); });
}

TEST(Generators, RefuseTooFewAndTooManySegments) {
    const std::uint32_t many = std::numeric_limits<std::uint32_t>::max();
    expect_refused([&] { make_torus(1, 0.4, 2, 8); });
    expect_refused([&] { make_torus(1, 0.4, 8, 2); });
    expect_refused([&] { make_torus(1, 0.4, many, many); });
    expect_refused([&] { make_sphere(1, 2, 8); });
    expect_refused([&] { make_sphere(1, 8, 1); });
    expect_refused([&] { make_sphere(1, many, many); });
    expect_refused([&] { make_box({1, 1, 1}, 0); });
    expect_refused([&] { make_box({1, 1, 1}, many); });
}
