// Contact of a deformable with itself: no two of its faces ever meet. Every frame is judged exactly.

#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

const SimulationOptions kSelf{.thickness = 0.01};

/// Cloth that hardly resists being folded.
SimulationOptions limp() {
    SimulationOptions options = kSelf;
    options.newton().material.bending_stiffness = 1e-6;
    return options;
}

/// A layer along x at the height z, folded upwards about an edge at x = 0 in a half circle.
/// @param radius  of the inner side; the layer lies up to `thickest` above z = 0
/// @param true_radius  where lengths stay as they are
Vec3f folded(float x, float y, float z, float radius, float thickest, float true_radius) {
    const float axis = radius + thickest, arc = std::numbers::pi_v<float> / 2 * true_radius;
    if (x <= -arc) return {x + arc, y, z};
    if (x >= arc) return {arc - x, y, 2 * axis - z};
    const float angle = (x + arc) / (2 * arc) * std::numbers::pi_v<float>;
    return {(axis - z) * std::sin(angle), y, axis - (axis - z) * std::cos(angle)};
}

/// A square sheet of four layers, at rest when it lies flat.
Deformable folded_in_four(std::uint32_t count, float height) {
    TriangleMesh mesh = sheet_mesh(count, count);
    const std::vector<Vec3f> flat = mesh.vertices;
    for (Vec3f& v : mesh.vertices) {
        const Vec3f once = folded(v.x, v.y, 0, 0.04F, 0, 0.04F);
        const Vec3f twice = folded(once.y, once.x, once.z, 0.04F, 0.08F, 0.04F);
        v = {twice.x, twice.y, twice.z + height};
    }
    return make_cloth(mesh, {.rest_vertices = flat});
}

/// A sheet that begins with folds sharper than it can keep, half circles of two and three edges: stretched by
/// a half.
Deformable knotted(const Vec3d& velocity) {
    Deformable sheet = make_cloth({.column_count = 40, .row_count = 40, .width = 1.6, .height = 1.6});
    sheet.rest_positions = sheet.positions;
    const float gap = 1.25F * 1.6F / 39;
    for (Vec3f& p : sheet.positions) {
        p = folded(p.x, p.y, p.z, 0.5F * gap, 0, 0.5F * gap);
        p = folded(p.y, p.x, p.z, 0.5F * gap, gap, gap);
    }
    sheet.velocities.assign(sheet.particle_count(), Vec3f(velocity));
    return sheet;
}

Vec3d mean_of(std::span<const Vec3f> points) {
    Vec3d sum;
    for (const Vec3f& p : points) sum += Vec3d(p);
    return sum * (1 / static_cast<double>(points.size()));
}

/// A net whose border is pinned, 13 x 13 vertices and a metre wide.
Deformable pinned_net() {
    constexpr std::uint32_t kSide = 13;
    Deformable net = sheet_at(0, 1, kSide);
    for (std::uint32_t row = 0; row < kSide; ++row)
        for (std::uint32_t column = 0; column < kSide; ++column)
            if (row % (kSide - 1) == 0 || column % (kSide - 1) == 0)
                net.inverse_masses[row * kSide + column] = 0;
    return net;
}

constexpr double kThin = 0.003;

/// [frame] where the middle of a deformable is that slides along x over a layer that is pinned, beginning
/// with its start.
std::vector<Vec3d> slid_over(Deformable layer, Deformable slider, double speed, double seconds,
                             SimulationOptions options) {
    options.newton().air_drag = 0;
    options.thickness = options.newton().self_thickness = kThin;
    for (float& inverse_mass : layer.inverse_masses) inverse_mass = 0;
    slider.velocities.assign(slider.particle_count(), {static_cast<float>(speed), 0, 0});
    const std::size_t first = layer.particle_count();
    const std::vector<Deformable> parts{layer, slider};
    Simulation simulation(combine(parts), {}, options);
    const auto middle = [&] {
        Vec3d sum;
        for (std::size_t i = first; i < simulation.positions().size(); ++i)
            sum += Vec3d(simulation.positions()[i]);
        return sum * (1 / static_cast<double>(slider.particle_count()));
    };
    std::vector<Vec3d> middles{middle()};
    while (simulation.frame() * options.time_step < seconds) {
        simulation.step();
        middles.push_back(middle());
    }
    EXPECT_EQ(self_intersecting_pairs(surface_of(simulation.deformable())).size(), 0u);
    return middles;
}

std::vector<Vec3d> sheet_slid_over_sheet(double speed, double friction, double seconds) {
    const Deformable layer = make_cloth(
        {.column_count = 61, .row_count = 13, .width = 3, .height = 0.6, .pose = {Rotation{}, {1.2, 0, 0}}});
    return slid_over(layer, sheet_at(1.05 * kThin, 0.2, 8), speed, seconds, {.friction = friction});
}

std::vector<Vec3d> block_slid_over_block(double speed, double friction, double seconds) {
    const Deformable layer =
        make_soft_body(make_solid_box({3, 0.4, 0.1}, {30, 4, 1}), {.pose = {Rotation{}, {1.2, 0, -0.05}}});
    const Deformable block = make_soft_body(
        make_solid_box({0.15, 0.15, 0.15}, {4, 4, 4}),
        {.young_modulus = 1e5, .damping = 0.02, .pose = {Rotation{}, {0.013, 0.017, 0.075 + 1.05 * kThin}}});
    return slid_over(layer, block, speed, seconds, {.friction = friction});
}

double distance_of(const std::vector<Vec3d>& middles) {
    return middles.back().x - middles.front().x;
}

/// The coefficient of friction by which it is slower in the seventeenth frame than in the seventh, when it
/// has landed: what slows it over what carries it, of which rocking is a part.
double friction_of(const std::vector<Vec3d>& middles) {
    const auto velocity = [&](std::size_t frame) { return (middles[frame] - middles[frame - 1]) * 60; };
    const Vec3d gained = velocity(17) - velocity(7) + Vec3d{0, 0, 9.81 * 10 / 60};
    return -gained.x / gained.z;
}

/// Does it intersect itself where only contact with the model is looked for?
bool meets_itself_otherwise(const Deformable& deformable, const TriangleMesh& model, int frame_count) {
    SimulationOptions options = limp();
    options.newton().collision = CollisionMode::Surfaces;
    Simulation simulation(deformable, colliders_of({model}), options);
    for (int i = 0; i < frame_count; ++i) {
        simulation.step();
        if (!self_intersecting_pairs(surface_of(simulation.deformable())).empty()) return true;
    }
    return false;
}

} // namespace

TEST(SelfCollision, KeepsASheetThatFallsOverABallOffItself) {
    const TriangleMesh ball = make_sphere(0.2, 20, 10);
    Simulation simulation(sheet_at(0.25, 1.4, 25, {0, 0, -2.4}), colliders_of({ball}), kSelf);
    expect_nothing_meets(simulation, {ball}, 50);
}

TEST(SelfCollision, KeepsTheLayersOfAFoldedSheetApart) {
    const TriangleMesh table = make_box({2, 2, 0.1});
    Simulation simulation(folded_in_four(17, 0.1F), colliders_of({table}), limp());
    expect_nothing_meets(simulation, {table}, 62);
    EXPECT_TRUE(meets_itself_otherwise(folded_in_four(17, 0.1F), table, 62));
}

TEST(SelfCollision, KeepsABagThatIsThrownFlatOffItself) {
    const TriangleMesh table = make_box({2, 2, 0.1});
    TriangleMesh mesh = make_sphere(0.3, 20, 10);
    for (Vec3f& v : mesh.vertices) v += Vec3f{0, 0, 0.4F};
    Deformable bag = make_cloth(mesh, {});
    bag.velocities.assign(bag.particle_count(), {0, 0, -24});
    Simulation simulation(bag, colliders_of({table}), limp());
    expect_nothing_meets(simulation, {table}, 40);
    EXPECT_TRUE(meets_itself_otherwise(bag, table, 40));
}

TEST(SelfCollision, KeepsLooseSheetsThatFallOnEachOtherApart) {
    const TriangleMesh ball = make_sphere(0.3, 20, 10);
    Deformable sheets;
    for (int layer = 0; layer < 3; ++layer) {
        const Deformable sheet = sheet_at(0.35 + 0.05 * layer, 1, 11, {0, 0, -4.8 * layer});
        const auto offset = static_cast<std::uint32_t>(sheets.particle_count());
        for (const Vec3f& p : sheet.positions) sheets.positions.push_back(p);
        sheets.velocities.insert(sheets.velocities.end(), sheet.particle_count(), {0, 0, -4.8F * layer});
        for (const auto& [a, b, c] : sheet.faces)
            sheets.faces.push_back({a + offset, b + offset, c + offset});
        for (const auto& [a, b, rest, kind] : sheet.constraints)
            sheets.constraints.push_back({a + offset, b + offset, rest, kind});
    }
    sheets.inverse_masses.assign(sheets.particle_count(), 1);
    Simulation simulation(sheets, colliders_of({ball}), kSelf);
    expect_nothing_meets(simulation, {ball}, 40);
}

TEST(SelfCollision, KeepsACrumpledSheetOnATurningModelOffItself) {
    const TriangleMesh box = make_box({0.5, 0.2, 0.2});
    std::vector<Collider> colliders = colliders_of({box});
    colliders[0].angular_velocity = {0, 2 * std::numbers::pi, 0};
    Simulation simulation(sheet_at(0.3, 1, 20), colliders, kSelf);
    expect_nothing_meets(simulation, {box}, 62);
}

TEST(SelfCollision, KeepsAFastSheetOffItself) {
    const TriangleMesh torus = make_torus(0.4, 0.15, 24, 10);
    for (const double speed : {20.0, 50.0}) {
        Simulation simulation(sheet_at(0.3, 1.2, 20, {0, 0, -speed}), colliders_of({torus}), kSelf);
        expect_nothing_meets(simulation, {torus}, 25);
    }
}

TEST(SelfCollision, KeepsABallThatTwoPlatesCrushPoleFirstOffItself) {
    // The fans at its poles are folded between what lies on the floor and what the plate takes along.
    const std::vector<TriangleMesh> plates{make_box({1, 1, 0.1}), make_box({1, 1, 0.04})};
    std::vector<Collider> colliders = colliders_of(plates);
    colliders[1].pose.translation = {0, 0, 0.485};
    colliders[1].linear_velocity = {0, 0, -1};
    const Deformable ball = make_cloth(make_sphere(0.2, 24, 14), {.pose = {{}, {0, 0, 0.255}}});
    for (const double friction : {0.0, 0.5}) {
        Simulation simulation(ball, colliders, {.thickness = 0.004, .friction = friction});
        expect_nothing_meets(simulation, plates, 22);
        EXPECT_EQ(simulation.profile().unresolved_count, 0u);
    }
}

TEST(SelfCollision, KeepsAThreadOffItselfAndASheet) {
    // A thread falls end first, and coils up on a pinned sheet.
    Deformable both = sheet_at(0, 0.6, 9);
    for (float& inverse_mass : both.inverse_masses) inverse_mass = 0;
    const auto offset = static_cast<std::uint32_t>(both.particle_count());
    for (std::uint32_t i = 0; i < 20; ++i) {
        const float way = 0.05F * float(i);
        both.positions.push_back({0.013F + 0.1F * way, 0.02F + 0.03F * std::sin(3 * way), 0.1F + way});
        both.inverse_masses.push_back(1);
        if (i > 0)
            both.constraints.push_back({offset + i - 1, offset + i, 0.05F, ConstraintKind::Structural});
    }
    Simulation simulation(both, {}, kSelf);
    expect_nothing_meets(simulation, {}, 62);
}

TEST(SelfCollision, LeavesNoKnotInASheetThatHitsABallFast) {
    const TriangleMesh ball = make_sphere(0.2, 24, 12);
    Simulation simulation(sheet_at(0.3, 1.2, 19, {0, 0, -40}), colliders_of({ball}), kSelf);
    expect_nothing_meets(simulation, {ball}, 6);
    const std::uint64_t in_the_hit = simulation.profile().truncated_count;
    expect_nothing_meets(simulation, {ball}, 6);
    EXPECT_LT(simulation.residual().largest, 0.5);
    EXPECT_LT(simulation.profile().truncated_count, in_the_hit + in_the_hit / 20);
}

TEST(SelfCollision, OpensTheKnotOfASheetThatWasFoldedInFourTooSharply) {
    Simulation simulation(knotted({}), {}, {.gravity = {}});
    for (int frame = 0; frame < 40; ++frame) {
        simulation.step();
        ASSERT_TRUE(meeting_faces(simulation, {}).empty()) << frame;
    }
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
    EXPECT_LT(simulation.residual().largest, 0.2);
}

TEST(SelfCollision, LetsASheetWithoutFrictionSlideOverAnother) {
    for (const double speed : {0.3, 2.0, 5.0}) {
        const double way = 0.5 * speed;
        EXPECT_NEAR(distance_of(sheet_slid_over_sheet(speed, 0, 0.5)), way, 0.01 * way) << speed;
    }
}

TEST(SelfCollision, LetsASoftBodyWithoutFrictionSlideOverAnother) {
    for (const double speed : {0.3, 2.0}) {
        const double way = 0.5 * speed;
        EXPECT_NEAR(distance_of(block_slid_over_block(speed, 0, 0.5)), way, 0.01 * way) << speed;
    }
}

TEST(SelfCollision, BrakesWhatSlidesOverALayerAsFrictionSays) {
    EXPECT_NEAR(friction_of(sheet_slid_over_sheet(1, 0.3, 0.3)), 0.3, 0.02 * 0.3);
    // Pairs of edges at rest have tilted normals (docs/mechanics.md, limits), which add to it.
    EXPECT_NEAR(friction_of(block_slid_over_block(1, 0.3, 0.3)), 0.3, 0.08 * 0.3);
}

TEST(SelfCollision, LeavesTheFastFlightOfASheetAsItIs) {
    const auto flown = [](bool self) {
        SimulationOptions options = kSelf;
        options.newton().collision = self ? CollisionMode::SurfacesAndSelf : CollisionMode::Surfaces;
        Simulation simulation(sheet_at(30, 1, 20, {0, 0, -100}), colliders_of({make_sphere(0.2, 24, 12)}),
                              options);
        for (int i = 0; i < 15; ++i) simulation.step();
        return simulation;
    };
    EXPECT_EQ(flown(true).state_hash(), flown(false).state_hash());
}

TEST(SelfCollision, LeavesTheFreeFallOfASheetAsItIs) {
    Simulation surfaces(sheet_at(0, 1, 20), {}, kSelf);
    Simulation particles(sheet_at(0, 1, 20), {}, {.thickness = 0.01});
    for (int i = 0; i < 15; ++i) {
        surfaces.step();
        particles.step();
        ASSERT_EQ(surfaces.state_hash(), particles.state_hash());
    }
}

TEST(SelfCollision, LetsASheetFallOnBesideABallThatItHasLeft) {
    // Its vertices were near the ball lately: little is known of what is around them.
    const std::vector<Collider> ball = colliders_of({make_sphere(0.1, 24, 12)});
    for (const double speed : {3.0, 8.0, 20.0}) {
        SimulationOptions options = kSelf;
        options.gravity = {};
        options.newton().air_drag = 0;
        options.thickness = 0.004;
        Simulation simulation(sheet_at(-0.11, 0.5, 31, {0, 0, -speed}), ball, options);
        for (int i = 0; i < 15; ++i) simulation.step();
        EXPECT_EQ(simulation.profile().truncated_count, 0u) << speed;
        for (const Vec3f& p : simulation.positions()) ASSERT_NEAR(p.z, -0.11 - speed / 4, 1e-4) << speed;
    }
}

TEST(SelfCollision, HoldsLayersOfWhatFliesBackFromEachOtherAndNotInTheAir) {
    const SimulationOptions options{.solver = NewtonOptions{.air_drag = 0}, .gravity = {}};
    for (const bool has_model : {false, true}) {
        // One that goes by far away, or none.
        std::vector<Collider> colliders;
        if (has_model) {
            colliders = colliders_of({make_sphere(0.2, 16, 8)});
            colliders[0].pose.translation = {0, 0, 40};
            colliders[0].linear_velocity = {0, 3, 0};
        }
        const Vec3d velocity{10, 0, -20};
        const Deformable sheet = knotted(velocity);
        Simulation simulation(sheet, colliders, options);
        for (int i = 0; i < 6; ++i) simulation.step();
        EXPECT_EQ(simulation.profile().unresolved_count, 0u);
        const Vec3d way = mean_of(simulation.positions()) - mean_of(sheet.positions);
        EXPECT_NEAR(length(way - velocity * 0.1), 0, 0.02) << way.x << ' ' << way.y << ' ' << way.z;
        EXPECT_TRUE(meeting_faces(simulation, {}).empty());
    }
}

TEST(SelfCollision, KeepsTheMomentumOfASheetThatUnfoldsInTheAir) {
    // It begins at 60 % of its size with some noise, and bursts open against itself.
    for (const bool has_model : {false, true}) {
        std::vector<Collider> colliders;
        if (has_model) {
            colliders = colliders_of({make_sphere(0.2, 16, 8)});
            colliders[0].pose.translation = {0, 0, 30};
        }
        Deformable sheet = make_cloth({.column_count = 21, .row_count = 21, .width = 1, .height = 1});
        sheet.rest_positions = sheet.positions;
        Random random(1);
        for (Vec3f& p : sheet.positions) p = p * 0.6F + in_cube(random, 0.003F);
        Simulation simulation(sheet, colliders, {.solver = NewtonOptions{.air_drag = 0}, .gravity = {}});
        for (int i = 0; i < 40; ++i) simulation.step();
        EXPECT_EQ(simulation.profile().unresolved_count, 0u);
        const Vec3d before = mean_of(simulation.positions());
        for (int i = 0; i < 6; ++i) simulation.step();
        EXPECT_LT(length(mean_of(simulation.positions()) - before) * 10, 0.1); // metres per second
        EXPECT_TRUE(meeting_faces(simulation, {}).empty());
    }
}

TEST(SelfCollision, NamesTheDistanceFromTheOriginWhereFloatsMakeTheFacesOfTheStartMeet) {
    Deformable sheet = folded_in_four(17, 0);
    for (Vec3f& v : sheet.positions) v.x += 2e6F;
    expect_words(refusal_of(ErrorCode::InvalidOptions, [&] { Simulation(sheet, {}, kSelf); }),
                 "from the origin, where floats separate its layers only from a distance of");
}

TEST(SelfCollision, LeavesANetAloneThatABallOnlyPasses) {
    const TriangleMesh ball = make_sphere(0.1, 24, 12);
    for (const std::size_t count : {1u, 2u})
        for (const double speed : {10.0, 40.0, 90.0})
            for (const double height : {0.15, 0.3, 0.45}) {
                std::vector<Collider> colliders = colliders_of(std::vector<TriangleMesh>(count, ball));
                colliders[0].pose.translation = {-0.9, 0.01, height};
                colliders[0].linear_velocity = {speed, 0, 0};
                colliders.back().pose.translation.z += count == 2 ? -0.5 - height : 0;
                const Deformable net = pinned_net();
                SimulationOptions options = kSelf;
                options.gravity = {};
                Simulation simulation(net, colliders, options);
                while (simulation.colliders()[0].pose.translation.x < 0.9) simulation.step();
                EXPECT_EQ(simulation.profile().unresolved_count, 0u);
                for (std::size_t i = 0; i < net.positions.size(); ++i)
                    ASSERT_LT(length(simulation.positions()[i] - net.positions[i]), 1e-6F)
                        << i << ' ' << speed << ' ' << height << ' ' << count;
            }
}
