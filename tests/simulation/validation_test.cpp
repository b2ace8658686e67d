#include "support/draping.hpp"
#include "support/expectations.hpp"

#include <echinus/error.hpp>
#include <echinus/intersections.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <string>

using namespace echinus;
using test::expect_error, test::expect_words, test::refusal_of, test::sheet_at;

namespace {

constexpr double kNaNOption = std::numeric_limits<double>::quiet_NaN();

/// The sentence with which a simulation refuses a change to a sound set-up; empty when it does not.
std::string refusal(const std::function<void(Deformable&, SimulationOptions&)>& spoil) {
    Deformable cloth = make_cloth({.column_count = 3, .row_count = 3});
    SimulationOptions options;
    spoil(cloth, options);
    return refusal_of(ErrorCode::InvalidOptions, [&] { const Simulation simulation(cloth, {}, options); });
}

std::string refusal_of_option(const std::function<void(SimulationOptions&)>& spoil) {
    return refusal([&](Deformable&, SimulationOptions& options) { spoil(options); });
}

} // namespace

TEST(SimulationSetUp, IsAcceptedWhenSound) {
    EXPECT_EQ(refusal([](Deformable&, SimulationOptions&) {}), "");
}

TEST(SimulationSetUp, NamesTheOptionOutOfRange) {
    expect_words(refusal_of_option([](auto& o) { o.time_step = 0; }), "time_step");
    expect_words(refusal_of_option([](auto& o) { o.time_step = kNaNOption; }), "time_step");
    expect_words(refusal_of_option([](auto& o) { o.solver = JakobsenOptions{.iteration_count = 0}; }),
                 "iteration_count");
    expect_words(refusal_of_option([](auto& o) { o.solver = JakobsenOptions{.drag = 1.01}; }), "drag");
    expect_words(refusal_of_option([](auto& o) { o.thickness = -0.1; }), "thickness");
    expect_words(refusal_of_option([](auto& o) { o.friction = kNaNOption; }), "friction");
    expect_words(refusal_of_option([](auto& o) {
                     o.solver = JakobsenOptions{.stiffness = {1, 2, 1}};
                 }),
                 "stiffness");
    expect_words(refusal_of_option([](auto& o) { o.gravity.y = kNaNOption; }), "gravity");
    expect_words(refusal_of_option([](auto& o) { o.bound = -1; }), "bound");
    expect_words(refusal_of_option([](auto& o) { o.rest.distance = -1; }), "rest.distance");
    expect_words(refusal_of_option([](auto& o) { o.rest.speed = kNaNOption; }), "rest.speed");
    expect_words(refusal_of_option([](auto& o) { o.rest.frame_count = 0; }), "rest.frame_count");
}

TEST(SimulationSetUp, RefusesWindThatTakesHoldOfNothing) {
    expect_words(refusal([](Deformable&, SimulationOptions& o) { o.wind = {0, 1, 0}; }), "wind_rate is 0");
    expect_words(refusal([](Deformable&, SimulationOptions& o) {
                     o.wind = {0, kNaNOption, 0};
                     o.wind_rate = 1;
                 }),
                 "wind is not finite");
    EXPECT_EQ(refusal([](Deformable&, SimulationOptions& o) { o.wind_rate = 1; }), "");
}

TEST(SimulationSetUp, RefusesAColliderWhoseScaleIsZeroOrNoNumber) {
    const ExactMap map = ExactMap::build(make_box({1, 1, 1}));
    const auto refusal_of_scale = [&](const Vec3d& scale) {
        return refusal_of(ErrorCode::InvalidOptions, [&] {
            Simulation(make_cloth({}), {{.map = map}, {.map = map, .scale = scale}}, test::jakobsen());
        });
    };
    expect_words(refusal_of_scale({1, 0, 1}), "collider 1");
    expect_words(refusal_of_scale({1, 1, kNaNOption}), "collider 1");
    expect_words(refusal_of_scale({1 / 0.0, 1, 1}), "collider 1");
    expect_words(refusal_of_scale({1e39, 1, 1}), "collider 1");
    expect_words(refusal_of_scale({1, 1e-60, 1}), "collider 1");
    EXPECT_EQ(refusal_of_scale({1, -2, 0.5}), "");
}

TEST(SimulationSetUp, RefusesWhatStandsTooFarAwayForFloats) {
    TriangleMesh box = make_box({1, 1, 1});
    box.origin = {448262, 5411932, 112};
    const std::string words = " is located around (448262, 5.41193e+06, 112), too far from 0";
    for (const ColliderMap& map : {ColliderMap(ExactMap::build(box)), ColliderMap(DistanceMap::build(box))}) {
        const Collider collider{.map = map, .name = "the house"};
        expect_error(ErrorCode::InvalidMesh, "the house" + words, [&] {
            const Simulation simulation(make_cloth({.column_count = 3, .row_count = 3}), {collider},
                                        test::jakobsen());
        });
    }
    expect_error(ErrorCode::InvalidMesh, "the cloth" + words, [&] { make_cloth(box, {}); });
    TetrahedralMesh body = make_solid_box({1, 1, 1}, {1, 1, 1});
    body.origin = box.origin;
    expect_error(ErrorCode::InvalidMesh, "the soft body" + words, [&] { make_soft_body(body, {}); });
}

TEST(SimulationSetUp, RefusesARotationThatIsNotOfUnitLength) {
    const ExactMap map = ExactMap::build(make_box({1, 1, 1}));
    for (const Rotation& rotation : {Rotation{0, 0, 0, 0}, Rotation{2, 0, 0, 0}, Rotation{1, 0.1, 0, 0},
                                     Rotation{kNaNOption, 0, 0, 0}}) {
        const std::vector<Collider> colliders{{.map = map}, {.map = map, .pose = {rotation, {}}}};
        expect_error(ErrorCode::InvalidOptions, "collider 1 has the rotation",
                     [&] { Simulation(make_cloth({}), colliders, test::jakobsen()); });
        expect_error(ErrorCode::InvalidOptions, "the cloth has the rotation", [&] {
            make_cloth({.pose = {rotation, {}}});
        });
    }
}

TEST(SimulationSetUp, BringsARotationThatWasRoundedToUnitLength) {
    const Rotation exact = Rotation::about({1, 2, 3}, 0.7);
    const Rotation rounded{float(exact.w), float(exact.x), float(exact.y), float(exact.z)};
    const ExactMap map = ExactMap::build(make_box({1, 1, 1}));
    const Simulation simulation(make_cloth({}),
                                {{.map = map, .pose = {rounded, {}}}, {.map = map, .pose = {exact, {}}}},
                                test::jakobsen());
    const Rotation& r = simulation.colliders()[0].pose.rotation;
    EXPECT_NEAR(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z, 1, 1e-15);
    EXPECT_NEAR(r.w, exact.w, 1e-6);
    EXPECT_EQ(simulation.colliders()[1].pose.rotation.w, exact.w);
}

TEST(SimulationSetUp, RefusesTheExactMapOfAnOpenMeshUnlessItIsAllowed) {
    TriangleMesh open = make_box({1, 1, 1});
    open.faces.pop_back();
    const std::vector<Collider> colliders{{.map = ExactMap::build(open)}};
    expect_error(ErrorCode::InvalidOptions,
                 "collider 0 has the exact map of an open mesh, with 3 border edges",
                 [&] { Simulation(make_cloth({}), colliders, test::jakobsen()); });
    EXPECT_NO_THROW(Simulation(make_cloth({}), colliders, test::jakobsen({.allow_open_colliders = true})));
    EXPECT_NO_THROW(Simulation(make_cloth({}), {{.map = DistanceMap::build(open)}}, {}));
}

TEST(SimulationSetUp, KeepsHalfTheSpacingOfTheParticlesAwayUnlessToldOtherwise) {
    const auto thickness = [](const Deformable& deformable, const SimulationOptions& options) {
        return Simulation(deformable, {}, options).options().thickness.value();
    };
    const Deformable sheet = make_cloth({.column_count = 11, .row_count = 11, .width = 2, .height = 2});
    EXPECT_NEAR(thickness(sheet, {}), 0.1, 1e-6);
    EXPECT_EQ(thickness(sheet, test::jakobsen({.thickness = 0})), 0);
    EXPECT_EQ(thickness(sheet, {.thickness = 0.3}), 0.3);
    Deformable loose = sheet;
    loose.constraints.clear();
    EXPECT_EQ(thickness(loose, {}), 0);
}

TEST(SimulationSetUp, NamesTheParticleConstraintOrFaceAtFault) {
    expect_words(refusal([](Deformable& d, auto&) { d.positions[4].x = float(kNaNOption); }), "particle 4");
    expect_words(refusal([](Deformable& d, auto&) {
                     d.velocities.resize(d.particle_count());
                     d.velocities[5].z = std::numeric_limits<float>::infinity();
                 }),
                 "particle 5");
    expect_words(refusal([](Deformable& d, auto&) { d.inverse_masses[6] = -1; }), "particle 6");
    expect_words(refusal([](Deformable& d, auto&) { d.constraints[2].b = 9; }), "constraint 2");
    expect_words(refusal([](Deformable& d, auto&) { d.constraints[3].a = d.constraints[3].b; }),
                 "constraint 3");
    expect_words(refusal([](Deformable& d, auto&) { d.constraints[1].rest_length = float(kNaNOption); }),
                 "constraint 1");
    expect_words(refusal([](Deformable& d, auto&) { d.faces[5][2] = 9; }), "face 5 refers to particle 9");
    expect_words(refusal([](Deformable& d, auto&) { d.inverse_masses.pop_back(); }), "8 inverse masses");
    expect_words(refusal([](Deformable& d, auto&) { d.positions[7].y = -1.1e15F; }),
                 "particle 7 begins farther than 1e15");
    expect_words(refusal([](Deformable& d, auto&) { d = {}; }), "no particles");
}

TEST(SimulationSetUp, RefusesARestShapeThatIsNotOfItsParticles) {
    const auto with_rest = [](const std::vector<Vec3f>& rest) {
        return refusal([&](Deformable& cloth, SimulationOptions&) { cloth.rest_positions = rest; });
    };
    expect_words(with_rest(std::vector<Vec3f>(8)), "9 positions and 8 rest positions");
    const float infinity = std::numeric_limits<float>::infinity();
    expect_words(with_rest({{}, {}, {}, {infinity, 0, 0}, {}, {}, {}, {}, {}}), "particle 3");
}

TEST(SimulationSetUp, RefusesOptionsOfSurfacesThatMeanNothing) {
    const auto refuses = [](const NewtonOptions& newton, const std::string& words) {
        expect_words(refusal_of_option([&](auto& o) { o.solver = newton; }), words);
    };
    refuses({.collision = static_cast<CollisionMode>(3)}, "collision is none of the modes");
    refuses({.self_thickness = -1}, "self_thickness");
    refuses({.self_thickness = kNaNOption}, "self_thickness");
}

TEST(SimulationSetUp, NamesTheFacesWithWhichADeformableBeginsIntersecting) {
    const std::vector<Collider> box{{.map = ExactMap::build(make_box({1, 1, 1})), .pose = {{}, {0, 0, 2}}}};
    const SimulationOptions surfaces{.solver = NewtonOptions{.collision = CollisionMode::Surfaces}};
    const Deformable wide = sheet_at(2.2, 2, 4);
    TriangleMesh raised = make_box({1, 1, 1});
    for (Vec3f& v : raised.vertices) v.z += 2;
    const std::vector<FacePair> pairs = intersecting_pairs({wide.positions, wide.faces}, raised);
    expect_error(ErrorCode::InvalidOptions,
                 "begins intersecting collider 0 in " + std::to_string(pairs.size()) + " pairs: face " +
                     std::to_string(pairs[0].a) + " of the deformable and face " +
                     std::to_string(pairs[0].b) + " of collider 0, face ",
                 [&] { Simulation(wide, box, surfaces); });
    expect_error(ErrorCode::InvalidOptions, "25 particles begin inside collider 0; the first is particle 0",
                 [&] { Simulation(sheet_at(2.2, 0.5, 5), box, surfaces); });
    Deformable thread;
    thread.positions = {{0, 0, 2.2F}, {0, 0, 3}};
    thread.inverse_masses = {1, 1};
    thread.constraints = {{0, 1, 0.8F, ConstraintKind::Structural}};
    expect_error(ErrorCode::InvalidOptions, "the edge from particle 0 to 1 of the deformable and face ",
                 [&] { Simulation(thread, box, surfaces); });
    // Particles alone may begin anywhere.
    EXPECT_NO_THROW(Simulation(wide, box, test::jakobsen()));
}

TEST(SimulationSetUp, NamesTheFacesOfAModelByTheirNumbersInItsMesh) {
    const TriangleMesh ball = make_sphere(1, 30, 15); // its map has the faces in another order
    const Deformable sheet = sheet_at(0.3, 3, 4);
    const std::vector<FacePair> pairs = intersecting_pairs({sheet.positions, sheet.faces}, ball);
    expect_error(ErrorCode::InvalidOptions,
                 "face " + std::to_string(pairs[0].a) + " of the deformable and face " +
                     std::to_string(pairs[0].b) + " of collider 0, face " + std::to_string(pairs[1].a) +
                     " of the deformable and face " + std::to_string(pairs[1].b) + " of collider 0",
                 [&] { Simulation(sheet, {{.map = ExactMap::build(ball)}}, {}); });
}

TEST(SimulationSetUp, RefusesADeformableThatLiesOnAModelAsNearAsTheLatticeOfItsMapTells) {
    const std::vector<Collider> table{{.map = ExactMap::build(make_box({4, 4, 1})), .name = "the table"}};
    const SimulationOptions surfaces{.solver = NewtonOptions{.collision = CollisionMode::Surfaces}};
    for (const double height : {0.5, 0.50001, 0.4999998, 0.499999})
        expect_error(ErrorCode::InvalidOptions,
                     "begins touching the table with 128 faces: face 0, face 1, face 2, ...; move",
                     [&] { Simulation(sheet_at(height, 2, 9), table, surfaces); });
    EXPECT_NO_THROW(Simulation(sheet_at(0.50002, 2, 9), table, surfaces));
    EXPECT_NO_THROW(Simulation(sheet_at(0.5, 2, 9), table, test::jakobsen()));
}

TEST(SimulationSetUp, RefusesLayersThatFloatsDoNotTellApartSoFarFromTheOrigin) {
    const std::vector<Collider> box{
        {.map = ExactMap::build(make_box({1, 1, 1})), .pose = {{}, {20000, 0, 0}}}};
    Deformable sheet = sheet_at(0.7, 1, 20);
    for (Vec3f& p : sheet.positions) p.x += 20000;
    SimulationOptions options{.solver = NewtonOptions{.collision = CollisionMode::Surfaces}};
    EXPECT_NO_THROW(Simulation(sheet, box, options));
    options.newton().collision = CollisionMode::SurfacesAndSelf;
    expect_error(ErrorCode::InvalidOptions, "move the scene nearer to the origin",
                 [&] { Simulation(sheet, box, options); });
}

TEST(SimulationSetUp, NamesTheFacesOfADeformableThatBeginIntersecting) {
    Deformable sheet = sheet_at(0, 1, 5);
    const Deformable upright =
        make_cloth({.column_count = 2, .row_count = 2, .pose = {Rotation::about({1, 0.1, 0}, 1.5), {}}});
    const auto offset = static_cast<std::uint32_t>(sheet.particle_count());
    for (const Vec3f& p : upright.positions) sheet.positions.push_back(p);
    sheet.inverse_masses.resize(sheet.particle_count(), 1);
    for (const auto& [a, b, c] : upright.faces) sheet.faces.push_back({a + offset, b + offset, c + offset});
    expect_error(ErrorCode::InvalidOptions, "begins intersecting itself in ",
                 [&] { Simulation(sheet, {}, {}); });
    EXPECT_NO_THROW(Simulation(sheet, {}, {.solver = NewtonOptions{.collision = CollisionMode::Surfaces}}));
}

TEST(SimulationSetUp, AcceptsOpenMeshesWithSurfaceCollisionAndNoInsideOfThem) {
    TriangleMesh open = make_box({1, 1, 1});
    open.faces.pop_back();
    const std::vector<Collider> colliders{{.map = ExactMap::build(open)}};
    EXPECT_NO_THROW(Simulation(sheet_at(0, 0.5, 5), colliders,
                               {.solver = NewtonOptions{.collision = CollisionMode::Surfaces}}));
}
