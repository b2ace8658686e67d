#include "support/expectations.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

using namespace echinus;

namespace {

/// Whether a constraint of a kind joins two particles of a sheet, by how far apart they are in columns and
/// rows.
bool should_join(int columns_apart, int rows_apart, ConstraintKind kind) {
    const int far = std::max(columns_apart, rows_apart);
    const int near = std::min(columns_apart, rows_apart);
    switch (kind) {
    case ConstraintKind::Structural:
        return far == 1 && near == 0;
    case ConstraintKind::Shear:
        return far == 1 && near == 1;
    default:
        return far == 2 && near == 0;
    }
}

} // namespace

TEST(Cloth, HasEveryConstraintOfItsKindOnceAndNoOther) {
    for (const auto& [columns, rows] : {std::pair{2, 2}, {7, 4}, {3, 9}, {8, 8}}) {
        const Deformable cloth =
            make_cloth({.column_count = std::uint32_t(columns), .row_count = std::uint32_t(rows)});
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        for (const DistanceConstraint& constraint : cloth.constraints) {
            const int a = int(constraint.a);
            const int b = int(constraint.b);
            EXPECT_TRUE(should_join(std::abs(a % columns - b % columns), std::abs(a / columns - b / columns),
                                    constraint.kind))
                << a << " " << b;
            EXPECT_TRUE(seen.insert(std::minmax(constraint.a, constraint.b)).second) << a << " " << b;
        }
        const int structural = (columns - 1) * rows + columns * (rows - 1);
        const int shear = 2 * (columns - 1) * (rows - 1);
        const int bending = (columns - 2) * rows + columns * (rows - 2);
        EXPECT_EQ(cloth.constraints.size(), std::size_t(structural + shear + bending));
    }
}

TEST(Cloth, OfThePaperHas59002Constraints) {
    EXPECT_EQ(make_cloth({.column_count = 100, .row_count = 100}).constraints.size(), 59'002u);
}

TEST(Cloth, IsAtRestWhereItStarts) {
    const RigidTransform pose{Rotation::about({1, 2, 3}, 0.8), {5, -4, 3}};
    const Deformable cloth =
        make_cloth({.column_count = 9, .row_count = 6, .width = 2, .height = 3, .pose = pose});
    EXPECT_TRUE(cloth.velocities.empty());
    for (const DistanceConstraint& constraint : cloth.constraints)
        EXPECT_NEAR(length(cloth.positions[constraint.b] - cloth.positions[constraint.a]),
                    constraint.rest_length, 1e-6);
    EXPECT_NEAR(length(Vec3d(cloth.positions.front()) - pose.to_world({-1, -1.5, 0})), 0, 1e-6);
    EXPECT_NEAR(length(Vec3d(cloth.positions.back()) - pose.to_world({1, 1.5, 0})), 0, 1e-6);
}

TEST(Cloth, TurnsAllItsFacesAlongItsLocalZ) {
    const RigidTransform pose{Rotation::about({1, 0, 0}, std::numbers::pi / 2), {}};
    const Deformable cloth = make_cloth({.column_count = 5, .row_count = 4, .pose = pose});
    EXPECT_EQ(cloth.faces.size(), 4u * 3u * 2u);
    const Vec3d front = pose.rotation.apply({0, 0, 1});
    double area = 0;
    for (const Triangle& face : cloth.faces) {
        const Vec3d a(cloth.positions[face[0]]);
        const Vec3d twice_area =
            cross(Vec3d(cloth.positions[face[1]]) - a, Vec3d(cloth.positions[face[2]]) - a);
        EXPECT_NEAR(dot(twice_area, front), length(twice_area), 1e-7);
        area += length(twice_area) / 2;
    }
    EXPECT_NEAR(area, 1, 1e-6);
}

TEST(Cloth, PinsWhatItIsToldTo) {
    const Deformable cloth = make_cloth({.column_count = 3, .row_count = 3, .pins = {0, 8}});
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(cloth.inverse_masses[i], i == 0 || i == 8 ? 0 : 1);
}

TEST(Cloth, RefusesSizesThatMakeNoSheet) {
    const auto expect_refused = [](const ClothOptions& options) {
        test::expect_error(ErrorCode::InvalidOptions, "", [&] { make_cloth(options); });
    };
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    expect_refused({.column_count = 1});
    expect_refused({.row_count = 0});
    expect_refused({.column_count = 1U << 31, .row_count = 1U << 31});
    expect_refused({.width = 0});
    expect_refused({.height = kNaN});
    expect_refused({.column_count = 4, .row_count = 4, .pins = {16}});
}
