// A simulation in C is that of C++ bit for bit.

#include "handles.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>
#include <echinus/simulation.hpp>
#include <echinus_scene/scene.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

using namespace echinus;
using namespace echinus::test;

namespace {

class CScenes : public TemporaryFolderTest {};

const std::string kScene = std::string(ECHINUS_SCENES) + "/torus_small.json";

void step(echinus_simulation* simulation, int frame_count) {
    for (int i = 0; i < frame_count; ++i) expect_ok(echinus_simulation_step(simulation));
}
void step(Simulation& simulation, int frame_count) {
    for (int i = 0; i < frame_count; ++i) simulation.step();
}

void expect_same_state(const CSimulation& simulation, const Simulation& by_cpp) {
    EXPECT_EQ(echinus_simulation_frame(simulation.get()), by_cpp.frame());
    EXPECT_EQ(echinus_simulation_state_hash(simulation.get()), by_cpp.state_hash());
    EXPECT_EQ(echinus_simulation_largest_speed(simulation.get()), by_cpp.largest_speed());
    EXPECT_EQ(echinus_simulation_at_rest(simulation.get()) != 0, by_cpp.at_rest());
    ASSERT_EQ(echinus_simulation_particle_count(simulation.get()), by_cpp.positions().size());
    EXPECT_EQ(std::memcmp(echinus_simulation_positions(simulation.get()), by_cpp.positions().data(),
                          by_cpp.positions().size_bytes()),
              0);
}

ClothOptions small_sheet() {
    ClothOptions sheet{.column_count = 13, .row_count = 10, .width = 3, .height = 2.5, .pins = {0, 12}};
    sheet.pose.translation = {0, 0, 0.6};
    return sheet;
}

CDeformable c_small_sheet() {
    echinus_cloth_options sheet;
    echinus_cloth_options_init(&sheet, sizeof sheet);
    const std::uint32_t pins[2] = {0, 12};
    sheet.column_count = 13;
    sheet.row_count = 10;
    sheet.width = 3;
    sheet.height = 2.5;
    sheet.pose.translation[2] = 0.6;
    sheet.pins = pins;
    sheet.pin_count = 2;
    CDeformable cloth;
    expect_ok(echinus_deformable_cloth(&sheet, out(cloth)));
    return cloth;
}

struct Fall {
    Fall() : map(c_map(c_torus())), by_cpp_map(ExactMap::build(make_torus(1.0, 0.4, 60, 24))) {
        echinus_simulation_options_init(&options, sizeof options);
        echinus_collider_init(&collider, sizeof collider, map.get());
        options.collision = ECHINUS_COLLISION_SURFACES;
        collider.angular_velocity[0] = 1;
        by_cpp_collider.angular_velocity = {1, 0, 0};
    }

    CSimulation make(const CDeformable& cloth) {
        CSimulation simulation;
        expect_ok(echinus_simulation_create(cloth.get(), &collider, 1, &options, out(simulation)));
        return simulation;
    }
    Simulation make_by_cpp(Deformable cloth) const {
        return Simulation(std::move(cloth), {by_cpp_collider}, by_cpp_options);
    }

    CMap map;
    ExactMap by_cpp_map;
    echinus_collider collider;
    Collider by_cpp_collider{.map = by_cpp_map};
    echinus_simulation_options options;
    SimulationOptions by_cpp_options{.solver = NewtonOptions{.collision = CollisionMode::Surfaces}};
};

TEST(CSimulations, FallAsInCpp) {
    Fall fall;
    Simulation by_cpp = fall.make_by_cpp(make_cloth(small_sheet()));
    CDeformable cloth = c_small_sheet();
    const CSimulation simulation = fall.make(cloth);
    cloth.reset(); // the simulation has what it needs
    fall.map.reset();
    const float* positions = echinus_simulation_positions(simulation.get());
    expect_same_state(simulation, by_cpp);
    for (int i = 0; i < 3; ++i) {
        step(simulation.get(), 12);
        step(by_cpp, 12);
        expect_same_state(simulation, by_cpp);
        EXPECT_EQ(echinus_simulation_positions(simulation.get()), positions);
    }

    echinus_simulation_profile profile{};
    profile.size = sizeof profile;
    expect_ok(echinus_simulation_read_profile(simulation.get(), &profile));
    EXPECT_EQ(profile.query_count, by_cpp.profile().query_count);
    EXPECT_EQ(profile.contact_count, by_cpp.profile().contact_count);
    EXPECT_EQ(profile.map_query_count, by_cpp.profile().map_query_count);
    EXPECT_EQ(profile.rescued_count, by_cpp.profile().rescued_count);
    EXPECT_EQ(profile.lost_count, by_cpp.profile().lost_count);
    EXPECT_GT(profile.contact_count, 0U);
    EXPECT_GT(profile.collision_seconds, 0);
}

TEST(CSimulations, TakeEveryOption) {
    Fall fall;
    fall.options.time_step = 1.0 / 120;
    fall.options.newton_step_count = 3;
    fall.options.gravity[2] = -5;
    fall.options.stretch_stiffness = 800;
    fall.options.air_drag = 0.4;
    fall.options.thickness = 0.02;
    fall.options.friction = 0.2;
    fall.options.bound = 50;
    fall.options.rest_distance = 0.01;
    fall.options.rest_speed = 0.3;
    fall.options.rest_frame_count = 7;
    fall.options.collision = ECHINUS_COLLISION_SURFACES_AND_SELF;
    fall.options.untangle = 1;
    fall.options.thread_count = 2;
    fall.options.self_thickness = 0.015;
    fall.by_cpp_options = {.solver = NewtonOptions{.material = {.stretch_stiffness = 800},
                                                   .step_count = 3,
                                                   .air_drag = 0.4,
                                                   .self_thickness = 0.015,
                                                   .untangle = true},
                           .time_step = 1.0 / 120,
                           .gravity = {0, 0, -5},
                           .thickness = 0.02,
                           .friction = 0.2,
                           .rest = {.distance = 0.01, .speed = 0.3, .frame_count = 7},
                           .bound = 50,
                           .thread_count = 2};
    const CSimulation simulation = fall.make(c_small_sheet());
    Simulation by_cpp = fall.make_by_cpp(make_cloth(small_sheet()));
    step(simulation.get(), 25);
    step(by_cpp, 25);
    expect_same_state(simulation, by_cpp);

    echinus_simulation_options read{};
    read.size = sizeof read;
    expect_ok(echinus_simulation_read_options(simulation.get(), &read));
    EXPECT_EQ(std::memcmp(&read, &fall.options, sizeof read), 0);
}

TEST(CSimulations, TakeARowOfColliders) {
    const CMap torus = c_map(c_torus());
    echinus_collider colliders[2];
    echinus_collider_init(&colliders[0], sizeof colliders[0], torus.get());
    echinus_collider_init(&colliders[1], sizeof colliders[1], torus.get());
    colliders[1].pose.translation[0] = 5;
    const CDeformable cloth = c_small_sheet();
    CSimulation simulation;
    echinus_simulation_options options;
    echinus_simulation_options_init(&options, sizeof options);
    options.solver = ECHINUS_SOLVER_JAKOBSEN;
    expect_ok(echinus_simulation_create(cloth.get(), colliders, 2, &options, out(simulation)));
    EXPECT_EQ(echinus_simulation_collider_count(simulation.get()), 2U);
    echinus_collider read{};
    read.size = sizeof read;
    expect_ok(echinus_simulation_read_collider(simulation.get(), 1, &read));
    EXPECT_EQ(read.pose.translation[0], 5);
    std::uint8_t inside = 0;
    const float point[3] = {6, 0, 0};
    expect_ok(echinus_collider_contains(&read, point, 1, 0, 1, &inside));
    EXPECT_EQ(inside, 1);
    expect_refused(echinus_simulation_read_collider(simulation.get(), 2, &read), ECHINUS_INVALID_ARGUMENT,
                   "there is no collider 2; there are 2");
    colliders[1].size += 8;
    expect_refused(echinus_simulation_create(cloth.get(), colliders, 2, nullptr, out(simulation)),
                   ECHINUS_INVALID_ARGUMENT, "different sizes");
}

TEST(CSimulations, AreSteeredAsInCpp) {
    Fall fall;
    const CSimulation simulation = fall.make(c_small_sheet());
    Simulation by_cpp = fall.make_by_cpp(make_cloth(small_sheet()));
    const Vec3d turn{0, 2, 0}, push{1, 1, 3}, wind{4, 0, 1};
    for (int i = 0; i < 10; ++i) {
        expect_ok(
            echinus_simulation_set_collider_velocity(simulation.get(), 0, Numbers(push), Numbers(turn)));
        expect_ok(echinus_simulation_set_particle_velocity(simulation.get(), 40, Numbers(push)));
        expect_ok(echinus_simulation_blow(simulation.get(), Numbers(wind), 5));
        by_cpp.set_collider_velocity(0, push, turn);
        by_cpp.set_particle_velocity(40, push);
        by_cpp.blow(wind, 5);
        step(simulation.get(), 1);
        step(by_cpp, 1);
    }
    expect_same_state(simulation, by_cpp);
}

TEST(CSimulations, SetCollidersFreeAndReportContactsAsInCpp) {
    Fall fall;
    const CSimulation simulation = fall.make(c_small_sheet());
    Simulation by_cpp = fall.make_by_cpp(make_cloth(small_sheet()));
    expect_ok(echinus_simulation_set_collider_free(simulation.get(), 0, 0.5));
    by_cpp.set_collider_free(0, 0.5);
    expect_ok(echinus_simulation_record_contacts(simulation.get(), 1));
    by_cpp.record_contacts(true);
    std::size_t seen = 0;
    for (int i = 0; i < 30; ++i) {
        step(simulation.get(), 1);
        step(by_cpp, 1);
        echinus_array* points = nullptr;
        expect_ok(echinus_simulation_contact_points(simulation.get(), &points));
        const std::span<const ContactPoint> expected = by_cpp.contact_points();
        ASSERT_EQ(echinus_array_count(points), expected.size());
        const auto* made = static_cast<const echinus_contact_point*>(echinus_array_data(points));
        for (std::size_t p = 0; p < expected.size(); ++p) {
            const auto vector = [](const double* v) { return Vec3d{v[0], v[1], v[2]}; };
            EXPECT_EQ(vector(made[p].position), expected[p].position);
            EXPECT_EQ(vector(made[p].normal), expected[p].normal);
            EXPECT_EQ(vector(made[p].friction_impulse), expected[p].friction_impulse);
            EXPECT_EQ(made[p].gap, expected[p].gap);
            EXPECT_EQ(made[p].normal_impulse, expected[p].normal_impulse);
            EXPECT_EQ(made[p].collider, expected[p].collider);
            EXPECT_TRUE(std::equal(made[p].particles, made[p].particles + 4, expected[p].particles.begin()));
        }
        seen += expected.size();
        echinus_array_destroy(points);
    }
    EXPECT_GT(seen, 0u);
    expect_same_state(simulation, by_cpp);
    expect_refused(echinus_simulation_set_collider_free(simulation.get(), 0, -1), ECHINUS_INVALID_OPTIONS,
                   "mass of -1");
    expect_refused(echinus_simulation_set_collider_free(simulation.get(), 7, 1), ECHINUS_INVALID_ARGUMENT,
                   "collider");
}

TEST(CSimulations, LeadCollidersToPosesAndTellTheirLoadsAsInCpp) {
    Fall fall;
    const CSimulation simulation = fall.make(c_small_sheet());
    Simulation by_cpp = fall.make_by_cpp(make_cloth(small_sheet()));
    echinus_pose pose{.rotation = {1, 0, 0, 0}, .translation = {0, 0, 0}};
    double force[3], torque[3];
    for (int i = 1; i <= 30; ++i) {
        pose.translation[2] = 0.01 * i;
        expect_ok(echinus_simulation_set_collider_pose(simulation.get(), 0, &pose));
        by_cpp.set_collider_pose(0, {{}, {0, 0, pose.translation[2]}});
        step(simulation.get(), 1);
        step(by_cpp, 1);
        expect_ok(echinus_simulation_load_on(simulation.get(), 0, force, torque));
        const Load load = by_cpp.load_on(0);
        EXPECT_EQ((Vec3d{force[0], force[1], force[2]}), load.force);
        EXPECT_EQ((Vec3d{torque[0], torque[1], torque[2]}), load.torque);
    }
    expect_same_state(simulation, by_cpp);
    EXPECT_LT(force[2], 0) << "it lifts the sheet";

    pose.rotation[0] = 2;
    expect_refused(echinus_simulation_set_collider_pose(simulation.get(), 0, &pose), ECHINUS_INVALID_ARGUMENT,
                   "pose");
}

TEST(CSimulations, TellTheResidualAsInCpp) {
    Fall fall;
    const CSimulation simulation = fall.make(c_small_sheet());
    Simulation by_cpp = fall.make_by_cpp(make_cloth(small_sheet()));
    step(simulation.get(), 25);
    step(by_cpp, 25);
    double root_mean_square = -1, largest = -1;
    expect_ok(echinus_simulation_residual(simulation.get(), &root_mean_square, &largest));
    EXPECT_EQ(root_mean_square, by_cpp.residual().root_mean_square);
    EXPECT_EQ(largest, by_cpp.residual().largest);
    EXPECT_GT(largest, root_mean_square);
    EXPECT_GT(root_mean_square, 0);
}

TEST(CSimulations, OfACopyGoTheirOwnWay) {
    Fall fall;
    const CSimulation simulation = fall.make(c_small_sheet());
    step(simulation.get(), 5);
    CSimulation copy;
    expect_ok(echinus_simulation_copy(simulation.get(), out(copy)));
    const std::uint64_t before = echinus_simulation_state_hash(simulation.get());
    step(copy.get(), 5);
    EXPECT_EQ(echinus_simulation_state_hash(simulation.get()), before);
    step(simulation.get(), 5);
    EXPECT_EQ(echinus_simulation_state_hash(simulation.get()), echinus_simulation_state_hash(copy.get()));
}

TEST(CSimulations, CanOnlyBeReadOnceTheyDiverged) {
    Fall fall;
    fall.options.bound = 0.5; // the sheet is larger
    const CSimulation simulation = fall.make(c_small_sheet());
    expect_refused(echinus_simulation_step(simulation.get()), ECHINUS_DIVERGED, "diverged in frame 1");
    expect_refused(echinus_simulation_step(simulation.get()), ECHINUS_DIVERGED, "can only be read");
    const double velocity[3] = {0, 0, 1};
    expect_refused(echinus_simulation_set_particle_velocity(simulation.get(), 0, velocity), ECHINUS_DIVERGED,
                   "read");
    EXPECT_NE(echinus_simulation_positions(simulation.get()), nullptr);
    CSimulation copy;
    expect_ok(echinus_simulation_copy(simulation.get(), out(copy)));
    expect_refused(echinus_simulation_step(copy.get()), ECHINUS_DIVERGED, "can only be read");
}

// ---- Deformables

TEST(CDeformables, GoThroughTheirArraysUnchanged) {
    const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.2F}, {2, 1, 0}},
                             {{0, 1, 2}, {2, 1, 3}, {1, 4, 3}}};
    MeshClothOptions expected_options{.scale = 2, .pins = {1}, .attachments = {{.particle = 0}}};
    expected_options.rest_vertices = sheet.vertices;
    expected_options.rest_vertices[3].z = 0;
    CMesh mesh;
    expect_ok(echinus_mesh_create(&sheet.vertices.data()->x, 5, 0, sheet.faces.data()->data(), 3, out(mesh)));
    echinus_mesh_cloth_options options;
    echinus_mesh_cloth_options_init(&options, sizeof options);
    const std::uint32_t pins[1] = {1};
    const echinus_attachment attachments[1] = {{.particle = 0, .collider = 0}};
    options.scale = 2;
    options.rest_vertices = &expected_options.rest_vertices.data()->x;
    options.rest_vertex_count = 5;
    options.pins = pins;
    options.pin_count = 1;
    options.attachments = attachments;
    options.attachment_count = 1;

    const Deformable expected = make_cloth(sheet, expected_options);
    CDeformable cloth, again;
    expect_ok(echinus_deformable_cloth_of_mesh(mesh.get(), &options, out(cloth)));
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    for (int turn = 0; turn < 2; ++turn) {
        expect_ok(echinus_deformable_read((turn == 0 ? cloth : again).get(), &arrays));
        ASSERT_EQ(arrays.particle_count, expected.particle_count());
        ASSERT_EQ(arrays.constraint_count, expected.constraints.size());
        ASSERT_EQ(arrays.face_count, expected.faces.size());
        ASSERT_EQ(arrays.attachment_count, 1U);
        EXPECT_EQ(std::memcmp(arrays.positions, expected.positions.data(), 5 * sizeof(Vec3f)), 0);
        EXPECT_EQ(std::memcmp(arrays.inverse_masses, expected.inverse_masses.data(), 5 * sizeof(float)), 0);
        EXPECT_EQ(std::memcmp(arrays.faces, expected.faces.data(), 3 * sizeof(Triangle)), 0);
        for (std::size_t i = 0; i < expected.constraints.size(); ++i) {
            EXPECT_EQ(arrays.constraints[i].a, expected.constraints[i].a);
            EXPECT_EQ(arrays.constraints[i].b, expected.constraints[i].b);
            EXPECT_EQ(arrays.constraints[i].rest_length, expected.constraints[i].rest_length);
            EXPECT_EQ(arrays.constraints[i].kind, static_cast<int>(expected.constraints[i].kind));
        }
        if (turn == 0) expect_ok(echinus_deformable_create(&arrays, out(again)));
    }
}

TEST(CDeformables, BeginAtRestAndWithEqualMassesWhereNothingIsSaid) {
    const float positions[6] = {0, 0, 0, 1, 0, 0};
    const echinus_distance_constraint constraint{
        .a = 0, .b = 1, .rest_length = 1, .kind = ECHINUS_CONSTRAINT_STRUCTURAL, .reserved = {}};
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    arrays.particle_count = 2;
    arrays.positions = positions;
    arrays.constraints = &constraint;
    arrays.constraint_count = 1;
    CDeformable pair;
    expect_ok(echinus_deformable_create(&arrays, out(pair)));
    CSimulation simulation;
    expect_ok(echinus_simulation_create(pair.get(), nullptr, 0, nullptr, out(simulation)));
    expect_ok(echinus_simulation_step(simulation.get()));
    Simulation by_cpp({.positions = {{0, 0, 0}, {1, 0, 0}},
                       .inverse_masses = {1, 1},
                       .constraints = {{0, 1, 1, ConstraintKind::Structural}},
                       .faces = {}},
                      {}, {});
    by_cpp.step();
    EXPECT_EQ(echinus_simulation_state_hash(simulation.get()), by_cpp.state_hash());
}

TEST(CDeformables, AreRefusedWhenTheyDoNotFitTogether) {
    const float positions[6] = {};
    echinus_distance_constraint constraint{.a = 0, .b = 7, .rest_length = 1, .kind = 0, .reserved = {}};
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    arrays.particle_count = 2;
    CDeformable deformable;
    expect_refused(echinus_deformable_create(&arrays, out(deformable)), ECHINUS_INVALID_ARGUMENT,
                   "positions is NULL");
    arrays.positions = positions;
    arrays.constraints = &constraint;
    arrays.constraint_count = 1;
    expect_ok(echinus_deformable_create(&arrays, out(deformable)));
    CSimulation simulation;
    expect_refused(echinus_simulation_create(deformable.get(), nullptr, 0, nullptr, out(simulation)),
                   ECHINUS_INVALID_OPTIONS, "constraint");
    constraint.kind = 3;
    expect_refused(echinus_deformable_create(&arrays, out(deformable)), ECHINUS_INVALID_ARGUMENT,
                   "constraint 0 is of kind 3");
}

// ---- Scenes

TEST(CScenesOfTheRepository, AreSimulatedAsInCpp) {
    CScene scene;
    expect_ok(echinus_scene_read(kScene.c_str(), out(scene)));
    CSimulation simulation;
    expect_ok(echinus_simulation_from_scene(scene.get(), nullptr, 0, 1, out(simulation)));
    const Scene by_cpp = read_scene(kScene);
    EXPECT_EQ(echinus_scene_frame_limit(scene.get()), by_cpp.frame_limit);
    const SceneCollider& collider = by_cpp.colliders.front();
    const TriangleMesh model = repair(make_mesh(std::get<TorusModel>(collider.model)), collider.repair).mesh;
    Simulation expected = make_simulation(by_cpp, build_map(model, by_cpp.map));
    step(simulation.get(), 10);
    step(expected, 10);
    expect_same_state(simulation, expected);
}

TEST_F(CScenes, AreRefusedWithTheKeyAtFault) {
    CScene scene;
    expect_refused(echinus_scene_parse(R"({"model": {"torus": {}}, "clot": {}})", "name.json", out(scene)),
                   ECHINUS_INVALID_SCENE, "clot");
    expect_refused(echinus_scene_read(path("none.json").string().c_str(), out(scene)), ECHINUS_UNREADABLE,
                   "none.json");
    EXPECT_EQ(scene, nullptr);
}

TEST_F(CScenes, FindTheirFilesInTheFoldersThatAreNamed) {
    const CMesh torus = c_torus();
    expect_ok(echinus_mesh_write(torus.get(), path("torus.obj").string().c_str()));
    std::filesystem::create_directories(path("elsewhere"));
    const std::string json =
        R"({"model": "torus.obj", "cloth": {"particles": [5, 5], "size": [3, 3], "position": [0, 0, 0.6]}})";
    CScene scene;
    CSimulation simulation;
    expect_ok(echinus_scene_read(write("scene.json", json).string().c_str(), out(scene)));
    expect_ok(echinus_simulation_from_scene(scene.get(), nullptr, 0, 1, out(simulation)));

    expect_ok(echinus_scene_parse(json.c_str(), path("elsewhere/scene.json").string().c_str(), out(scene)));
    expect_refused(echinus_simulation_from_scene(scene.get(), nullptr, 0, 1, out(simulation)),
                   ECHINUS_UNREADABLE, "torus.obj");
    const std::string folder = path("").string();
    const char* const folders[1] = {folder.c_str()};
    expect_ok(echinus_simulation_from_scene(scene.get(), folders, 1, 1, out(simulation)));
    EXPECT_EQ(echinus_simulation_particle_count(simulation.get()), 25U);
    const char* const null_folder[1] = {nullptr};
    expect_refused(echinus_simulation_from_scene(scene.get(), null_folder, 1, 1, out(simulation)),
                   ECHINUS_INVALID_ARGUMENT, "a folder is NULL");
}

} // namespace

TEST(CSimulations, RefuseOptionsOfTheSolverThatIsNotChosen) {
    const CDeformable sheet = c_small_sheet();
    const auto created = [&](echinus_simulation_options options, CSimulation& simulation) {
        return echinus_simulation_create(sheet.get(), nullptr, 0, &options, out(simulation));
    };
    echinus_simulation_options options;
    echinus_simulation_options_init(&options, sizeof options);
    CSimulation simulation;
    options.drag = 0.1;
    expect_refused(created(options, simulation), ECHINUS_INVALID_OPTIONS, "only the jakobsen solver has it");
    options.solver = ECHINUS_SOLVER_JAKOBSEN;
    options.time_step = 1.0 / 240;
    expect_ok(created(options, simulation));
    options.air_drag = 0;
    expect_refused(created(options, simulation), ECHINUS_INVALID_OPTIONS, "only the newton solver has it");
}

TEST(CSimulations, HaveCollisionOfParticlesWithJakobsenWhetherThatIsSaidOrNot) {
    const CDeformable sheet = c_small_sheet();
    echinus_simulation_options options, read;
    echinus_simulation_options_init(&options, sizeof options);
    options.solver = ECHINUS_SOLVER_JAKOBSEN;
    for (const auto mode : {ECHINUS_COLLISION_SURFACES_AND_SELF, ECHINUS_COLLISION_PARTICLES}) {
        options.collision = mode;
        CSimulation simulation;
        expect_ok(echinus_simulation_create(sheet.get(), nullptr, 0, &options, out(simulation)));
        read.size = sizeof read;
        expect_ok(echinus_simulation_read_options(simulation.get(), &read));
        EXPECT_EQ(read.collision, ECHINUS_COLLISION_PARTICLES);
    }
    options.collision = ECHINUS_COLLISION_SURFACES;
    CSimulation simulation;
    expect_refused(echinus_simulation_create(sheet.get(), nullptr, 0, &options, out(simulation)),
                   ECHINUS_INVALID_OPTIONS, "only the newton solver has it");
}
