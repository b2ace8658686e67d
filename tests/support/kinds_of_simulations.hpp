#pragma once

#include "support/custom_maps.hpp"
#include "support/draping.hpp"
#include "support/meshes.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// One small simulation of each kind, for what must hold for all of them.
namespace echinus::test {

struct KindOfSimulation {
    std::string name;
    Deformable deformable;
    std::vector<Collider> colliders;
    SimulationOptions options;
    /// Sets, once after it was made, what options do not.
    std::function<void(Simulation&)> begin = [](Simulation&) {};
    /// Steers it before each frame, as a host does.
    std::function<void(Simulation&)> steer = [](Simulation&) {};

    Simulation make(unsigned thread_count = 1) const {
        SimulationOptions with_threads = options;
        with_threads.thread_count = thread_count;
        Simulation simulation(deformable, colliders, with_threads);
        begin(simulation);
        return simulation;
    }
    void step(Simulation& simulation) const {
        steer(simulation);
        simulation.step();
    }
};

/// A ball that is pressed flat and lets go again.
inline TriangleMesh breathing_ball(double seconds) {
    TriangleMesh ball = make_sphere(0.35, 20, 10);
    const auto share = static_cast<float>(1 + 0.2 * std::sin(12 * seconds));
    for (Vec3f& v : ball.vertices) v = {v.x * share, v.y * share, v.z / share};
    return ball;
}

inline VertexCache breathing_cache() {
    std::vector<Vec3f> samples;
    for (int i = 0; i < 12; ++i) {
        const TriangleMesh ball = breathing_ball(0.04 * i);
        samples.insert(samples.end(), ball.vertices.begin(), ball.vertices.end());
    }
    return {.sample_seconds = 0.04,
            .vertex_count = breathing_ball(0).vertices.size(),
            .samples = std::make_shared<const std::vector<Vec3f>>(std::move(samples))};
}

inline SimulationOptions surfaces_for_kinds(bool self) {
    return {.solver =
                NewtonOptions{.collision = self ? CollisionMode::SurfacesAndSelf : CollisionMode::Surfaces},
            .thickness = 0.01};
}

/// Particles by the paper's method beside maps of all kinds, which move, in wind; one is attached, one begins
/// inside, and one collider is far away at first.
inline KindOfSimulation jakobsens_particles() {
    KindOfSimulation kind{.name = "particles by Jakobsen's method",
                          .deformable = sheet_at(0.3, 1, 21, {0, 0, 1.2}),
                          .colliders = {},
                          .options = jakobsen({.thickness = 0.01}),
                          .steer = [](Simulation& s) {
                              s.blow({0.5, 0, 0}, 1);
                          }};
    kind.deformable.positions[7] = {0, 0, -0.1F};
    kind.deformable.inverse_masses[0] = 0;
    kind.deformable.attachments.push_back({0, 0});
    kind.colliders = {{.map = ExactMap::build(make_torus(0.3, 0.15, 24, 12)), .angular_velocity = {0, 3, 0}},
                      {.map = DistanceMap::build(make_sphere(0.2, 20, 10)), .pose = {{}, {0.4, 0.4, 0}}},
                      {.map = std::make_shared<AnalyticBall>(0.2F), .pose = {{}, {-0.4, -0.4, 0}}},
                      {.map = ExactMap::build(make_box({0.2, 0.2, 0.2})),
                       .pose = {{}, {0, 0, 3}},
                       .linear_velocity = {0, 0, -8}}};
    return kind;
}

/// The same of a continuous material.
inline KindOfSimulation continuous_materials_particles() {
    KindOfSimulation kind = jakobsens_particles();
    kind.name = "particles of a continuous material";
    kind.options = {.solver = NewtonOptions{.collision = CollisionMode::Particles}, .thickness = 0.01};
    return kind;
}

/// Colliders that turn, follow keys or are away, below a sheet that folds onto itself.
inline KindOfSimulation sheet_among_moving_colliders() {
    std::vector<PoseKey> keys;
    for (int i = 0; i < 8; ++i)
        keys.push_back({0.1 * i, {Rotation::about({0, 1, 1}, 0.5 * i), {0.4, 0.2 * (i % 2), -0.2}}});
    KindOfSimulation kind{.name = "a sheet among colliders that move",
                          .deformable = sheet_at(0.25, 1.2, 19, {0, 0, 2.4}),
                          .colliders = colliders_of({make_sphere(0.15, 20, 10), make_box({0.2, 0.2, 0.2}, 2),
                                                     make_box({0.1, 0.1, 0.1})}),
                          .options = surfaces_for_kinds(true),
                          .begin = [keys](Simulation& s) { s.set_collider_keyframes(1, keys); }};
    kind.colliders[0].angular_velocity = {1, 0, 4};
    kind.colliders[1].pose = pose_at(keys, 0);
    kind.colliders[2].pose.translation = {0, 0, 9};
    return kind;
}

/// Two bodies, one of which falls on the other.
inline KindOfSimulation soft_bodies() {
    const TetrahedralMesh box = make_solid_box({0.2, 0.2, 0.2}, {4, 4, 4});
    const std::vector<Deformable> bodies{
        make_soft_body(box, {.young_modulus = 2e4, .damping = 0.01, .pose = {{}, {0, 0, 0.12}}}),
        make_soft_body(box,
                       {.young_modulus = 1e4, .pose = {Rotation::about({1, 1, 0}, 0.4), {0.05, 0, 0.4}}})};
    KindOfSimulation kind{.name = "soft bodies",
                          .deformable = combine(bodies),
                          .colliders = colliders_of({make_box({1, 1, 0.03}, 4)}),
                          .options = surfaces_for_kinds(true)};
    kind.options.thickness = 0.004;
    return kind;
}

/// A sheet on a ball whose vertices a host leads, to which some particles are attached, beside one that
/// follows a cache.
inline KindOfSimulation sheet_on_deforming_balls() {
    KindOfSimulation kind{.name = "a sheet on balls that deform",
                          .deformable = sheet_at(0.4, 1, 19),
                          .colliders = colliders_of({breathing_ball(0), breathing_ball(0)}),
                          .options = surfaces_for_kinds(true),
                          .begin = [](Simulation& s) { s.set_collider_cache(1, breathing_cache()); },
                          .steer =
                              [](Simulation& s) {
                                  const double next = (s.frame() + 1) * s.options().time_step;
                                  s.set_collider_vertices(0, breathing_ball(next).vertices);
                              }};
    kind.colliders[1].pose.translation = {0.55, 0.55, -0.2};
    kind.colliders[1].angular_velocity = {0, 0, 1};
    for (const std::uint32_t particle : {180u, 181u}) {
        kind.deformable.inverse_masses[particle] = 0;
        kind.deformable.attachments.push_back({particle, 0});
    }
    return kind;
}

/// One of two sheets falls through the box on which the other lands, far from the origin.
inline KindOfSimulation sheet_that_passes_through() {
    std::vector<Deformable> sheets(2, sheet_at(0.2, 1, 13));
    for (Vec3f& p : sheets[0].positions) p = p + Vec3f(0, 0, 0.1F);
    KindOfSimulation kind{.name = "a sheet that a model lets through",
                          .deformable = combine(std::vector{sheets[0], passing_through(1, sheets[1])}),
                          .colliders = colliders_of({make_box({3, 3, 0.1}), make_box({0.5, 0.5, 0.2}, 4)}),
                          .options = surfaces_for_kinds(true)};
    const Vec3f far(300, 200, -400);
    for (Vec3f& p : kind.deformable.positions) p = p + far;
    for (Collider& collider : kind.colliders) collider.pose.translation = Vec3d(far);
    kind.colliders[0].pose.translation.z -= 0.4;
    return kind;
}

/// A sheet on a box that turns, in wind, of which a corner is attached to the box.
inline KindOfSimulation sheet_on_a_turning_box() {
    SimulationOptions options = surfaces_for_kinds(true);
    KindOfSimulation kind{.name = "a sheet on a box that turns",
                          .deformable = sheet_at(0.11, 0.6, 13),
                          .colliders = colliders_of({make_box({0.4, 0.4, 0.2}, 3)}),
                          .options = options,
                          .steer = [](Simulation& s) {
                              s.blow({0.5, 0, 0}, 1);
                          }};
    kind.colliders[0].angular_velocity = {0, 0, 2};
    kind.deformable.inverse_masses[84] = 0;
    kind.deformable.attachments.push_back({84, 0});
    return kind;
}

/// A sheet whose corners are led and let go, and which is set elsewhere with its ball meanwhile; a light box
/// falls on it beside the ball.
inline KindOfSimulation sheet_that_is_led_and_set_elsewhere() {
    KindOfSimulation kind{.name = "a sheet that is led, let go and set elsewhere",
                          .deformable = sheet_at(0.25, 0.6, 13),
                          .colliders =
                              colliders_of({make_sphere(0.15, 20, 10), make_box({0.2, 0.2, 0.2}, 2)}),
                          .options = surfaces_for_kinds(true),
                          .begin = [](Simulation& s) {
                              s.set_collider_free(1, 0.2);
                              for (const double time : {0.1, 0.4})
                                  s.teleport({.motion = {Rotation::about({0, 0, 1}, 0.4), {0.1, 0, 0}},
                                              .colliders = {0},
                                              .time = time});
                          }};
    kind.colliders[1].pose.translation = {0.25, -0.2, 0.45};
    kind.colliders[1].angular_velocity = {1, 0, 2};
    kind.deformable.handles = {{{0, 1, 13}, {{0, {}}, {1, {{}, {0.3, 0, 0}}}}, 0.3},
                               {{12}, {{0, {}}, {1, {{}, {0, 0, 0.3}}}}}};
    return kind;
}

inline std::vector<KindOfSimulation> kinds_of_simulations() {
    return {jakobsens_particles(),          continuous_materials_particles(),
            sheet_among_moving_colliders(), soft_bodies(),
            sheet_on_deforming_balls(),     sheet_that_passes_through(),
            sheet_on_a_turning_box(),       sheet_that_is_led_and_set_elsewhere()};
}

} // namespace echinus::test
