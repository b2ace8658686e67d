// How colliders that move displace what is near them when a step begins.

#include "simulation/contact/carry_field.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

using namespace echinus;

namespace {

constexpr double kTouchDistance = 0.01;
constexpr Vec3f kAboveTheCube{0, 0, 0.505F};

/// Where a particle begins a step that is just above a cube of edge 1, and would by itself go by `own`.
Vec3d carried(const Vec3d& displacement, const Vec3d& own) {
    static const ExactMap cube = ExactMap::build(make_box({1, 1, 1}));
    const std::vector<Collider> before{{.map = cube}};
    std::vector<Collider> after = before;
    after[0].pose.translation = displacement;
    const std::vector<std::uint8_t> is_near{1}, is_held{0};
    const std::vector<Deformation> rigid(1);
    PointArrays points;
    points.load(std::vector<Vec3f>{kAboveTheCube});
    const CarryField field(before, after, is_near, rigid, {}, kTouchDistance);
    field.carry(points, is_held, std::vector<Vec3d>{own}, Workers());
    return Vec3d(points[0]) - Vec3d(kAboveTheCube);
}

void expect_near(const Vec3d& a, const Vec3d& b) {
    EXPECT_LT(length(a - b), 1e-6) << a.x << ' ' << a.y << ' ' << a.z;
}

} // namespace

TEST(CarryField, PushesWhatIsInFrontOfACollider) {
    expect_near(carried({0, 0, 0.2}, {}), {0, 0, 0.2});
    expect_near(carried({0, 0, 0.2}, {0, 0, -1}), {0, 0, 0.2});
}

TEST(CarryField, DragsNothingThatAColliderOnlyPassesOrLeaves) {
    expect_near(carried({0.2, 0, 0}, {}), {});
    expect_near(carried({0.2, 0, 0}, {-0.2, 0, 0}), {});
    expect_near(carried({0, 0, -0.2}, {}), {});
    expect_near(carried({0.2, 0, 0.2}, {}), {0, 0, 0.2});
}

TEST(CarryField, TakesAlongWhatMovesWithACollider) {
    expect_near(carried({0.2, 0, 0}, {0.2, 0, 0}), {0.2, 0, 0});
    expect_near(carried({0.2, 0, 0}, {0.1, 0.3, 0}), {0.1, 0, 0});
    expect_near(carried({0, 0, -0.2}, {0, 0, -0.5}), {0, 0, -0.2});
}
