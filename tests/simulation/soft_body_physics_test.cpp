// Soft bodies against answers that are known: bars, beams, what cannot be compressed, what slides.
// docs/soft_bodies.md has the same at finer resolutions.

#include "support/beams.hpp"
#include "support/soft_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace echinus;

namespace {

/// How far a block of rubber slides down a slope in half a second, with the friction 0.5, and the friction
/// that its acceleration in the second half of that time tells. In the first it sags onto the slope.
struct Slide {
    double distance, friction;
};

Slide slide_down(double degrees) {
    constexpr double kFriction = 0.5, kThinBody = 0.004, kSeconds = 0.5, kGravity = 9.81;
    const double angle = degrees * std::numbers::pi / 180;
    const Rotation tilt = Rotation::about({0, 1, 0}, angle); // down along x
    const Deformable block = make_soft_body(make_solid_box({0.2, 0.2, 0.1}, {4, 4, 2}),
                                            {.young_modulus = 2e5,
                                             .poisson_ratio = 0.3,
                                             .damping = 0.02,
                                             .pose = {tilt, tilt.apply({0, 0, 0.5 + 0.05 + kThinBody})}});
    const Collider slope{.map = ExactMap::build(make_box({3, 1, 1})), .pose = {tilt, {}}};
    Simulation simulation(block, {slope},
                          {.solver = SolverKind::Xpbd,
                           .iteration_count = 1,
                           .substep_count = 10,
                           .drag = 0,
                           .thickness = kThinBody,
                           .friction = kFriction,
                           .surface_collision = true});
    const auto middle = [&] {
        Vec3d sum;
        for (const Vec3f& p : simulation.positions()) sum += Vec3d(p);
        return sum * (1.0 / static_cast<double>(block.particle_count()));
    };
    const Vec3d start = middle(), down = tilt.apply({1, 0, 0});
    const auto speed = [&] {
        const Vec3d before = middle();
        simulation.step();
        return dot(middle() - before, down) / simulation.options().time_step;
    };
    while (simulation.frame() * simulation.options().time_step < kSeconds / 2) simulation.step();
    const double first_speed = speed();
    while (simulation.frame() * simulation.options().time_step < kSeconds) simulation.step();
    const double distance = dot(middle() - start, down);
    const double acceleration = (speed() - first_speed) / (kSeconds / 2);
    return {distance, (std::sin(angle) - acceleration / kGravity) / std::cos(angle)};
}

} // namespace

TEST(SoftBodyPhysics, HangsABarAsLowAsHookeSays) {
    const test::Settled bar = test::hang_bar({.segments = 3, .poisson_ratio = 0.3, .iterations = 3});
    EXPECT_NEAR(bar.deflection / bar.expected, 1, 0.03);
}

TEST(SoftBodyPhysics, BendsACantileverAsTimoshenkoSaysTheCloserTheFinerItIs) {
    const test::Settled coarse =
        test::bend_cantilever({.segments = 2, .poisson_ratio = 0.3, .iterations = 3});
    const test::Settled fine = test::bend_cantilever({.segments = 4, .poisson_ratio = 0.3, .iterations = 3});
    const double coarse_error = 1 - coarse.deflection / coarse.expected;
    const double fine_error = 1 - fine.deflection / fine.expected;
    EXPECT_LT(coarse_error, 0.4);
    EXPECT_LT(fine_error, 0.14);
    EXPECT_GT(fine_error, -0.03);
    EXPECT_LT(fine_error, 0.45 * coarse_error);
}

TEST(SoftBodyPhysics, KeepsItsVolumeWhereItCannotBeCompressed) {
    const test::Settled bar = test::hang_bar({.segments = 3, .poisson_ratio = 0.49, .strain = 0.1});
    EXPECT_NEAR(bar.volume_ratio, 1, 0.01);
    const test::Settled compressible = test::hang_bar({.segments = 3, .poisson_ratio = 0, .strain = 0.1});
    EXPECT_GT(compressible.volume_ratio, 1.03);
}

TEST(SoftBodyPhysics, SlidesDownASlopeOnlyBeyondTheAngleOfFrictionAndThenAsFastAsCoulombSays) {
    // The angle is atan(0.5) = 26.6 degrees.
    EXPECT_LT(std::fabs(slide_down(24).distance), 0.001);
    EXPECT_LT(std::fabs(slide_down(26).distance), 0.003);
    for (const double degrees : {27.0, 28.0, 30.0, 40.0})
        EXPECT_NEAR(slide_down(degrees).friction, 0.5, 0.0025) << degrees;
}

TEST(SoftBodyPhysics, FallsAsFastFarFromTheOriginAndInSmallStepsAsNearIt) {
    for (const float height : {0.5F, 2.0F, 8.0F})
        for (const std::uint32_t substeps : {5U, 10U, 20U}) {
            const Deformable body =
                make_soft_body(make_solid_box({0.3, 0.3, 0.3}, {2, 2, 2}), {.pose = {{}, {0, 0, height}}});
            Simulation simulation(
                body, {},
                {.solver = SolverKind::Xpbd, .iteration_count = 1, .substep_count = substeps, .drag = 0});
            for (int frame = 0; frame < 60; ++frame) simulation.step();
            double fallen = 0;
            for (std::size_t i = 0; i < body.particle_count(); ++i)
                fallen += double{body.positions[i].z} - double{simulation.positions()[i].z};
            const double n = 60.0 * substeps, seconds = 60 * simulation.options().time_step / n;
            EXPECT_NEAR(fallen / static_cast<double>(body.particle_count()) /
                            (9.81 * seconds * seconds * n * (n + 1) / 2),
                        1, 0.005)
                << height << ' ' << substeps;
        }
}
