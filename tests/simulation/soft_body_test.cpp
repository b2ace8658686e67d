#include "support/expectations.hpp"
#include "support/random_points.hpp"
#include "support/soft_bodies.hpp"
#include "support/surface_judge.hpp"

#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>

using namespace echinus;

// Soft bodies: how they are made, and that their surfaces collide as those of cloth do.

namespace {

constexpr double kBodyThickness = 0.004;

SimulationOptions with_surfaces() {
    return {.thickness = kBodyThickness};
}

Deformable cube(std::uint32_t segments, const SoftBodyOptions& options) {
    return make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {segments, segments, segments}), options);
}

std::size_t corner_count(const Deformable& body) {
    std::set<std::uint32_t> corners;
    for (const Triangle& face : body.faces) corners.insert(face.begin(), face.end());
    return corners.size();
}

} // namespace

TEST(SoftBody, WeighsItsVolumeTimesItsDensity) {
    const Deformable body =
        make_soft_body(make_solid_box({1, 2, 3}, {3, 4, 5}), {.density = 900, .scale = 0.1});
    double mass = 0, volume = 0;
    for (const float inverse_mass : body.inverse_masses) mass += 1 / double{inverse_mass};
    for (const ElasticTetrahedron& tetrahedron : body.tetrahedra) volume += double{tetrahedron.volume};
    EXPECT_NEAR(volume, 0.006, 1e-8);
    EXPECT_NEAR(mass, 5.4, 1e-5);
}

TEST(SoftBody, HasTheBoundaryOfItsMeshAsFacesAndStandsWhereItIsPut) {
    const TetrahedralMesh mesh = make_solid_box({1, 1, 1}, {2, 3, 4});
    const RigidTransform pose{Rotation::about({1, 2, 3}, 0.7), {4, 5, 6}};
    const Deformable body = make_soft_body(mesh, {.pose = pose, .scale = 2});
    EXPECT_EQ(body.faces, boundary(mesh).faces);
    EXPECT_EQ(body.tetrahedra.size(), mesh.tetrahedra.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        EXPECT_EQ(body.positions[i], Vec3f(pose.to_world(Vec3d(mesh.vertices[i]) * 2)));
    for (const ElasticTetrahedron& tetrahedron : body.tetrahedra)
        EXPECT_NEAR(test::volume_ratio(tetrahedron, body.positions), 1, 1e-5);
}

TEST(SoftBody, IsCombinedWithOthersAndWithCloth) {
    const Deformable body = cube(2, {.pins = {3}});
    const Deformable cloth =
        with_masses_times(0.25, make_cloth({.column_count = 4, .row_count = 5, .pins = {7}}));
    const std::vector<Deformable> parts{cloth, body, body};
    const Deformable all = combine(parts);
    const std::uint32_t count = 27;
    ASSERT_EQ(all.particle_count(), 20u + 2 * count);
    EXPECT_EQ(all.faces.size(), cloth.faces.size() + 2 * body.faces.size());
    EXPECT_EQ(all.constraints.size(), cloth.constraints.size());
    EXPECT_EQ(all.inverse_masses[0], 4);
    EXPECT_EQ(all.inverse_masses[7], 0);
    EXPECT_EQ(all.inverse_masses[20 + 3], 0);
    EXPECT_EQ(all.inverse_masses[20 + count], body.inverse_masses[0]);
    for (std::size_t i = 0; i < body.tetrahedra.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_EQ(all.tetrahedra[body.tetrahedra.size() + i].particles[k],
                      20 + count + body.tetrahedra[i].particles[k]);
    EXPECT_EQ(all.faces.back()[0], body.faces.back()[0] + 20 + count);
}

TEST(SoftBody, IsNotCombinedWithAPartThatNamesParticlesOfTheNext) {
    const Deformable sound = cube(1, {});
    const auto expect_refused = [&](const char* words, const Deformable& part) {
        test::expect_error(ErrorCode::InvalidOptions, words, [&] {
            combine(std::vector{sound, part, sound});
        });
    };
    Deformable broken = sound;
    broken.faces.back()[2] = 8;
    expect_refused("part 1 of the combined parts: face 11 refers to particle 8; the last one is 7", broken);
    broken = sound;
    broken.attachments.push_back({9, 0});
    expect_refused("part 1 of the combined parts: an attachment refers to particle 9", broken);
    expect_refused("part 1 of the combined parts: the deformable has no particles", {});
}

TEST(SoftBody, OfImpossibleMeshesAndOptionsIsRefused) {
    const TetrahedralMesh box = make_solid_box({1, 1, 1}, {1, 1, 1});
    const auto expect_refused = [&](const char* words, const SoftBodyOptions& options) {
        test::expect_error(ErrorCode::InvalidOptions, words, [&] { make_soft_body(box, options); });
    };
    expect_refused("density is -1", {.density = -1});
    expect_refused("young_modulus is nan", {.young_modulus = std::nan("")});
    expect_refused("poisson_ratio is 0.5", {.poisson_ratio = 0.5});
    expect_refused("damping is -1", {.damping = -1});
    expect_refused("scale is 0", {.scale = 0});
    expect_refused("a pin of the soft body refers to vertex 8", {.pins = {8}});
    expect_refused("an attachment of the soft body refers to vertex 9", {.attachments = {{9, 0}}});
    expect_refused("vertex 3 of the soft body is both pinned", {.pins = {3}, .attachments = {{3, 0}}});

    const auto expect_mesh_refused = [](const char* words, const TetrahedralMesh& mesh) {
        test::expect_error(ErrorCode::InvalidMesh, words, [&] { make_soft_body(mesh, {}); });
    };
    TetrahedralMesh inverted = box;
    std::swap(inverted.tetrahedra[2][0], inverted.tetrahedra[2][1]);
    expect_mesh_refused("tetrahedron 2 has a negative volume", inverted);
    TetrahedralMesh unused = box;
    unused.vertices.push_back({5, 5, 5});
    expect_mesh_refused("vertex 8 of the soft body belongs to no tetrahedron", unused);
    TetrahedralMesh infinite = box;
    infinite.vertices[0].x = std::numeric_limits<float>::infinity();
    expect_mesh_refused("not finite", infinite);
    expect_mesh_refused("no tetrahedra", {});
    test::expect_error(ErrorCode::InvalidOptions, "masses are to be multiplied by 0",
                       [&] { with_masses_times(0, make_soft_body(box, {})); });
}

TEST(SoftBody, NeedsFittingTetrahedra) {
    const Deformable body = cube(1, {});
    Deformable wrong = body;
    wrong.tetrahedra[3].particles[1] = 8;
    test::expect_error(ErrorCode::InvalidOptions, "tetrahedron 3 needs four different particles of 8",
                       [&] { Simulation(wrong, {}, {}); });
    wrong = body;
    wrong.tetrahedra[1].mu = 0;
    test::expect_error(ErrorCode::InvalidOptions, "tetrahedron 1 has a rest shape",
                       [&] { Simulation(wrong, {}, {}); });
    wrong = body;
    wrong.tetrahedra[2].gradients[1] = wrong.tetrahedra[2].gradients[0];
    test::expect_error(ErrorCode::InvalidOptions, "tetrahedron 2 has a rest shape",
                       [&] { Simulation(wrong, {}, {}); });
}

TEST(SoftBody, ThrownOutOfAllBoundsDivergesWhateverItCollidesWith) {
    for (const float speed : {1e7F, 1e20F, 3e37F}) {
        Deformable body = cube(3, {.pose = {{}, {0, 0, 0.4}}});
        body.velocities.assign(body.particle_count(), {speed, 0, 0});
        Simulation simulation(body, test::colliders_of({make_sphere(0.15, 24, 12)}), with_surfaces());
        test::expect_error(ErrorCode::Diverged, "in frame 1", [&] { simulation.step(); });
    }
}

TEST(SoftBody, IsNotMovedByItsOwnThickness) {
    // One element thick, and much thinner than the distance that layers keep.
    const Deformable sheet =
        make_soft_body(make_solid_box({0.4, 0.4, 0.004}, {20, 20, 1}), {.young_modulus = 1e4});
    SimulationOptions options = with_surfaces();
    options.gravity = {};
    options.thickness = options.newton().self_thickness = 0.02;
    Simulation simulation(sheet, {}, options);
    for (int frame = 0; frame < 5; ++frame) simulation.step();
    for (std::size_t i = 0; i < sheet.particle_count(); ++i)
        EXPECT_LT(length(simulation.positions()[i] - sheet.positions[i]), 1e-5F);
}

TEST(SoftBody, FallsOnABallAndNoFaceMeetsAnotherInAnyFrame) {
    const std::vector<TriangleMesh> models{make_sphere(0.15, 24, 12)};
    const Deformable body = cube(
        5, {.young_modulus = 5e3, .damping = 0.02, .pose = {Rotation::about({1, 1, 0}, 0.5), {0, 0, 0.4}}});
    ASSERT_LT(corner_count(body), body.particle_count());
    Simulation simulation(body, test::colliders_of(models), with_surfaces());
    test::expect_nothing_meets(simulation, models, 60);
    EXPECT_EQ(simulation.profile().lost_count, 0u);
    EXPECT_GT(test::least_volume_ratio(body, simulation.positions()), 0.1);
}

TEST(SoftBody, PressedBetweenPlatesIsTakenAlongByBothAndMeetsNeither) {
    // By a centimetre in a frame, from the size of the ball down to eight thicknesses.
    const ExactMap map = ExactMap::build(make_sphere(0.1, 24, 12));
    const Deformable ball = make_soft_body(tetrahedralize(map, {.size = 0.04}).mesh,
                                           {.young_modulus = 2e3, .poisson_ratio = 0.2});
    const std::vector<TriangleMesh> plates(2, make_box({0.6, 0.6, 0.05}, 4));
    std::vector<Collider> colliders = test::colliders_of(plates);
    const double start = 0.1 + kBodyThickness + 0.026, end = 8 * kBodyThickness + 0.05 - start;
    colliders[0].pose.translation = {0, 0, -start};
    colliders[1].pose.translation = {0, 0, start};
    Simulation simulation(ball, colliders, with_surfaces());
    simulation.set_collider_keyframes(1, {{0, colliders[1].pose}, {0.3, {{}, {0, 0, end}}}});
    for (int frame = 1; frame <= 24; ++frame) {
        simulation.step();
        ASSERT_EQ(test::meeting_faces(simulation, plates).size(), 0u) << frame;
    }
    EXPECT_EQ(simulation.profile().lost_count, 0u);
}

TEST(SoftBody, UnderALightSheetIsPressedByAPlateThatMeetsNeither) {
    // The sheet is pressed to its least gap from the plate, which then carries it along, and the body with
    // it.
    const std::vector<TriangleMesh> plates{make_box({1, 1, 0.1}), make_box({1, 1, 0.1})};
    std::vector<Collider> colliders = test::colliders_of(plates);
    colliders[0].pose.translation = {0, 0, -0.05};
    colliders[1].pose.translation = {0, 0, 0.39};
    const ExactMap map = ExactMap::build(make_sphere(0.1, 16, 8));
    const Deformable sheet = make_cloth(
        {.column_count = 16, .row_count = 16, .width = 0.4, .height = 0.4, .pose = {{}, {0, 0, 0.24}}});
    struct Case {
        double size, young_modulus, speed;
    };
    for (const auto& [size, young_modulus, speed] :
         {Case{0.05, 2e4, 0.6}, Case{0.05, 4e4, 0.8}, Case{0.06, 2e4, 0.8}, Case{0.06, 4e4, 0.6}}) {
        SCOPED_TRACE(testing::Message() << size << " " << young_modulus << " " << speed);
        colliders[1].linear_velocity = {0, 0, -speed};
        const std::vector<Deformable> parts{
            sheet, make_soft_body(tetrahedralize(map, {.size = size}).mesh, {.young_modulus = young_modulus,
                                                                             .poisson_ratio = 0.3,
                                                                             .damping = 0.03,
                                                                             .pose = {{}, {0, 0, 0.11}}})};
        Simulation simulation(combine(parts), colliders, {.thickness = 0.004});
        test::expect_nothing_meets(simulation, plates, static_cast<std::uint32_t>(13 / speed));
        EXPECT_EQ(simulation.profile().lost_count, 0u);
        EXPECT_EQ(simulation.profile().unresolved_count, 0u);
    }
}

TEST(SoftBody, UnderALightSheetLosesNothingToAPlateThatComesDownFast) {
    // The plate goes less than an edge in a frame, and more than what is listed beside it.
    const std::vector<TriangleMesh> plates{make_box({4, 4, 0.1}, 4), make_box({0.9, 0.9, 0.04}, 2)};
    std::vector<Collider> colliders = test::colliders_of(plates);
    colliders[0].pose.translation = {};
    colliders[1].linear_velocity = {0, 0, -3};
    const ExactMap map = ExactMap::build(make_sphere(0.09, 32, 16));
    const TetrahedralMesh ball = tetrahedralize(map, {.count = 250}).mesh;
    for (const double gap : {0.004, 0.012, 0.05}) {
        const Deformable sheet = make_cloth({.column_count = 18,
                                             .row_count = 18,
                                             .width = 0.35,
                                             .height = 0.35,
                                             .pose = {{}, {0, 0.01, 0.235 + gap}}});
        const std::vector<Deformable> parts{
            make_soft_body(
                ball,
                {.young_modulus = 5e3, .poisson_ratio = 0.3, .damping = 0.01, .pose = {{}, {0, 0, 0.145}}}),
            sheet};
        colliders[1].pose.translation = {0, 0, 0.285 + gap};
        Simulation simulation(combine(parts), colliders, {.thickness = 0.003, .friction = 0.3});
        test::expect_nothing_meets(simulation, plates, static_cast<std::uint32_t>((0.12 + gap) * 20));
        EXPECT_EQ(simulation.profile().lost_count, 0u) << gap;
        EXPECT_EQ(simulation.profile().unresolved_count, 0u) << gap;
    }
}

TEST(SoftBody, MeetsNoLightSheetOnItUnderAnotherWhileAPlateComesDown) {
    // The sheet lies at its least gap from both, far from the floor and from the plate, which take them
    // along.
    const std::vector<TriangleMesh> plates{make_box({1.2, 1.2, 0.1}, 4), make_box({0.6, 0.6, 0.04}, 6)};
    std::vector<Collider> colliders = test::colliders_of(plates);
    colliders[1].pose.translation = {0, 0, 0.42};
    colliders[1].linear_velocity = {0, 0, -0.5};
    const auto block_at = [](double height) {
        return make_soft_body(
            make_solid_box({0.15, 0.15, 0.15}, {4, 4, 4}),
            {.young_modulus = 5e3, .poisson_ratio = 0.3, .damping = 0.02, .pose = {{}, {0, 0, height}}});
    };
    const Deformable sheet = make_cloth(
        {.column_count = 25, .row_count = 25, .width = 0.4, .height = 0.4, .pose = {{}, {0, 0, 0.212}}});
    const std::vector<Deformable> parts{block_at(0.13), sheet, block_at(0.294)};
    Simulation simulation(combine(parts), colliders, with_surfaces());
    test::expect_nothing_meets(simulation, plates, 15);
    EXPECT_EQ(simulation.profile().lost_count, 0u);
}

TEST(SoftBody, OnAWallThatSwaysOrTurnsOverAFloorMeetsNothingThatFallsOnIt) {
    // It hangs down to the floor, and the other presses on what is drawn long between there and the wall.
    const ExactMap map = ExactMap::build(make_sphere(0.1, 60, 30));
    const TetrahedralMesh ball = tetrahedralize(map, {.count = 400}).mesh;
    float left = 0;
    for (const Vec3f& v : ball.vertices) left = std::min(left, v.x);
    const std::vector<TriangleMesh> models{make_box({4, 4, 0.1}, 4), make_box({0.1, 1, 1}, 2)};
    struct Case {
        double young_modulus;
        double turn;
    };
    for (const auto& [young_modulus, turn] : {Case{620, 0}, Case{1030, 0.3}}) {
        SoftBodyOptions soft{.young_modulus = young_modulus, .poisson_ratio = 0.49, .damping = 0};
        soft.pose.translation = {0.02, 0.01, 0.53};
        const Deformable falling = make_soft_body(ball, soft);
        soft.pose.translation = {0, 0, 0.3};
        for (std::uint32_t v = 0; v < ball.vertices.size(); ++v)
            if (ball.vertices[v].x < left + 0.01F) soft.attachments.push_back({v, 1});
        const std::vector<Deformable> parts{make_soft_body(ball, soft), falling};
        std::vector<Collider> colliders = test::colliders_of(models);
        colliders[0].pose.translation = {};
        colliders[1].pose.translation = {double{left} - 0.056, 0, 0.3};
        SimulationOptions options = with_surfaces();
        options.thickness = 0.003;
        options.newton().air_drag = 0;
        options.friction = 0.5;
        Simulation simulation(combine(parts), colliders, options);
        for (int frame = 0; frame < 28; ++frame) {
            const Vec3d sway{-0.05 * std::sin(frame * 0.2), 0.03 * std::sin(frame * 0.28), 0};
            const double half_angle = turn * std::sin(frame * 0.2) / 2;
            simulation.set_collider_pose(1, {{std::cos(half_angle), std::sin(half_angle), 0, 0},
                                             colliders[1].pose.translation + sway});
            simulation.step();
            ASSERT_EQ(test::meeting_faces(simulation, models).size(), 0u) << young_modulus << " " << frame;
        }
        EXPECT_EQ(simulation.profile().unresolved_count, 0u) << young_modulus;
    }
}

TEST(SoftBody, IsNotTakenAlongByAModelThatFallsAwayFromIt) {
    const std::vector<TriangleMesh> models{make_box({2, 2, 0.1}, 4)};
    for (const double speed : {1.0, 10.0, 20.0, 25.0, 60.0}) {
        std::vector<Collider> colliders = test::colliders_of(models);
        colliders[0].linear_velocity = {0, 0, -speed};
        SimulationOptions options = with_surfaces();
        options.gravity = {};
        options.friction = 0;
        options.newton().air_drag = 0;
        const Deformable body = cube(4, {.young_modulus = 1e4, .pose = {{}, {0, 0, 0.154}}});
        Simulation simulation(body, colliders, options);
        for (int frame = 0; frame < 3; ++frame) simulation.step();
        EXPECT_EQ(simulation.profile().truncated_count, 0u) << speed;
        for (std::size_t i = 0; i < body.particle_count(); ++i)
            ASSERT_NEAR(simulation.positions()[i].z, body.positions[i].z, 0.002) << speed;
    }
}

TEST(SoftBody, CollidesWithAnotherAndWithClothAsWithItself) {
    const std::vector<TriangleMesh> models{make_box({1, 1, 0.1})};
    const auto at = [](double height, double young) {
        return cube(3, {.young_modulus = young, .damping = 0.05, .pose = {{}, {0, 0, height}}});
    };
    const Deformable cloth = make_cloth(
        {.column_count = 15, .row_count = 15, .width = 0.4, .height = 0.4, .pose = {{}, {0, 0, 0.45}}});
    const std::vector<Deformable> parts{at(0.16, 2e4), at(0.7, 8e3), cloth};
    Simulation simulation(combine(parts), test::colliders_of(models), with_surfaces());
    test::expect_nothing_meets(simulation, models, 50);
    // The upper body lies on the cloth, and the cloth on the lower body.
    const float lower = simulation.positions()[0].z, upper = simulation.positions()[64].z;
    EXPECT_GT(upper - lower, 0.12F);
}

/// Bars and beams of length 1 that are held at one end, beside what the theory of elasticity says.
namespace echinus::test {

struct Beam {
    std::uint32_t segments = 4; ///< across its height
    double poisson_ratio = 0.3;
    double slenderness = 5; ///< length over height; its width is half its height where it bends
    /// density * gravity * length / Young's modulus: twice the strain of a bar that hangs, on the average.
    double strain = 0.02;
};

struct Settled {
    double deflection, expected; ///< of the free end
    double volume_ratio;         ///< of what it has at rest
    std::size_t tetrahedron_count;
};

/// @param down  along x for a bar, across for a beam
/// @param pace  the lowest frequency, radians per second; drag makes it die away fastest
inline Settled settle(const Beam& beam, const Vec3d& down, std::uint32_t segments_across, double pace,
                      double expected) {
    constexpr double kDensity = 1000, kGravity = 10;
    const double height = 1 / beam.slenderness, spacing = height / beam.segments;
    const auto along = static_cast<std::uint32_t>(std::lround(1 / spacing));
    TetrahedralMesh mesh =
        make_solid_box({1, segments_across * spacing, height}, {along, segments_across, beam.segments});
    for (Vec3f& vertex : mesh.vertices) vertex.x += 0.5F;
    const double young = kDensity * kGravity / beam.strain;
    const Deformable body = make_soft_body(mesh, {.density = kDensity,
                                                  .young_modulus = young,
                                                  .poisson_ratio = beam.poisson_ratio,
                                                  .pins = vertices_at_x(mesh, 0)});
    const double speed = std::sqrt(young / kDensity);
    const SimulationOptions options{.solver = NewtonOptions{.air_drag = 1.6 * pace * speed},
                                    .gravity = down * kGravity};
    Simulation simulation(body, {}, options);
    while (simulation.frame() * options.time_step * pace * speed < 30) simulation.step();
    Settled settled{0, expected * beam.strain, 0, body.tetrahedra.size()};
    const auto end = vertices_at_x(mesh, 1);
    for (const std::uint32_t i : end)
        settled.deflection += dot(Vec3d(simulation.positions()[i]) - Vec3d(mesh.vertices[i]), down) /
                              static_cast<double>(end.size());
    settled.volume_ratio =
        volume_of(body.tetrahedra, simulation.positions()) / volume_of(body.tetrahedra, body.positions);
    return settled;
}

/// A bar that hangs from one end gets longer by density gravity length^2 / (2 E).
inline Settled hang_bar(Beam beam) {
    beam.slenderness = 8;
    return settle(beam, {1, 0, 0}, beam.segments, std::numbers::pi / 2, 0.5);
}

/// A beam that is fixed at one end and bends under its own weight: that of Bernoulli, and of Timoshenko for
/// its shear, with Cowper's coefficient of a rectangle.
inline Settled bend_cantilever(Beam beam) {
    beam.strain = 2e-3;
    const double height = 1 / beam.slenderness, nu = beam.poisson_ratio;
    const double shear_coefficient = 10 * (1 + nu) / (12 + 11 * nu);
    const double bending = 1.5 / (height * height), shear = (1 + nu) / shear_coefficient;
    return settle(beam, {0, 0, -1}, std::max(1U, beam.segments / 2), 3.516 * height / std::sqrt(12.0),
                  bending + shear);
}

} // namespace echinus::test

// Soft bodies against answers that are known: bars, beams, what cannot be compressed, what slides.
// docs/soft_bodies.md has the same at finer resolutions.

namespace {

constexpr double kSlopeFriction = 0.5;

/// A block of rubber that begins beside the top of a box, which is turned by so much about the y axis; down
/// is along x of the box.
Simulation block_on_slope(const Rotation& tilt) {
    const Deformable block =
        make_soft_body(make_solid_box({0.2, 0.2, 0.1}, {4, 4, 2}),
                       {.young_modulus = 2e5,
                        .poisson_ratio = 0.3,
                        .damping = 0.02,
                        .pose = {tilt, tilt.apply({0, 0, 0.5 + 0.05 + kBodyThickness})}});
    const Collider slope{.map = ExactMap::build(make_box({3, 1, 1})), .pose = {tilt, {}}};
    return {block,
            {slope},
            {.solver = NewtonOptions{.air_drag = 0, .collision = CollisionMode::Surfaces},
             .thickness = kBodyThickness,
             .friction = kSlopeFriction}};
}

/// Of its middle, in the frame of the slope.
double way_down(const Simulation& simulation) {
    double sum = 0;
    for (const Vec3f& p : simulation.positions()) sum += simulation.colliders()[0].pose.to_local(Vec3d(p)).x;
    return sum / static_cast<double>(simulation.positions().size());
}

Rotation tilt_of(double degrees) {
    return Rotation::about({0, 1, 0}, degrees * std::numbers::pi / 180);
}

/// The friction that the acceleration of a block tells which slides down, from a quarter of a second, after
/// which it has sagged onto the slope, to a half.
double friction_of_sliding(double degrees) {
    constexpr double kGravity = 9.81;
    const double angle = degrees * std::numbers::pi / 180;
    Simulation simulation = block_on_slope(tilt_of(degrees));
    const double step = simulation.options().time_step;
    const auto speed_at = [&](double seconds) {
        while (simulation.frame() * step < seconds) simulation.step();
        const double before = way_down(simulation);
        simulation.step();
        return (way_down(simulation) - before) / step;
    };
    const double first_speed = speed_at(0.25);
    const double acceleration = (speed_at(0.5) - first_speed) / 0.25;
    return (std::sin(angle) - acceleration / kGravity) / std::cos(angle);
}

} // namespace

TEST(SoftBodyPhysics, HangsABarAsLowAsHookeSays) {
    const test::Settled bar = test::hang_bar({.segments = 3, .poisson_ratio = 0.3});
    EXPECT_NEAR(bar.deflection / bar.expected, 1, 0.03);
}

TEST(SoftBodyPhysics, BendsACantileverAsTimoshenkoSaysTheCloserTheFinerItIs) {
    const test::Settled coarse = test::bend_cantilever({.segments = 2, .poisson_ratio = 0.3});
    const test::Settled fine = test::bend_cantilever({.segments = 4, .poisson_ratio = 0.3});
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
    // The angle is atan(0.5) = 26.6 degrees. A block that falls onto a slope slides until friction has braked
    // it; so a box is turned under a block, about a line in its top.
    for (const double degrees : {24.0, 26.0}) {
        Simulation simulation = block_on_slope({});
        const auto step_to = [&](double seconds) {
            while (simulation.frame() * simulation.options().time_step < seconds) {
                const double time = (simulation.frame() + 1) * simulation.options().time_step;
                const double share = std::clamp((time - 0.25) / 3, 0.0, 1.0);
                const Rotation tilt = tilt_of(degrees * share * share * (3 - 2 * share));
                const Vec3d pivot{0, 0, 0.5};
                simulation.set_collider_pose(0, {tilt, pivot - tilt.apply(pivot)});
                simulation.step();
            }
            return way_down(simulation);
        };
        const double start = step_to(0.25), turned = step_to(3.5);
        EXPECT_NEAR(turned, start, 0.0015) << degrees; // it shears by half a millimetre
        EXPECT_NEAR(step_to(4.5), turned, 1e-6) << degrees;
    }
    for (const double degrees : {27.0, 28.0, 30.0, 40.0})
        EXPECT_NEAR(friction_of_sliding(degrees), kSlopeFriction, 0.0025) << degrees;
}

TEST(SoftBodyPhysics, RestsUnderOneThatIsFiveHundredTimesAsStiff) {
    constexpr double kSoft = 2e4, kStiff = 1e7, kSide = 0.2, kWeight = 9.81 * 1000 * kSide * kSide * kSide;
    const auto at = [](double height, double young) {
        return cube(3, {.young_modulus = young, .damping = 0.02, .pose = {{}, {0, 0, height}}});
    };
    const std::vector<Deformable> parts{at(0.154, kSoft), at(0.358, kStiff)};
    const Deformable stack = combine(parts);
    Simulation simulation(stack, test::colliders_of({make_box({1, 1, 0.1})}), with_surfaces());
    while (simulation.frame() < 300 && !simulation.at_rest()) simulation.step();
    EXPECT_TRUE(simulation.at_rest());
    std::array<double, 2> elastic{};
    for (std::size_t t = 0; t < stack.tetrahedra.size(); ++t)
        elastic[t < parts[0].tetrahedra.size() ? 0 : 1] +=
            test::elastic_energy(stack.tetrahedra[t], simulation.positions());
    EXPECT_LT(test::energy(simulation) - elastic[0] - elastic[1], 1e-5);
    // Of a column that the weights above compress, 7/3 and 1/3 of that of one weight all along. Friction
    // holds the soft one's ends, and pressure is not the same all over the stiff one's.
    const double of_weight = kWeight * kWeight / (2 * kSide);
    EXPECT_NEAR(elastic[0] / (7.0 / 3 * of_weight / kSoft), 0.75, 0.1);
    EXPECT_NEAR(elastic[1] / (1.0 / 3 * of_weight / kStiff), 1.2, 0.3);
}

TEST(SoftBodyPhysics, GainsNoEnergyWhereABallCrushesIt) {
    // A jelly that would sink by half under its own weight falls as fast as waves go in it.
    const Deformable jelly =
        make_soft_body(make_solid_box({0.3, 0.3, 0.3}, {5, 5, 5}),
                       {.young_modulus = 5e3, .pose = {Rotation::about({1, 1, 0}, 0.5), {0, 0, 0.6}}});
    SimulationOptions options = with_surfaces();
    options.friction = 0;
    options.newton().step_count = 20;
    Simulation simulation(jelly, test::colliders_of({make_sphere(0.15, 24, 12)}), options);
    const auto energy = [&] {
        double sum = test::energy(simulation);
        for (std::size_t i = 0; i < jelly.particle_count(); ++i)
            sum += 9.81 * double{simulation.positions()[i].z} / double{jelly.inverse_masses[i]};
        return sum;
    };
    double before = energy();
    for (int frame = 0; frame < 30; ++frame) {
        simulation.step();
        EXPECT_LT(energy(), 1.005 * before) << frame;
        before = energy();
    }
}

TEST(SoftBodyPhysics, FallsAsFastFarFromTheOriginAsNearIt) {
    double at_the_origin = 0;
    for (const float height : {0.0F, 2.0F, 30.0F, 1000.0F}) {
        const Deformable body =
            make_soft_body(make_solid_box({0.3, 0.3, 0.3}, {2, 2, 2}), {.pose = {{}, {0, 0, height}}});
        Simulation simulation(body, {}, {.solver = NewtonOptions{.air_drag = 0}});
        for (int frame = 0; frame < 15; ++frame) simulation.step();
        double fallen = 0;
        for (std::size_t i = 0; i < body.particle_count(); ++i)
            fallen += (double{body.positions[i].z} - double{simulation.positions()[i].z}) /
                      static_cast<double>(body.particle_count());
        if (height == 0) at_the_origin = fallen;
        EXPECT_NEAR(fallen / at_the_origin, 1, 0.001) << height;
        EXPECT_NEAR(fallen, 9.81 * 0.25 * 0.25 / 2, 0.1 * fallen);
    }
}
