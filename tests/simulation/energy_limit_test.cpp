// The energy of bodies so violent that substeps do not resolve what happens.

#include "simulation/energy_limit.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"
#include "support/soft_bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

using namespace echinus;

namespace {

constexpr double kYoung = 1e3; // waves go 1 m/s

SimulationOptions weightless(unsigned thread_count = 1) {
    SimulationOptions options{
        .solver = SolverKind::Xpbd, .iteration_count = 1, .substep_count = 10, .gravity = {}, .drag = 0};
    options.thread_count = thread_count;
    return options;
}

Deformable cube(std::uint32_t segments, double poisson_ratio, double young_modulus = kYoung) {
    return make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {segments, segments, segments}),
                          {.young_modulus = young_modulus, .poisson_ratio = poisson_ratio});
}

Simulation violent(const Deformable& body, const SimulationOptions& options, float wave_speeds) {
    test::Random random(31);
    Simulation simulation(body, {}, options);
    for (std::size_t i = 0; i < body.particle_count(); ++i)
        simulation.set_particle_velocity(i, Vec3d(test::in_cube(random, wave_speeds * std::sqrt(3.0F))));
    return simulation;
}

/// A body between two substeps, with particles that move against each other.
struct Body {
    Deformable deformable;
    SimulationOptions options = weightless();
    Particles particles;
    TetrahedronArrays tetrahedra;
    EnergyLimit limit;

    explicit Body(Deformable body)
        : deformable(std::move(body)), particles(deformable, true),
          tetrahedra(weighted_tetrahedra(deformable, options)),
          limit(tetrahedra, particles, deformable.inverse_masses) {}

    double substep() const { return options.time_step / options.substep_count; }
    Vec3d place(std::size_t i) const {
        return Vec3d(particles.positions[i]) + Vec3d(particles.remainders[i]);
    }
    Vec3d velocity(std::size_t i) const { return Vec3d(particles.step(i)) * (1 / substep()); }
    double mass(std::size_t i) const { return 1 / double{deformable.inverse_masses[i]}; }

    double energy() const {
        std::vector<Vec3f> positions(particles.count());
        particles.positions.store(positions);
        double sum = 0;
        for (std::size_t i = 0; i < particles.count(); ++i)
            sum += mass(i) * dot(velocity(i), velocity(i)) / 2;
        for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra)
            sum += test::elastic_energy(tetrahedron, positions);
        return sum;
    }
    Vec3d momentum() const {
        Vec3d sum;
        for (std::size_t i = 0; i < particles.count(); ++i) sum += velocity(i) * mass(i);
        return sum;
    }
    Vec3d angular_momentum() const {
        Vec3d sum;
        for (std::size_t i = 0; i < particles.count(); ++i) sum += cross(place(i), velocity(i)) * mass(i);
        return sum;
    }
    void set_in_motion(float speed) {
        test::Random random(37);
        for (std::size_t i = 0; i < particles.count(); ++i)
            particles.move_previous(i, test::in_cube(random, speed * static_cast<float>(substep())));
    }
    void go() {
        for (std::size_t i = 0; i < particles.count(); ++i) {
            const Vec3f way = particles.step(i);
            particles.previous.set(i, particles.positions[i]);
            particles.previous_remainders.set(i, particles.remainders[i]);
            particles.move(i, way);
        }
    }
    /// A substep but for its end. In place of a relaxation all particles are moved away from the middle.
    void swell_in_a_substep() {
        limit.begin_frame(particles);
        limit.begin_substep(tetrahedra, particles);
        go();
        limit.note(tetrahedra, particles);
        for (std::size_t i = 0; i < particles.count(); ++i) particles.move(i, particles.positions[i] * 0.02F);
        limit.charge(tetrahedra, particles);
    }
};

} // namespace

TEST(EnergyLimit, TakesOffWhatARelaxationAddsAndLeavesTheMomentum) {
    Body body(cube(3, 0.3));
    body.set_in_motion(8);
    const double start = body.energy();
    body.swell_in_a_substep();
    const Vec3d momentum = body.momentum(), angular = body.angular_momentum();
    ASSERT_GT(body.energy(), 1.1 * start);
    body.limit.end_substep(body.particles);
    EXPECT_NEAR(body.energy() / start, 1, 1e-3);
    EXPECT_LT(length(body.momentum() - momentum), 1e-4 * length(momentum));
    EXPECT_LT(length(body.angular_momentum() - angular), 1e-4 * length(angular));
}

TEST(EnergyLimit, LeavesBodiesAsTheyAreThatMoveAsAWholeOrSlowly) {
    for (const float own_speed : {0.0F, 0.5F}) {
        Body body(cube(3, 0.3));
        body.set_in_motion(own_speed);
        for (std::size_t i = 0; i < body.particles.count(); ++i)
            body.particles.move_previous(i, Vec3f{0.01F, 0, 0});
        body.swell_in_a_substep();
        const PointArrays previous = body.particles.previous;
        body.limit.end_substep(body.particles);
        EXPECT_EQ(body.particles.previous.x, previous.x);
    }
}

TEST(EnergyLimit, KeepsBodiesFromGainingEnergyWhereSubstepsDoNotResolveTheirMotion) {
    for (const double poisson : {0.0, 0.3, 0.45, 0.49})
        for (const float wave_speeds : {30.0F, 50.0F, 100.0F}) {
            Simulation simulation = violent(cube(4, poisson), weightless(), wave_speeds);
            const double start = test::energy(simulation);
            for (int frame = 0; frame < 60; ++frame) {
                simulation.step();
                ASSERT_LE(test::energy(simulation), 1.001 * start)
                    << "frame " << frame << ", Poisson " << poisson << ", wave speeds " << wave_speeds;
            }
        }
}

TEST(EnergyLimit, KeepsAStiffBodyThatTurnsFromGainingEnergyWhereSubstepsDoNotResolveItsWaves) {
    constexpr double kStiff = 1e6; // waves go 32 m/s, and cross 2.6 elements in a substep of 1/240 s
    for (const std::uint32_t substeps : {1U, 2U})
        for (const double wave_speeds : {0.3, 0.7}) { // of its corners
            SimulationOptions options = weightless();
            options.substep_count = substeps;
            const Deformable body = cube(4, 0.3, kStiff);
            Simulation simulation(body, {}, options);
            const Vec3d turn{0, 0, wave_speeds * std::sqrt(kStiff / 1000) / std::hypot(0.1, 0.1)};
            for (std::size_t i = 0; i < body.particle_count(); ++i)
                simulation.set_particle_velocity(i, cross(turn, Vec3d(body.positions[i])));
            const double start = test::energy(simulation);
            for (int frame = 0; frame < 240; ++frame) {
                simulation.step();
                ASSERT_LE(test::energy(simulation), 1.001 * start)
                    << "frame " << frame << ", substeps " << substeps << ", wave speeds " << wave_speeds;
            }
        }
}

TEST(EnergyLimit, GivesTheSameBitsOnAnyNumberOfThreadsAndUnderEachInstructionSet) {
    const Deformable bodies[] = {cube(8, 0.3), cube(4, 0.45), cube(4, 0.3, 1e7)};
    std::set<std::uint64_t> hashes;
    const auto run = [&](unsigned thread_count) {
        Simulation simulation = violent(combine(bodies), weightless(thread_count), 40);
        for (int frame = 0; frame < 10; ++frame) simulation.step();
        hashes.insert(simulation.state_hash());
    };
    for (const unsigned thread_count : {1U, 2U, 3U}) run(thread_count);
    test::under_each_instruction_set([&](std::string_view) { run(1); });
    EXPECT_EQ(hashes.size(), 1u);
}

TEST(EnergyLimit, GoesOnWithTheSameBitsFromASavedState) {
    const Deformable body = cube(4, 0.3);
    Simulation first = violent(body, weightless(), 40);
    for (int frame = 0; frame < 5; ++frame) first.step();
    Simulation second(body, {}, weightless());
    second.restore_state(first.save_state());
    for (int frame = 0; frame < 10; ++frame) {
        first.step();
        second.step();
        ASSERT_EQ(first.state_hash(), second.state_hash()) << frame;
    }
}
