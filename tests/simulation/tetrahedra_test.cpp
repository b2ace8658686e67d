// Tetrahedra: what is promised for any shape they are in.

#include "support/random_points.hpp"
#include "support/soft_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

namespace {

SimulationOptions floating() {
    return {.solver = NewtonOptions{.air_drag = 0, .collision = CollisionMode::Particles}, .gravity = {}};
}

Deformable block(std::uint32_t segments, const SoftBodyOptions& options = {}) {
    return make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {segments, segments, segments}), options);
}

void shake(Deformable& body, test::Random& random, float distance) {
    for (Vec3f& p : body.positions) p += test::in_cube(random, distance);
}

/// Particles of a body at rest get velocities of their own, each coordinate up to `speed` * sqrt(3), hence
/// `speed` in the root mean square.
void set_in_motion(Simulation& simulation, test::Random& random, float speed) {
    for (std::size_t i = 0; i < simulation.deformable().particle_count(); ++i)
        simulation.set_particle_velocity(i, Vec3d(test::in_cube(random, speed * std::sqrt(3.0F))));
}

struct BodyMomentum {
    Vec3d linear, angular;
    double linear_of_all = 0, angular_of_all = 0; ///< sums of the particles' ones, whatever their directions
};

/// Angular about the origin.
BodyMomentum momentum_of_body(const Simulation& simulation) {
    const Deformable& body = simulation.deformable();
    BodyMomentum sum;
    for (std::size_t i = 0; i < body.particle_count(); ++i) {
        const Vec3d position(body.positions[i]);
        const Vec3d impulse = Vec3d(body.velocities[i]) * (1 / double{body.inverse_masses[i]});
        sum.linear += impulse;
        sum.linear_of_all += length(impulse);
        sum.angular += cross(position, impulse);
        sum.angular_of_all += length(cross(position, impulse));
    }
    return sum;
}

} // namespace

TEST(Tetrahedra, StayAtRestWhereverTheyStandHoweverTheyAreTurned) {
    test::Random random(5);
    for (int i = 0; i < 10; ++i) {
        const Rotation turn = Rotation::about(Vec3d(test::unit_vector(random)), 3 * i);
        Deformable body =
            block(3, {.young_modulus = 1e5, .pose = {turn, Vec3d(test::in_cube(random, 0.5F))}});
        Simulation simulation(body, {}, floating());
        for (int frame = 0; frame < 25; ++frame) simulation.step();
        for (std::size_t p = 0; p < body.particle_count(); ++p)
            EXPECT_LT(length(simulation.positions()[p] - body.positions[p]), 2e-6F);
    }
}

TEST(Tetrahedra, DoNotStayInsideOutAndReturnToTheirShapeUnlessTangledAndHardlyCompressible) {
    test::Random random(7);
    for (const double poisson : {0.0, 0.49})
        for (const double young : {1e3, 1e7})
            for (const float distance : {0.02F, 0.1F, 0.3F}) {
                Deformable body =
                    block(3, {.young_modulus = young, .poisson_ratio = poisson, .damping = 0.01});
                if (distance == 0.3F)
                    for (Vec3f& p : body.positions) p.z = 0; // flat as a sheet, and then shaken
                shake(body, random, distance == 0.3F ? 0.001F : distance);
                ASSERT_LT(test::least_volume_ratio(body, body.positions), distance > 0.05F ? 0.0 : 0.5);
                SimulationOptions options = floating();
                options.newton().air_drag = 5;
                Simulation simulation(body, {}, options);
                for (int frame = 0; frame < 125; ++frame) simulation.step();
                // Shaken by half of its size, a body that keeps its volume may lock in another shape.
                const bool may_lock = poisson > 0.4 && distance == 0.1F;
                EXPECT_GT(test::least_volume_ratio(body, simulation.positions()), may_lock ? 0.2 : 0.98)
                    << "Poisson " << poisson << ", Young " << young << ", distance " << distance;
                if (!may_lock) EXPECT_LT(test::energy(simulation), 1e-3 * young * 0.008);
            }
}

TEST(Tetrahedra, NeverGainEnergyWithoutALoad) {
    for (const double poisson : {0.0, 0.3, 0.49})
        for (const double young : {1e3, 1e7})
            for (const double damping : {0.0, 0.02}) {
                test::Random random(11);
                Deformable body =
                    block(4, {.young_modulus = young, .poisson_ratio = poisson, .damping = damping});
                shake(body, random, 0.005F);
                Simulation simulation(body, {}, floating());
                const double start = test::energy(simulation);
                for (int frame = 0; frame < 40; ++frame) {
                    simulation.step();
                    ASSERT_LE(test::energy(simulation), 1.001 * start)
                        << "frame " << frame << ", Poisson " << poisson << ", Young " << young;
                }
            }
}

TEST(Tetrahedra, NeverGainEnergyWhereParticlesMoveFasterThanWaves) {
    for (const double poisson : {0.0, 0.3, 0.45, 0.49})
        for (const float wave_speeds : {2.0F, 4.0F, 10.0F}) {
            test::Random random(19);
            Simulation simulation(block(4, {.young_modulus = 1e3, .poisson_ratio = poisson}), {}, floating());
            set_in_motion(simulation, random, wave_speeds);
            const double start = test::energy(simulation);
            for (int frame = 0; frame < 30; ++frame) {
                simulation.step();
                ASSERT_LE(test::energy(simulation), 1.001 * start)
                    << "frame " << frame << ", Poisson " << poisson << ", wave speeds " << wave_speeds;
            }
            EXPECT_LT(test::energy(simulation), 0.6 * start);
        }
}

TEST(Tetrahedra, KeepTheMomentumOfABodyWhoseElementsAreThrownInsideOut) {
    // Of the angular one an implicit step gains or loses some, the less the shorter it is.
    const auto angular_change = [](double poisson, float wave_speeds, double step) {
        test::Random random(23);
        const Deformable body = block(4, {.young_modulus = 1e3, .poisson_ratio = poisson});
        SimulationOptions options = floating();
        options.time_step = step;
        Simulation simulation(body, {}, options);
        set_in_motion(simulation, random, wave_speeds);
        const BodyMomentum start = momentum_of_body(simulation);
        double least = 1, change = 0;
        while (simulation.frame() * step < 0.25) {
            simulation.step();
            least = std::min(least, test::least_volume_ratio(body, simulation.positions()));
            const BodyMomentum now = momentum_of_body(simulation);
            EXPECT_LT(length(now.linear - start.linear), 5e-4 * start.linear_of_all);
            change = std::max(change, length(now.angular - start.angular) / start.angular_of_all);
        }
        EXPECT_LT(least, -0.1);
        return change;
    };
    for (const double poisson : {0.0, 0.45})
        for (const float wave_speeds : {2.0F, 10.0F}) {
            const double change = angular_change(poisson, wave_speeds, 1.0 / 60);
            EXPECT_LT(change, 0.0125 * double{wave_speeds});
            EXPECT_LT(angular_change(poisson, wave_speeds, 1.0 / 240), 0.5 * change);
        }
}

TEST(Tetrahedra, DoNotStayInsideOutInABodyThatNothingDamps) {
    for (const double poisson : {0.0, 0.45}) {
        test::Random random(29);
        const Deformable body = block(3, {.young_modulus = 1e3, .poisson_ratio = poisson});
        Simulation simulation(body, {}, floating());
        set_in_motion(simulation, random, 5);
        double least = 1;
        for (int frame = 0; frame < 300; ++frame) {
            simulation.step();
            least = std::min(least, test::least_volume_ratio(body, simulation.positions()));
        }
        EXPECT_LT(least, -1) << "Poisson " << poisson;
        EXPECT_GT(test::least_volume_ratio(body, simulation.positions()), 0.2) << "Poisson " << poisson;
    }
}

TEST(Tetrahedra, KeepTheMomentumOfAFreeBodyThatTurnsAndTrembles) {
    test::Random random(13);
    Deformable body = block(4, {.young_modulus = 1e4});
    shake(body, random, 0.003F);
    const SimulationOptions options = floating();
    for (const Vec3f& place : body.positions)
        body.velocities.push_back(Vec3f(cross(Vec3d{1, 2, 8}, Vec3d(place)) + Vec3d{0.1, 0.05, 0.02}));
    Simulation simulation(body, {}, options);
    const BodyMomentum start = momentum_of_body(simulation);
    for (int frame = 0; frame < 60; ++frame) {
        simulation.step();
        const BodyMomentum now = momentum_of_body(simulation);
        ASSERT_LT(length(now.linear - start.linear), 2e-3 * start.linear_of_all) << "frame " << frame;
        // An implicit step loses some of it.
        ASSERT_LT(length(now.angular), 1.002 * length(start.angular)) << "frame " << frame;
    }
}

TEST(Tetrahedra, AreDampedWithoutBeingHeldUp) {
    // A body that only turns and moves does not strain, so viscosity does not slow it.
    const auto left_of = [](double damping, bool trembles, double step) {
        test::Random random(17);
        Deformable body = block(3, {.young_modulus = 1e5, .damping = damping});
        if (trembles) shake(body, random, 0.005F);
        SimulationOptions options = floating();
        options.time_step = step;
        if (!trembles)
            for (const Vec3f& place : body.positions)
                body.velocities.push_back(Vec3f(cross(Vec3d{0, 0, 3}, Vec3d(place))));
        Simulation simulation(body, {}, options);
        const double start = test::energy(simulation);
        while (simulation.frame() * step < 0.2) simulation.step();
        return test::energy(simulation) / start;
    };
    constexpr double kFine = 1.0 / 1000, kCoarse = 1.0 / 60; // the longer one damps waves by itself
    EXPECT_LT(left_of(0.05, true, kFine), 0.2 * left_of(0, true, kFine));
    EXPECT_NEAR(left_of(0.05, false, kFine), 1, 1e-3);
    EXPECT_NEAR(left_of(0.5, false, kCoarse), left_of(0, false, kCoarse), 1e-3);
    EXPECT_GT(left_of(0, false, kCoarse), 0.99);
}
