// The loads that deformables put on colliders: weights, friction, moments and momentum.

#include "support/draping.hpp"
#include "support/soft_bodies.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr double kStandardGravity = 9.81;

const SimulationOptions kMeasured{.thickness = 0.01};

SimulationOptions weightless() {
    SimulationOptions options = kMeasured;
    options.gravity = {};
    options.newton().air_drag = 0;
    return options;
}

/// [particle] of a cloth by the area around it, of a body by itself.
std::vector<double> masses_of(const Simulation& simulation) {
    const Deformable& d = simulation.deformable();
    std::vector<double> masses(d.particle_count());
    if (!d.tetrahedra.empty()) {
        for (std::size_t i = 0; i < masses.size(); ++i) masses[i] = 1 / double{d.inverse_masses[i]};
        return masses;
    }
    // Every face of a sheet has the same area.
    const Vec3d a(d.positions[d.faces[0][0]]), b(d.positions[d.faces[0][1]]), c(d.positions[d.faces[0][2]]);
    const double of_face = simulation.options().newton().material.density * length(cross(b - a, c - a)) / 2;
    for (const Triangle& face : d.faces)
        for (const std::uint32_t corner : face) masses[corner] += of_face / 3;
    return masses;
}

double weight_of(const std::vector<double>& masses) {
    return std::accumulate(masses.begin(), masses.end(), 0.0) * kStandardGravity;
}

/// Its mean over some frames.
Load mean_load(Simulation& simulation, std::size_t collider, int frames = 15) {
    Load sum;
    for (int i = 0; i < frames; ++i) {
        simulation.step();
        sum.force += simulation.load_on(collider).force * (1.0 / frames);
        sum.torque += simulation.load_on(collider).torque * (1.0 / frames);
    }
    return sum;
}

Vec3d momentum_of(const Simulation& simulation, const std::vector<double>& masses) {
    const Deformable& d = simulation.deformable();
    Vec3d sum;
    for (std::size_t i = 0; i < d.particle_count(); ++i) sum += Vec3d(d.velocities[i]) * masses[i];
    return sum;
}

/// @param most_left  of the momentum, as a share
void expect_balance(Simulation& simulation, int frame_count, double most_left) {
    const std::vector<double> masses = masses_of(simulation);
    const Vec3d before = momentum_of(simulation, masses);
    Vec3d given;
    for (int i = 0; i < frame_count; ++i) {
        simulation.step();
        given += simulation.load_on(0).force * simulation.options().time_step;
    }
    const Vec3d left = momentum_of(simulation, masses);
    EXPECT_LT(length(left), most_left * length(before));
    EXPECT_NEAR(length(given + left - before), 0, 0.01 * length(before));
}

} // namespace

TEST(Load, OfAClothAtRestIsItsWeight) {
    Simulation simulation(sheet_at(0.55, 1.2, 13), colliders_of({make_sphere(0.5, 30, 15)}), kMeasured);
    const double weight = weight_of(masses_of(simulation));
    for (int i = 0; i < 300 && !simulation.at_rest(); ++i) simulation.step();
    const Load load = mean_load(simulation, 0);
    EXPECT_NEAR(load.force.z, -weight, 0.02 * weight);
    EXPECT_NEAR(std::hypot(load.force.x, load.force.y), 0, 0.02 * weight);
}

TEST(Load, OfASoftBodyAtRestIsItsWeightWhereverItLies) {
    for (const Vec3d& place : {Vec3d{}, Vec3d{4, -3, 5}, Vec3d{-20, 0, 0}}) {
        const Deformable body =
            make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {3, 3, 3}),
                           {.young_modulus = 2e4, .damping = 0.02, .pose = {{}, place + Vec3d{0, 0, 0.165}}});
        std::vector<Collider> plate = colliders_of({make_box({1, 1, 0.1})});
        plate[0].pose.translation = place;
        Simulation simulation(body, plate, kMeasured);
        const double weight = weight_of(masses_of(simulation));
        for (int i = 0; i < 60; ++i) simulation.step();
        const Load load = mean_load(simulation, 0, 30);
        EXPECT_NEAR(load.force.z, -weight, 0.005 * weight) << "at " << place.x << ' ' << place.z;
        EXPECT_NEAR(std::hypot(load.force.x, load.force.y), 0, 0.005 * weight);
    }
}

TEST(Load, HasTheMomentOfWhereTheClothLies) {
    Deformable sheet = sheet_at(0.07, 0.4, 10);
    for (Vec3f& p : sheet.positions) p += Vec3f{0.6F, -0.2F, 0};
    Simulation simulation(sheet, colliders_of({make_box({2, 2, 0.1})}), kMeasured);
    const double weight = weight_of(masses_of(simulation));
    for (int i = 0; i < 75; ++i) simulation.step();
    const Load load = mean_load(simulation, 0);
    // r x F with r = (0.6, -0.2, 0.06) and F = (0, 0, -weight).
    EXPECT_NEAR(load.force.z, -weight, 0.02 * weight);
    EXPECT_NEAR(load.torque.x, 0.2 * weight, 0.02 * weight);
    EXPECT_NEAR(load.torque.y, 0.6 * weight, 0.02 * weight);
    EXPECT_NEAR(load.torque.z, 0, 0.02 * weight);
}

TEST(Load, IsSharedByTwoTablesHalfEach) {
    const std::vector<TriangleMesh> tables{make_box({0.4, 1, 0.1}), make_box({0.4, 1, 0.1})};
    std::vector<Collider> colliders = colliders_of(tables);
    colliders[0].pose.translation = {-0.3, 0, 0};
    colliders[1].pose.translation = {0.3, 0, 0};
    Simulation simulation(sheet_at(0.07, 0.8, 13), colliders, kMeasured);
    const double weight = weight_of(masses_of(simulation));
    for (int i = 0; i < 200; ++i) simulation.step();
    Vec3d left, right;
    for (int i = 0; i < 15; ++i) {
        simulation.step();
        left += simulation.load_on(0).force * (1.0 / 15);
        right += simulation.load_on(1).force * (1.0 / 15);
    }
    EXPECT_NEAR(left.z, -weight / 2, 0.02 * weight);
    EXPECT_NEAR(right.z, -weight / 2, 0.02 * weight);
    // The cloth sags between them and pulls them together.
    EXPECT_GE(left.x, -0.01 * weight);
    EXPECT_NEAR(left.x, -right.x, 0.03 * weight);
}

TEST(Load, BalancesTheMomentumOfAnImpact) {
    Simulation simulation(sheet_at(0.3, 1, 16, {0, 0, -3}), colliders_of({make_sphere(0.2, 24, 12)}),
                          weightless());
    expect_balance(simulation, 30, 0.9);
}

TEST(Load, OfAFastImpactIsWhatTheClothLoses) {
    Simulation simulation(sheet_at(0.3, 1, 16, {0, 0, -20}), colliders_of({make_sphere(0.2, 24, 12)}),
                          weightless());
    expect_balance(simulation, 8, 0.97);
}

TEST(Load, OfAClothThatHangsFromItIsItsWeight) {
    Deformable sheet = sheet_at(1, 0.6, 12);
    for (std::uint32_t i = 0; i < 12; ++i) {
        sheet.inverse_masses[i] = 0;
        sheet.attachments.push_back({i, 0});
    }
    SimulationOptions options = kMeasured;
    options.newton().air_drag = 5;
    Simulation simulation(sheet, colliders_of({make_box({0.1, 0.1, 0.1})}), options);
    const double weight = weight_of(masses_of(simulation));
    for (int i = 0; i < 300; ++i) simulation.step();
    EXPECT_NEAR(mean_load(simulation, 0, 60).force.z, -weight, 0.02 * weight);
}

TEST(Load, OfFrictionIsAgainstTheMotion) {
    // A belt under a sheet that is held back by nothing but its inertia: it takes friction times weight.
    std::vector<Collider> colliders = colliders_of({make_box({40, 2, 0.1})});
    colliders[0].linear_velocity = {8, 0, 0};
    SimulationOptions options = kMeasured;
    options.newton().air_drag = 0;
    options.friction = 0.3;
    Simulation simulation(sheet_at(0.0601, 0.5, 10), colliders, options);
    const double weight = weight_of(masses_of(simulation));
    for (int i = 0; i < 15; ++i) simulation.step();
    const Load load = mean_load(simulation, 0, 15);
    EXPECT_NEAR(load.force.z, -weight, 0.02 * weight);
    EXPECT_NEAR(load.force.x, -0.3 * weight, 0.02 * weight);
}

namespace {

/// On the first part of a contact, as the mean of the frame.
Vec3d force_of(const ContactPoint& point, double seconds) {
    return (point.normal * point.normal_impulse + point.friction_impulse) * (1 / seconds);
}

} // namespace

TEST(ContactPoints, SumToTheLoadOnEachColliderAndToTheWeightAtRest) {
    Simulation simulation(sheet_at(0.55, 1.2, 13), colliders_of({make_sphere(0.5, 30, 15)}), kMeasured);
    simulation.step();
    EXPECT_TRUE(simulation.contact_points().empty()); // until they are asked for
    simulation.record_contacts(true);
    const double weight = weight_of(masses_of(simulation));
    Vec3d at_rest;
    for (int i = 0; i < 300; ++i) {
        const std::uint64_t truncated = simulation.profile().truncated_count;
        simulation.step();
        Vec3d sum;
        for (const ContactPoint& point : simulation.contact_points()) {
            EXPECT_NEAR(length(point.normal), 1, 1e-6);
            EXPECT_NEAR(dot(point.normal, point.friction_impulse), 0, 1e-9);
            EXPECT_GE(point.normal_impulse, 0);
            EXPECT_GT(point.gap, 0);
            EXPECT_LT(point.gap, 0.02); // what pushed in a part of the frame may have gone on
            if (point.collider != 0) continue;
            EXPECT_NEAR(length(point.position), 0.5, 0.03);
            sum -= force_of(point, simulation.options().time_step);
        }
        if (simulation.profile().truncated_count == truncated)
            EXPECT_LT(length(sum - simulation.load_on(0).force), 1e-9 * weight) << i;
        if (i >= 285) at_rest += sum * (1.0 / 15);
    }
    EXPECT_NEAR(at_rest.z, -weight, 0.01 * weight);
    simulation.record_contacts(false);
    simulation.step();
    EXPECT_TRUE(simulation.contact_points().empty());
}

TEST(ContactPoints, BetweenTwoLayersSumToTheWeightOfTheUpperOne) {
    const Deformable lower = sheet_at(0.07, 0.6, 9), upper = sheet_at(0.1, 0.4, 7);
    Simulation simulation(combine(std::array{lower, upper}), colliders_of({make_box({2, 2, 0.1})}),
                          kMeasured);
    simulation.record_contacts(true);
    const auto is_upper = [&](std::uint32_t particle) { return particle >= lower.particle_count(); };
    for (int i = 0; i < 150; ++i) simulation.step();
    double between = 0;
    for (int i = 0; i < 30; ++i) {
        simulation.step();
        for (const ContactPoint& point : simulation.contact_points()) {
            if (point.collider != kNoIndex) continue;
            ASSERT_NE(is_upper(point.particles.front()), is_upper(point.particles.back()));
            const double turn = is_upper(point.particles.front()) ? 1 : -1;
            between += turn * force_of(point, simulation.options().time_step).z / 30;
        }
    }
    const double weight = 0.4 * 0.4 * simulation.options().newton().material.density * kStandardGravity;
    EXPECT_NEAR(between, weight, 0.01 * weight);
}
