#include "directions/cast_rays.hpp"
#include "judges/exact_judge.hpp"
#include "oracle/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace echinus;

namespace {

test::ExactRayCaster caster_for(const LatticeMesh& lattice) {
    std::vector<std::array<Vec3d, 3>> faces;
    for (const auto& [a, b, c] : lattice.faces)
        faces.push_back({Vec3d(lattice.vertices[a]), Vec3d(lattice.vertices[b]), Vec3d(lattice.vertices[c])});
    return test::ExactRayCaster(faces);
}

struct RayCounts {
    int all = 0, degenerate = 0;
};

/// Casts every ray of a grid with CGAL and calls `check(direction, exact crossings, length of the lattice
/// direction in the mesh's unit)`.
template <typename Check>
RayCounts for_each_ray(const LatticeMesh& lattice, const SphericalGrid& grid, Check check) {
    const test::ExactRayCaster caster = caster_for(lattice);
    RayCounts counts;
    std::size_t direction = 0;
    for (const Vec3d& unit : grid.directions()) {
        const Vec3d d(lattice_direction(unit));
        const test::ExactCrossings exact = caster.cast(d);
        check(direction++, exact, length(d) * lattice.frame.step);
        ++counts.all;
        counts.degenerate += !exact.generic;
    }
    return counts;
}

constexpr PoleAxis kAxes[] = {PoleAxis::X, PoleAxis::Y, PoleAxis::Z};

} // namespace

TEST(CrossingsOracle, CountsAsCgalDoesOnEveryRayEvenThroughEdgesAndVertices) {
    RayCounts total;
    for (const auto& [name, mesh] : test::generated_meshes())
        for (PoleAxis axis : kAxes) {
            const LatticeMesh lattice = snap_to_lattice(mesh);
            const SphericalGrid grid(24, 12, axis);
            const Crossings crossings = cast_rays(lattice, grid, 1);
            const RayCounts counts =
                for_each_ray(lattice, grid, [&](std::size_t d, const test::ExactCrossings& exact, double) {
                    ASSERT_EQ(crossings.offsets[d + 1] - crossings.offsets[d], exact.parameters.size())
                        << name << ", direction " << d << (exact.generic ? "" : ", degenerate");
                });
            total.all += counts.all;
            total.degenerate += counts.degenerate;
        }
    EXPECT_GT(total.degenerate, 500);
    EXPECT_GT(total.all, 2 * total.degenerate);
}

TEST(CrossingsOracle, DistancesAgreeWithCgalUpToTheRoundingOfFloat) {
    constexpr double kFloatRounding = 0x1p-24;
    for (const auto& [name, mesh] : test::generated_meshes()) {
        const LatticeMesh lattice = snap_to_lattice(mesh);
        const SphericalGrid grid(40, 21, PoleAxis::Y);
        const Crossings crossings = cast_rays(lattice, grid, 1);
        for_each_ray(lattice, grid, [&](std::size_t d, const test::ExactCrossings& exact, double unit) {
            for (std::size_t k = 0; k < exact.parameters.size(); ++k) {
                const double expected = std::min(exact.parameters[k] * unit, double{lattice.radius});
                ASSERT_NEAR(crossings.distances[crossings.offsets[d] + k], expected,
                            expected * kFloatRounding * 1.001)
                    << name << ", direction " << d << ", crossing " << k;
            }
        });
    }
}

TEST(CrossingsOracle, AgreesOnRandomDirectionsOfAFineMesh) {
    // An odd grid and a turned mesh: no ray is degenerate, and every count is CGAL's own on the plain ray.
    const LatticeMesh lattice = snap_to_lattice(test::turned(make_torus(1, 0.45, 120, 48)));
    const SphericalGrid grid(61, 37, PoleAxis::X);
    const Crossings crossings = cast_rays(lattice, grid, 1);
    const RayCounts counts =
        for_each_ray(lattice, grid, [&](std::size_t d, const test::ExactCrossings& exact, double) {
            ASSERT_EQ(crossings.offsets[d + 1] - crossings.offsets[d], exact.parameters.size());
        });
    EXPECT_EQ(counts.degenerate, 0);
}
