// Contact of surfaces: no face of the deformable ever meets a model. Every frame is judged exactly.

#include "support/custom_maps.hpp"
#include "support/draping.hpp"
#include "support/instruction_sets.hpp"
#include "support/meshes.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr double kSurfaceThickness = 0.01;
const SimulationOptions kSurfaces{.solver = NewtonOptions{.collision = CollisionMode::Surfaces},
                                  .thickness = kSurfaceThickness};

/// A tetrahedron two units high and a hundredth wide, its tip in the origin.
TriangleMesh needle() {
    return {{{0, 0, 0}, {0.01F, 0, -2}, {-0.005F, 0.008F, -2}, {-0.005F, -0.008F, -2}},
            {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
}

/// Without the faces whose middle does not satisfy a condition.
template <typename Keeps>
TriangleMesh part_of(TriangleMesh mesh, const Keeps& keeps) {
    std::erase_if(mesh.faces, [&](const Triangle& face) {
        return !keeps((mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) *
                      (1.0F / 3));
    });
    return weld(mesh);
}

TriangleMesh half_ball(bool upper) {
    return part_of(make_sphere(0.5, 20, 10), [=](const Vec3f& p) { return (p.z > 0) == upper; });
}

struct Placement {
    RigidTransform pose{};
    Vec3d scale{1, 1, 1};
    Vec3d linear_velocity{}, angular_velocity{};
};

/// A sheet falls on a model.
void expect_falls_without_meeting(const TriangleMesh& model, const Placement& placement,
                                  const Deformable& sheet, std::uint32_t frame_count) {
    const auto& [pose, scale, linear, angular] = placement;
    Simulation simulation(sheet, {{ExactMap::build(model), pose, scale, linear, angular}}, kSurfaces);
    expect_nothing_meets(simulation, {model}, frame_count);
}

} // namespace

TEST(SurfaceContact, KeepsASheetOffABall) {
    expect_falls_without_meeting(make_sphere(0.4, 24, 12), {}, sheet_at(0.42, 1.2, 25, {0, 0, -2.4}), 37);
}

TEST(SurfaceContact, KeepsASheetOffTheEdgeOfAThinPlate) {
    expect_falls_without_meeting(make_box({0.003, 1, 1}), {}, sheet_at(0.52, 1, 20, {0, 0, -2.4}), 30);
}

TEST(SurfaceContact, KeepsASheetOffThePointOfANeedle) {
    Deformable sheet = sheet_at(0.03, 1, 20, {0, 0, -2.4});
    for (const float shift : {0.0F, 0.011F}) {
        for (Vec3f& p : sheet.positions) p += Vec3f{shift, shift / 3, 0};
        expect_falls_without_meeting(needle(), {}, sheet, 30);
    }
}

TEST(SurfaceContact, KeepsASheetOffTheTeethOfAComb) {
    const Rotation upright = Rotation::about({1, 0, 0}, std::numbers::pi / 2);
    expect_falls_without_meeting(make_comb(8), {.pose = {upright, {-0.5, 0, -0.5}}},
                                 sheet_at(0.03, 1.1, 20, {0, 0, -2.4}), 37);
}

TEST(SurfaceContact, KeepsASheetOffABoxThatTurns) {
    const double turn_per_second = 2 * std::numbers::pi;
    for (const Vec3d& axis : {Vec3d{0, 0, 1}, Vec3d{1, 0.3, 0}})
        expect_falls_without_meeting(make_box({0.6, 0.4, 0.3}), {.angular_velocity = axis * turn_per_second},
                                     sheet_at(0.4, 1, 20), 50);
}

/// Seven thicknesses a frame, over a side cut into hundreds of faces. Without friction nothing stops it.
TEST(SurfaceContact, LetsASheetSlideOverTheEdgesWithinAFlatSide) {
    constexpr double kThin = 0.003, kSpeed = 5;
    Deformable sheet = sheet_at(0.0535, 0.2, 8, {kSpeed, 0, 0});
    Simulation simulation(sheet, colliders_of({make_box({20, 2, 0.1}, 40)}),
                          {.solver = NewtonOptions{.air_drag = 0}, .thickness = kThin, .friction = 0});
    for (int i = 0; i < 30; ++i) simulation.step();
    for (std::size_t i = 0; i < sheet.particle_count(); ++i) {
        const Vec3f way = simulation.positions()[i] - sheet.positions[i];
        EXPECT_NEAR(way.x, 0.5 * kSpeed, 2e-3 * kSpeed) << i;
        EXPECT_GT(0.0535 + way.z, 0.05) << i;
        EXPECT_LT(0.0535 + way.z, 0.05 + kThin + 1e-4) << i;
    }
}

TEST(SurfaceContact, KeepsASheetOffScaledAndMirroredModels) {
    const Rotation tilt = Rotation::about({1, 1, 0}, 0.4);
    for (const Vec3d& scale : {Vec3d{0.4, 0.6, 0.2}, Vec3d{-0.5, 0.3, 0.4}, Vec3d{0.1, -0.6, -0.4}})
        expect_falls_without_meeting(make_torus(1, 0.4, 24, 10),
                                     {.pose = {tilt, {0, 0, -0.4}}, .scale = scale},
                                     sheet_at(0.35, 1, 20, {0, 0, -2.4}), 37);
}

TEST(SurfaceContact, KeepsASheetOffTheFacesOfAModelWhateverTheMapBesideThemSays) {
    const TriangleMesh ball = make_sphere(0.4, 24, 12);
    const Contact nonsense{.point = {0.3F, 0, -0.2F}, .normal = {0, 1, 0}, .depth = 0.5F, .inside = true};
    for (ColliderMap map :
         {ColliderMap(DistanceMap::build(ball)), ColliderMap(std::make_shared<AnalyticBall>(0.4F)),
          ColliderMap(std::make_shared<ConstantAnswer>(nonsense))}) {
        map.surface = ExactMap::build(ball);
        Simulation simulation(sheet_at(0.42, 1.2, 25, {0, 0, -2.4}), {{.map = map}}, kSurfaces);
        expect_nothing_meets(simulation, {ball}, 15);
    }
}

TEST(SurfaceContact, KeepsASheetOffTwoModelsOfWhichOneMoves) {
    const std::vector<TriangleMesh> models{make_sphere(0.3, 20, 10), make_box({0.2, 0.2, 0.2})};
    for (const std::size_t moving : {0u, 1u}) {
        std::vector<Collider> colliders = colliders_of(models);
        colliders[1].pose.translation = {0.65, 0, 0};
        colliders[moving].linear_velocity = {0, 0, 0.5};
        colliders[moving].angular_velocity = {0, 1, 2};
        Simulation simulation(sheet_at(0.4, 1.6, 25), colliders, kSurfaces);
        expect_nothing_meets(simulation, models, 37);
    }
}

TEST(SurfaceContact, KeepsAFastSheetOffAModel) {
    for (const double speed : {20.0, 50.0})
        expect_falls_without_meeting(make_torus(0.4, 0.15, 24, 10), {},
                                     sheet_at(0.3, 1.2, 25, {0, 0, -speed}), 20);
}

TEST(SurfaceContact, KeepsACoarseSheetOffAModelThatIsSmallerThanItsFaces) {
    for (const TriangleMesh& model : {make_sphere(0.1, 12, 6), make_box({0.05, 0.05, 0.4})})
        expect_falls_without_meeting(model, {}, sheet_at(0.3, 2, 6, {0.72, 0.48, -4.8}), 30);
}

TEST(SurfaceContact, KeepsAPinnedSheetOffAModelThatIsPushedIntoIt) {
    Deformable sheet = sheet_at(0.3, 1, 20);
    for (const std::size_t corner : {0u, 19u, 380u, 399u}) sheet.inverse_masses[corner] = 0;
    expect_falls_without_meeting(make_sphere(0.2, 20, 10), {.linear_velocity = {0, 0, 1}}, sheet, 20);
}

TEST(SurfaceContact, KeepsAThreadOverTheEdgeOfABox) {
    Deformable thread;
    for (int i = 0; i <= 20; ++i) thread.positions.push_back({0.1F * float(i) - 1, 0.013F * float(i), 0.3F});
    for (std::uint32_t i = 0; i < 20; ++i)
        thread.constraints.push_back(
            {i, i + 1, length(thread.positions[1] - thread.positions[0]), ConstraintKind::Structural});
    thread.inverse_masses.assign(thread.particle_count(), 1);
    expect_falls_without_meeting(make_box({0.5, 0.5, 0.5}), {}, thread, 75);
}

TEST(SurfaceContact, LeavesASheetOverAThinPostLittleStretched) {
    Simulation simulation(make_cloth({.column_count = 31,
                                      .row_count = 31,
                                      .width = 1.2,
                                      .height = 1.2,
                                      .pose = {{}, {0.02, 0.01, 0.52}}}),
                          colliders_of({make_box({0.04, 0.04, 1})}), kSurfaces);
    for (int frame = 0; frame < 40; ++frame) simulation.step();
    const Deformable& sheet = simulation.deformable();
    double largest = 0;
    for (const DistanceConstraint& constraint : sheet.constraints)
        if (constraint.kind == ConstraintKind::Structural)
            largest = std::max(largest,
                               double{length(sheet.positions[constraint.b] - sheet.positions[constraint.a])} /
                                   constraint.rest_length);
    EXPECT_LT(largest, 1.2);
}

TEST(SurfaceContact, CarriesALargeSheetOnAThinPostByContactAlone) {
    // Two contacts carry hundreds of particles: none is pressed to where it would have to be stopped.
    SimulationOptions options{.solver = NewtonOptions{.collision = CollisionMode::Surfaces},
                              .thickness = 0.008};
    options.newton().air_drag = 1;
    Simulation simulation(sheet_at(0.51, 2.2, 31), colliders_of({make_box({0.02, 0.02, 1})}), options);
    for (int frame = 0; frame < 80; ++frame) simulation.step();
    const std::uint64_t before = simulation.profile().truncated_count;
    for (int frame = 0; frame < 20; ++frame) simulation.step();
    EXPECT_EQ(simulation.profile().truncated_count, before);
    EXPECT_LT(simulation.residual().largest, 0.05);
}

TEST(SurfaceContact, KeepsASheetOnEitherSideOfAnOpenSurface) {
    // Above a dome, and in a bowl, whose inside is where the sheet is.
    expect_falls_without_meeting(half_ball(true), {}, sheet_at(0.55, 1.2, 19, {0, 0, -2.4}), 40);
    expect_falls_without_meeting(half_ball(false), {}, sheet_at(0.05, 0.7, 15, {0, 0, -2.4}), 40);
}

TEST(SurfaceContact, KeepsASheetOffASurfaceWithHoles) {
    TriangleMesh torus = make_torus(0.4, 0.2, 20, 10);
    std::vector<Triangle> faces;
    for (std::size_t f = 0; f < torus.faces.size(); ++f)
        if (f % 5 != 0) faces.push_back(torus.faces[f]);
    torus.faces = faces;
    expect_falls_without_meeting(torus, {}, sheet_at(0.25, 1.2, 25, {0, 0, -4.8}), 50);
    expect_falls_without_meeting(torus, {.angular_velocity = {3, 0, 2}}, sheet_at(0.75, 1.2, 25), 50);
}

TEST(SurfaceContact, LeavesFreeFallAsItIs) {
    const std::vector<Collider> ball = colliders_of({make_sphere(0.4, 24, 12)});
    Simulation surfaces(sheet_at(0.6, 1, 20), ball, kSurfaces);
    Simulation alone(sheet_at(0.6, 1, 20), {}, {.thickness = kSurfaceThickness});
    for (int i = 0; i < 10; ++i) {
        surfaces.step();
        alone.step();
        ASSERT_EQ(surfaces.state_hash(), alone.state_hash());
    }
    ASSERT_EQ(surfaces.profile().contact_count, 0u);
}

TEST(SurfaceContact, LetsASheetFallOnAModelFarFromTheOriginAsNearIt) {
    double at_the_origin = 0;
    for (const double far : {0.0, 300.0, 3000.0}) {
        Deformable sheet = sheet_at(0.05, 1, 15);
        for (Vec3f& p : sheet.positions) p = Vec3f(Vec3d(p) + Vec3d{far, -far, far});
        std::vector<Collider> colliders = colliders_of({make_box({0.5, 0.5, 0.02}, 4)});
        colliders[0].pose.translation = {far, -far, far};
        Simulation simulation(sheet, colliders, kSurfaces);
        for (int frame = 0; frame < 6; ++frame) simulation.step();
        const double corner = double{simulation.positions().front().z} - far;
        if (far == 0) at_the_origin = corner;
        EXPECT_NEAR(corner, at_the_origin, 0.003) << far;
        EXPECT_LT(corner, 0.02) << far;
        EXPECT_EQ(simulation.profile().unresolved_count, 0U);
    }
}

TEST(SurfaceContact, ComesToRestWithHardlyAVertexTruncatedAndAtItsThickness) {
    const std::vector<Collider> ball = colliders_of({make_sphere(1, 48, 24)});
    SimulationOptions options = kSurfaces;
    options.newton().air_drag = 2; // its corners would swing for long without air around them
    Simulation simulation(sheet_at(1.05, 2, 21), ball, options);
    run_to_rest(simulation, 400);
    const std::uint64_t before = simulation.profile().truncated_count;
    for (int i = 0; i < 15; ++i) simulation.step();
    EXPECT_EQ(simulation.profile().truncated_count, before);
    double sum = 0;
    int count = 0;
    for (const Vec3f& p : simulation.positions()) {
        const Contact near = contact(ball[0], p, float(2 * kSurfaceThickness));
        if (!near.found()) continue;
        sum += double{-near.depth};
        ++count;
    }
    ASSERT_GT(count, 50);
    EXPECT_LE(sum / count, 1.2 * kSurfaceThickness);
    EXPECT_GE(sum / count, 0.5 * kSurfaceThickness);
}

TEST(SurfaceContact, SlidesDownASlopeAsCoulombSays) {
    const ColliderMap box = ExactMap::build(make_box({2, 2, 1}));
    for (const double degrees : {35.0, 45.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        // In half a second, with the friction 0.5.
        const double expected = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle)) * 0.5 * 0.5 / 2;
        EXPECT_NEAR(
            slid_down_slope(box, angle,
                            {.solver = NewtonOptions{.air_drag = 0, .collision = CollisionMode::Surfaces}}),
            expected, 0.1 * expected);
    }
}

TEST(SurfaceContact, GivesTheSameBitsOnEveryRunAndEveryInstructionSet) {
    const std::vector<Collider> colliders = colliders_of({make_torus(0.4, 0.15, 24, 10)});
    SimulationOptions options = kSurfaces;
    options.newton().collision = CollisionMode::SurfacesAndSelf;
    std::vector<std::uint64_t> hashes;
    const auto run = [&](std::string_view) {
        Simulation simulation(sheet_at(0.2, 1.2, 17, {0, 0, -4.8}), colliders, options);
        for (int i = 0; i < 15; ++i) simulation.step();
        hashes.push_back(simulation.state_hash());
    };
    run("");
    under_each_instruction_set(run);
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(SurfaceContact, IsIndependentInACopy) {
    SimulationOptions options = kSurfaces;
    options.newton().collision = CollisionMode::SurfacesAndSelf;
    auto original = std::make_unique<Simulation>(sheet_at(0.2, 1.2, 20, {0, 0, -4.8}),
                                                 colliders_of({make_torus(0.4, 0.15, 24, 10)}), options);
    for (int i = 0; i < 8; ++i) original->step();
    Simulation copy = *original;
    Simulation changed = *original;
    changed.set_particle_velocity(0, {0, 0, 5});
    for (int i = 0; i < 8; ++i) {
        original->step();
        changed.step();
    }
    const std::uint64_t expected = original->state_hash();
    EXPECT_NE(changed.state_hash(), expected);
    original.reset();
    for (int i = 0; i < 8; ++i) copy.step();
    EXPECT_EQ(copy.state_hash(), expected);
}

TEST(SurfaceContact, KeepsALedParticleBeforeWhatItCannotPassAndLetsItCatchUp) {
    // A corner of the sheet is led into a box by another collider, far away, and back.
    const std::vector<TriangleMesh> models{make_box({0.2, 1, 1}), make_box({0.1, 0.1, 0.1})};
    std::vector<Collider> colliders = colliders_of(models);
    colliders[1].pose.translation = {0, 0, 5};
    Deformable sheet = sheet_at(0, 0.3, 8);
    for (Vec3f& p : sheet.positions) p += Vec3f{0.4F, 0, 0};
    sheet.inverse_masses[0] = 0;
    sheet.attachments = {{0, 1}};
    Simulation simulation(sheet, colliders, kSurfaces);
    const double start = double{sheet.positions[0].x};
    const auto lead = [&](double speed) {
        simulation.set_collider_velocity(1, {speed, 0, 0}, {});
        for (int i = 0; i < 15; ++i) {
            simulation.step();
            ASSERT_TRUE(meeting_faces(simulation, models).empty());
        }
    };
    lead(-2);
    EXPECT_GT(double{simulation.positions()[0].x}, 0.1);
    lead(2);
    EXPECT_NEAR(double{simulation.positions()[0].x}, start, 1e-5);
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
}

TEST(SurfaceContact, PushesAPinAsideAndLetsItGoBack) {
    // A box passes over a pinned corner.
    const std::vector<TriangleMesh> models{make_box({0.2, 0.2, 0.2})};
    std::vector<Collider> colliders = colliders_of(models);
    colliders[0].pose.translation = {-0.15, -0.15, 0.4};
    colliders[0].linear_velocity = {0, 0, -1};
    Deformable sheet = sheet_at(0, 0.3, 8);
    sheet.inverse_masses[0] = 0;
    Simulation simulation(sheet, colliders, kSurfaces);
    float lowest = 0;
    for (int i = 0; i < 60; ++i) {
        if (i == 30) simulation.set_collider_velocity(0, {0, 0, 1}, {});
        simulation.step();
        lowest = std::min(lowest, simulation.positions()[0].z);
        ASSERT_TRUE(meeting_faces(simulation, models).empty());
    }
    EXPECT_LT(lowest, -0.05F);
    EXPECT_EQ(simulation.positions()[0], sheet.positions[0]);
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
}

TEST(SurfaceContact, CountsAsUnresolvedWhatTwoModelsHavePressedInside) {
    const std::vector<TriangleMesh> models{make_box({1, 1, 0.6}), make_box({1, 1, 0.6})};
    std::vector<Collider> colliders = colliders_of(models);
    for (const std::size_t i : {0u, 1u}) {
        const double side = i == 0 ? 1 : -1;
        colliders[i].pose.translation = {0, 0, side * 0.35};
        colliders[i].linear_velocity = {0, 0, side * -0.5};
    }
    SimulationOptions options = kSurfaces;
    options.gravity = {};
    Simulation simulation(sheet_at(0, 0.5, 8), colliders, options);
    std::uint64_t most_inside = 0;
    for (int i = 0; i < 30; ++i) {
        simulation.step();
        std::uint64_t inside = 0;
        for (const Collider& collider : simulation.colliders())
            for (const Vec3f& p : simulation.positions()) inside += contains(collider, p) ? 1 : 0;
        if (inside > 0) ASSERT_GT(simulation.profile().unresolved_count, 0u);
        most_inside = std::max(most_inside, inside);
        // They overlap by a fifth of a box, and part again.
        if (i == 15)
            for (const std::size_t c : {0u, 1u})
                simulation.set_collider_velocity(c, {0, 0, c == 0 ? 0.5 : -0.5}, {});
    }
    EXPECT_GT(most_inside, 30u);
}

TEST(SurfaceContact, KeepsASheetOffAnAssemblyOfOpenParts) {
    const Deformable sheet = sheet_at(1.1, 1.6, 24, {0, 0, -4.8});
    expect_falls_without_meeting(assembly(60), {}, sheet, 30);
}

// In its notches a soup has no certain inside: particles may get in and be pushed out, but stay numbers.
TEST(SurfaceContact, OfParticlesOnlyKeepsPositionsFiniteOnASoup) {
    const TriangleMesh soup = exploded(make_torus(1, 0.4, 24, 12), 0.97F);
    Simulation simulation(sheet_at(0.5, 1.6, 10, {0, 0, -4.8}), {{ExactMap::build(soup)}},
                          jakobsen({.thickness = kSurfaceThickness, .allow_open_colliders = true}));
    for (int frame = 0; frame < 60; ++frame) simulation.step();
    for (const Vec3f& p : simulation.positions()) ASSERT_TRUE(is_finite(p));
}

TEST(SurfaceContact, LetsAPieceFallFreelyThatTouchesNothingWhileAnotherIsSqueezed) {
    // Two plates leave a twentieth of the thickness to a sheet that is crumpled between them.
    const auto squeezed = [](bool with_squeezed) {
        std::vector<Collider> plates = colliders_of({make_box({1, 1, 0.1}, 3), make_box({1, 1, 0.1}, 3)});
        plates[0].pose.translation.z = -0.15;
        plates[1].pose.translation.z = 0.15;
        plates[1].linear_velocity = {0, 0, -0.2};
        Deformable falling = sheet_at(5, 0.4, 8);
        for (Vec3f& p : falling.positions) p.x += 4;
        std::vector<Deformable> pieces;
        if (with_squeezed) pieces.push_back(sheet_at(0, 0.5, 10, {0, 0, 0.6}));
        pieces.push_back(falling);
        return Simulation(combine(pieces), plates, {.thickness = 0.01});
    };
    Simulation alone = squeezed(false), beside = squeezed(true);
    const std::size_t first = beside.positions().size() - alone.positions().size();
    for (int i = 0; i < 90; ++i) {
        alone.step();
        beside.step();
    }
    EXPECT_GT(beside.profile().truncated_count, 0u);
    for (std::size_t i = 0; i < alone.positions().size(); ++i)
        EXPECT_LT(length(beside.positions()[first + i] - alone.positions()[i]), 0.01F) << i;
}
