#include "handles.hpp"

#include <echinus/version.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>

using namespace echinus::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(CErrors, HaveTheNamesOfTheHeader) {
    EXPECT_STREQ(echinus_status_name(ECHINUS_OK), "ECHINUS_OK");
    EXPECT_STREQ(echinus_status_name(ECHINUS_DIVERGED), "ECHINUS_DIVERGED");
    EXPECT_STREQ(echinus_status_name(ECHINUS_OUT_OF_MEMORY), "ECHINUS_OUT_OF_MEMORY");
    EXPECT_STREQ(echinus_version(), ECHINUS_VERSION_STRING);
}

TEST(CErrors, KeepASentenceForEachThread) {
    EXPECT_EQ(echinus_use_instruction_set("none such"), ECHINUS_INVALID_OPTIONS);
    const std::string mine = echinus_last_error();
    EXPECT_NE(mine.find("none such"), std::string::npos) << mine;
    std::thread([] {
        EXPECT_STREQ(echinus_last_error(), "");
        CMesh mesh;
        EXPECT_EQ(echinus_mesh_read("no such file.obj", out(mesh)), ECHINUS_UNREADABLE);
        EXPECT_NE(std::string(echinus_last_error()).find("no such file.obj"), std::string::npos);
    }).join();
    EXPECT_EQ(echinus_last_error(), mine);
    const CMesh mesh = c_torus(); // what succeeds leaves the sentence
    EXPECT_EQ(echinus_last_error(), mine);
}

TEST(CErrors, AreCutBetweenCharacters) {
    std::string name;
    while (name.size() < 5000) name += "\xC3\xA4"; // a with dots
    for (const char* prefix : {"", "x"}) {
        EXPECT_EQ(echinus_use_instruction_set((prefix + name).c_str()), ECHINUS_INVALID_OPTIONS);
        const std::string sentence = echinus_last_error();
        EXPECT_GT(sentence.size(), 2000U);
        EXPECT_LT(sentence.size(), 2048U);
        EXPECT_EQ(static_cast<unsigned char>(sentence.back()), 0xA4);
    }
}

#ifndef __SANITIZE_ADDRESS__ // which ends the program instead
TEST(CErrors, TellWhenMemoryDoesNotSuffice) {
    const float point[3] = {};
    const std::uint32_t corners[3] = {};
    CMesh mesh;
    expect_refused(echinus_mesh_create(point, std::size_t{1} << 55, 0, corners, 1, out(mesh)),
                   ECHINUS_OUT_OF_MEMORY, "echinus_mesh_create: memory did not suffice");
    EXPECT_EQ(mesh, nullptr);
}
#endif

TEST(CLibrary, SelectsInstructionSetsByName) {
    const std::string before = echinus_instruction_set();
    std::size_t count = 0;
    while (const char* name = echinus_available_instruction_set(count)) {
        expect_ok(echinus_use_instruction_set(name));
        EXPECT_STREQ(echinus_instruction_set(), name);
        ++count;
    }
    EXPECT_GE(count, 1U);
    EXPECT_STREQ(echinus_available_instruction_set(count - 1), "scalar");
    EXPECT_EQ(echinus_available_instruction_set(SIZE_MAX), nullptr);
    expect_ok(echinus_use_instruction_set(before.c_str()));
}

// Each call has one null more than it may have; the sentence names the function and the argument.
TEST(CArguments, AreRefusedWhenNull) {
    const CMesh mesh = c_torus();
    const CMap map = c_map(mesh);
    const float points[9] = {};
    const double numbers[4] = {0, 0, 1, 0};
    double result[4];
    std::uint8_t flag = 0;
    echinus_contact contact;
    echinus_sweep_hit hit;
    echinus_clearance clearance;
    echinus_triangle_sweep_hit triangle_hit;
    echinus_collider collider;
    echinus_collider_init(&collider, sizeof collider, map.get());
    echinus_collider without_map = collider;
    without_map.map = nullptr;
    echinus_pose pose = collider.pose;
    CMesh no_mesh;
    CMap no_map;
    CArray no_array;
    CDeformable cloth;
    expect_ok(echinus_deformable_cloth(nullptr, out(cloth)));
    CSimulation simulation;
    expect_ok(echinus_simulation_create(cloth.get(), nullptr, 0, nullptr, out(simulation)));
    CScene scene;
    const std::uint32_t corners[3] = {0, 1, 2};
    const char* const null_folder[1] = {nullptr};
    expect_ok(
        echinus_scene_parse(R"({"model": {"torus": {}}, "cloth": {"size": [1, 1]}})", "name", out(scene)));

    const auto expect_null = [](echinus_status status, const std::string& function, const std::string& name) {
        expect_refused(status, ECHINUS_INVALID_ARGUMENT, "echinus_" + function + ": " + name);
    };
    expect_null(echinus_use_instruction_set(nullptr), "use_instruction_set", "name is NULL");

    const std::string place = "the place for the result is NULL";
    expect_null(echinus_mesh_create(nullptr, 3, 0, corners, 1, out(no_mesh)), "mesh_create",
                "vertices is NULL");
    expect_null(echinus_mesh_create(points, 3, 0, nullptr, 1, out(no_mesh)), "mesh_create", "faces is NULL");
    expect_null(echinus_mesh_create(points, 3, 0, corners, 1, nullptr), "mesh_create", place);
    expect_null(echinus_mesh_read(nullptr, out(no_mesh)), "mesh_read", "path is NULL");
    expect_null(echinus_mesh_read("x.obj", nullptr), "mesh_read", place);
    expect_null(echinus_mesh_write(nullptr, "x.obj"), "mesh_write", "mesh is NULL");
    expect_null(echinus_mesh_write(mesh.get(), nullptr), "mesh_write", "path is NULL");
    expect_null(echinus_mesh_box(nullptr, 1, out(no_mesh)), "mesh_box", "size is NULL");
    expect_null(echinus_mesh_inspect(mesh.get(), nullptr), "mesh_inspect", "report is NULL");
    expect_null(echinus_mesh_repair(mesh.get(), nullptr, out(no_mesh), nullptr, nullptr), "mesh_repair",
                "options is NULL");
    expect_null(echinus_mesh_weld(nullptr, out(no_mesh)), "mesh_weld", "mesh is NULL");
    expect_null(echinus_mesh_winding_number(mesh.get(), nullptr, result), "mesh_winding_number",
                "point is NULL");
    expect_null(echinus_mesh_winding_number(mesh.get(), numbers, nullptr), "mesh_winding_number",
                "winding_number is NULL");
    expect_null(echinus_mesh_unsigned_distance(nullptr, numbers, result), "mesh_unsigned_distance",
                "mesh is NULL");
    expect_null(echinus_mesh_intersecting_pairs(mesh.get(), nullptr, out(no_array)),
                "mesh_intersecting_pairs", "b is NULL");
    expect_null(echinus_mesh_self_intersecting_pairs(nullptr, out(no_array)), "mesh_self_intersecting_pairs",
                "mesh is NULL");

    expect_null(echinus_map_build_exact(nullptr, nullptr, out(no_map)), "map_build_exact", "mesh is NULL");
    expect_null(echinus_map_build_distance(nullptr, nullptr, out(no_map)), "map_build_distance",
                "mesh is NULL");
    expect_null(echinus_map_build_exact(mesh.get(), nullptr, nullptr), "map_build_exact", place);
    expect_null(echinus_map_describe(map.get(), nullptr), "map_describe", "info is NULL");
    expect_null(echinus_map_exact_statistics(nullptr, nullptr), "map_exact_statistics", "map is NULL");
    expect_null(echinus_map_distance_statistics(nullptr, nullptr), "map_distance_statistics", "map is NULL");
    expect_null(echinus_map_surface(map.get(), nullptr, nullptr), "map_surface", "mesh is NULL");
    expect_null(echinus_map_builder_create(corners, 1, nullptr, nullptr), "map_builder_create", place);
    expect_null(echinus_map_builder_rebuild(nullptr, points, 3, 0, out(no_map)), "map_builder_rebuild",
                "builder is NULL");
    expect_null(echinus_map_save(map.get(), nullptr), "map_save", "path is NULL");
    expect_null(echinus_map_serialise(nullptr, out(no_array)), "map_serialise", "map is NULL");
    expect_null(echinus_map_load(nullptr, out(no_map)), "map_load", "path is NULL");
    expect_null(echinus_map_view(nullptr, 8, nullptr, nullptr, "name", out(no_map)), "map_view",
                "bytes is NULL");
    expect_null(echinus_map_view(numbers, 8, nullptr, nullptr, nullptr, out(no_map)), "map_view",
                "name is NULL");
    expect_null(echinus_map_from_custom(nullptr, out(no_map)), "map_from_custom", "custom is NULL");

    expect_null(echinus_map_contains(nullptr, points, 1, 0, 1, &flag), "map_contains", "map is NULL");
    expect_null(echinus_map_contains(map.get(), nullptr, 1, 0, 1, &flag), "map_contains", "points is NULL");
    expect_null(echinus_map_contains(map.get(), points, 1, 0, 1, nullptr), "map_contains", "inside is NULL");
    expect_null(echinus_map_classify(map.get(), points, 1, 0, &flag, nullptr), "map_classify",
                "certain is NULL");
    expect_null(echinus_map_contacts(map.get(), points, 1, 0, 0, 1, nullptr), "map_contacts",
                "contacts is NULL");
    expect_null(echinus_map_sweep(map.get(), points, 0, nullptr, 0, 1, &hit), "map_sweep", "to is NULL");
    expect_null(echinus_map_sweep(map.get(), points, 0, points, 0, 1, nullptr), "map_sweep", "hits is NULL");
    expect_null(echinus_map_intersects(map.get(), nullptr, 1, 0, &flag), "map_intersects",
                "triangles is NULL");
    expect_null(echinus_map_clearance(nullptr, points, 1, 0, 1, &clearance), "map_clearance", "map is NULL");
    expect_null(echinus_map_sweep_triangles(map.get(), nullptr, 0, points, 0, 1, &triangle_hit),
                "map_sweep_triangles", "from is NULL");
    expect_null(echinus_map_faces_within(map.get(), points, 3, 0, corners, 1, 1, 1, nullptr, out(no_array)),
                "map_faces_within", "offsets is NULL");

    expect_null(echinus_rotation_about(numbers, 1, nullptr), "rotation_about", "rotation is NULL");
    expect_null(echinus_collider_contains(nullptr, points, 1, 0, &flag), "collider_contains",
                "collider is NULL");
    expect_null(echinus_collider_contains(&without_map, points, 1, 0, &flag), "collider_contains",
                "the map of the collider is NULL");
    expect_null(echinus_collider_contacts(&collider, nullptr, 1, 0, 0, &contact), "collider_contacts",
                "points is NULL");
    expect_null(echinus_collider_sweep(&collider, nullptr, points, 0, points, 0, 1, &hit), "collider_sweep",
                "previous is NULL");
    expect_null(echinus_collider_sweep(&collider, &pose, points, 0, points, 0, 1, nullptr), "collider_sweep",
                "hits is NULL");
    expect_null(echinus_collider_velocity_at(&collider, numbers, nullptr), "collider_velocity_at",
                "velocity is NULL");
    expect_null(echinus_collider_pose_after(&collider, 1, nullptr), "collider_pose_after", "pose is NULL");

    expect_null(echinus_deformable_create(nullptr, out(cloth)), "deformable_create", "arrays is NULL");
    expect_null(echinus_deformable_cloth(nullptr, nullptr), "deformable_cloth", place);
    expect_null(echinus_deformable_cloth_of_mesh(nullptr, nullptr, out(cloth)), "deformable_cloth_of_mesh",
                "mesh is NULL");
    expect_null(echinus_deformable_read(nullptr, nullptr), "deformable_read", "deformable is NULL");
    expect_null(echinus_simulation_create(nullptr, nullptr, 0, nullptr, out(simulation)), "simulation_create",
                "deformable is NULL");
    expect_null(echinus_simulation_copy(nullptr, out(simulation)), "simulation_copy", "simulation is NULL");
    expect_null(echinus_simulation_step(nullptr), "simulation_step", "simulation is NULL");
    expect_null(echinus_simulation_read(nullptr, nullptr), "simulation_read", "simulation is NULL");
    expect_null(echinus_simulation_read_profile(nullptr, nullptr), "simulation_read_profile",
                "simulation is NULL");
    expect_null(echinus_simulation_read_options(nullptr, nullptr), "simulation_read_options",
                "simulation is NULL");
    expect_null(echinus_simulation_read_collider(nullptr, 0, &collider), "simulation_read_collider",
                "simulation is NULL");
    expect_null(echinus_simulation_set_collider_velocity(nullptr, 0, numbers, numbers),
                "simulation_set_collider_velocity", "simulation is NULL");
    expect_null(echinus_simulation_set_particle_velocity(nullptr, 0, numbers),
                "simulation_set_particle_velocity", "simulation is NULL");
    expect_null(echinus_simulation_blow(nullptr, numbers, 1), "simulation_blow", "simulation is NULL");
    CScene no_scene;
    expect_null(echinus_scene_read(nullptr, out(no_scene)), "scene_read", "path is NULL");
    expect_null(echinus_scene_parse(nullptr, "name", out(no_scene)), "scene_parse", "json is NULL");
    expect_null(echinus_scene_parse("{}", nullptr, out(no_scene)), "scene_parse", "name is NULL");
    expect_null(echinus_simulation_from_scene(nullptr, nullptr, 0, 1, out(simulation)),
                "simulation_from_scene", "scene is NULL");
    expect_null(echinus_simulation_from_scene(scene.get(), null_folder, 1, 1, out(simulation)),
                "simulation_from_scene", "a folder is NULL");
}

TEST(CArguments, OfNullGiveNoValue) {
    EXPECT_EQ(echinus_array_data(nullptr), nullptr);
    EXPECT_EQ(echinus_array_count(nullptr), 0U);
    EXPECT_EQ(echinus_mesh_vertices(nullptr), nullptr);
    EXPECT_EQ(echinus_mesh_vertex_count(nullptr), 0U);
    EXPECT_EQ(echinus_mesh_faces(nullptr), nullptr);
    EXPECT_EQ(echinus_mesh_face_count(nullptr), 0U);
    EXPECT_EQ(echinus_simulation_positions(nullptr), nullptr);
    EXPECT_EQ(echinus_simulation_particle_count(nullptr), 0U);
    EXPECT_EQ(echinus_simulation_frame(nullptr), 0U);
    EXPECT_EQ(echinus_simulation_at_rest(nullptr), 0);
    EXPECT_EQ(echinus_simulation_largest_speed(nullptr), 0);
    EXPECT_EQ(echinus_simulation_state_hash(nullptr), 0U);
    EXPECT_EQ(echinus_simulation_collider_count(nullptr), 0U);
    EXPECT_EQ(echinus_scene_frame_limit(nullptr), 0U);
}

TEST(CArguments, AreNotNeededForNoPoints) {
    const CMap map = c_map(c_torus());
    echinus_collider collider;
    echinus_collider_init(&collider, sizeof collider, map.get());
    CArray offsets, faces;
    expect_ok(echinus_map_contains(map.get(), nullptr, 0, 0, 1, nullptr));
    expect_ok(echinus_map_classify(map.get(), nullptr, 0, 0, nullptr, nullptr));
    expect_ok(echinus_map_contacts(map.get(), nullptr, 0, 0, 0, 1, nullptr));
    expect_ok(echinus_map_sweep(map.get(), nullptr, 0, nullptr, 0, 0, nullptr));
    expect_ok(echinus_map_intersects(map.get(), nullptr, 0, 0, nullptr));
    expect_ok(echinus_map_clearance(map.get(), nullptr, 0, 0, 1, nullptr));
    expect_ok(echinus_map_sweep_triangles(map.get(), nullptr, 0, nullptr, 0, 0, nullptr));
    expect_ok(echinus_map_faces_within(map.get(), nullptr, 0, 0, nullptr, 0, 1, 1, out(offsets), out(faces)));
    EXPECT_EQ(values_of<std::uint32_t>(offsets).size(), 1U);
    EXPECT_EQ(values_of<std::uint32_t>(faces).size(), 0U);
    expect_ok(echinus_collider_contains(&collider, nullptr, 0, 0, nullptr));
    expect_ok(echinus_collider_contacts(&collider, nullptr, 0, 0, 0, nullptr));
}

TEST(CArguments, StridesAreWholeFloatsAndWideEnough) {
    const CMap map = c_map(c_torus());
    const std::array<float, 64> floats{};
    std::array<std::uint8_t, 4> inside{};
    const auto ask = [&](const float* first, std::size_t count, std::size_t stride) {
        return echinus_map_contains(map.get(), first, count, stride, 1, inside.data());
    };
    expect_ok(ask(floats.data(), 4, 16));
    for (const std::size_t stride : {1, 8, 13, 14})
        expect_refused(ask(floats.data(), 4, stride), ECHINUS_INVALID_ARGUMENT,
                       "the stride of points is " + std::to_string(stride));
    const auto* shifted = reinterpret_cast<const float*>(reinterpret_cast<const char*>(floats.data()) + 2);
    expect_refused(ask(shifted, 4, 0), ECHINUS_INVALID_ARGUMENT,
                   "the address of points is not a multiple of 4");
    expect_refused(ask(floats.data(), SIZE_MAX / 4, 0), ECHINUS_INVALID_ARGUMENT,
                   "more than memory can hold");
    CMesh mesh;
    const std::uint32_t corners[3] = {0, 1, 2};
    expect_refused(echinus_mesh_create(floats.data(), 3, 0, corners, SIZE_MAX / 2, out(mesh)),
                   ECHINUS_INVALID_ARGUMENT, "more than memory can hold");
}

TEST(CArguments, LengthsAreNotNegative) {
    const CMap map = c_map(c_torus());
    const float points[9] = {};
    echinus_contact contact;
    echinus_clearance clearance;
    CArray offsets, faces;
    const std::uint32_t corners[3] = {0, 1, 2};
    for (const float wrong : {-1.0F, kNan}) {
        expect_refused(echinus_map_contacts(map.get(), points, 1, 0, wrong, 1, &contact),
                       ECHINUS_INVALID_ARGUMENT, "margin is");
        expect_refused(echinus_map_clearance(map.get(), points, 1, 0, wrong, &clearance),
                       ECHINUS_INVALID_ARGUMENT, "farthest is");
        expect_refused(
            echinus_map_faces_within(map.get(), points, 3, 0, corners, 1, wrong, 1, out(offsets), out(faces)),
            ECHINUS_INVALID_ARGUMENT, "reach is");
    }
    expect_ok(
        echinus_map_clearance(map.get(), points, 1, 0, std::numeric_limits<float>::infinity(), &clearance));
}

TEST(CArguments, FlagsAreZeroOrOne) {
    const CMesh mesh = c_torus();
    CMesh repaired;
    for (const auto flag :
         {&echinus_repair_options::drop_duplicate_faces, &echinus_repair_options::drop_inner_faces})
        for (const std::int32_t wrong : {2, -1}) {
            echinus_repair_options options;
            echinus_repair_options_init(&options, sizeof options);
            options.*flag = wrong;
            expect_refused(echinus_mesh_repair(mesh.get(), &options, out(repaired), nullptr, nullptr),
                           ECHINUS_INVALID_ARGUMENT,
                           "faces is " + std::to_string(wrong) + "; expected 0 or 1");
        }
    CDeformable cloth;
    expect_ok(echinus_deformable_cloth(nullptr, out(cloth)));
    CSimulation simulation;
    echinus_simulation_options options;
    echinus_simulation_options_init(&options, sizeof options);
    options.multilevel = std::uint64_t{1} << 32;
    expect_refused(echinus_simulation_create(cloth.get(), nullptr, 0, &options, out(simulation)),
                   ECHINUS_INVALID_ARGUMENT, "options.multilevel is 4294967296; expected 0 or 1");
    options.multilevel = 1;
    options.keep_free = 3;
    expect_refused(echinus_simulation_create(cloth.get(), nullptr, 0, &options, out(simulation)),
                   ECHINUS_INVALID_ARGUMENT, "options.keep_free is 3; expected 0 or 1");
}

TEST(CArguments, ReservedMembersOfOptionsAreZero) {
    const CMesh mesh = c_torus();
    const auto expect_named = [](echinus_status status) {
        expect_refused(status, ECHINUS_INVALID_ARGUMENT, "options.reserved is 7; expected 0");
    };
    echinus_repair_options repair;
    echinus_repair_options_init(&repair, sizeof repair);
    repair.reserved = 7;
    CMesh repaired;
    expect_named(echinus_mesh_repair(mesh.get(), &repair, out(repaired), nullptr, nullptr));
    echinus_distance_map_options map;
    echinus_distance_map_options_init(&map, sizeof map);
    map.reserved = 7;
    CMap built;
    expect_named(echinus_map_build_distance(mesh.get(), &map, out(built)));
    echinus_mesh_cloth_options cloth;
    echinus_mesh_cloth_options_init(&cloth, sizeof cloth);
    cloth.reserved = 7;
    CDeformable sheet;
    expect_named(echinus_deformable_cloth_of_mesh(mesh.get(), &cloth, out(sheet)));
    echinus_tetrahedralize_options filling;
    echinus_tetrahedralize_options_init(&filling, sizeof filling);
    filling.reserved = 7;
    CTetrahedra body;
    expect_named(echinus_tetrahedralize(c_map(mesh).get(), &filling, out(body), nullptr));
}

TEST(CArguments, ArraysAreNoLargerThanMemory) {
    constexpr std::size_t kMany = std::size_t{1} << 60;
    const CMap map = c_map(c_torus());
    echinus_collider collider;
    echinus_collider_init(&collider, sizeof collider, map.get());
    CDeformable cloth;
    expect_ok(echinus_deformable_cloth(nullptr, out(cloth)));
    CSimulation simulation;
    expect_refused(echinus_simulation_create(cloth.get(), &collider, kMany, nullptr, out(simulation)),
                   ECHINUS_INVALID_ARGUMENT,
                   "the count of colliders, " + std::to_string(kMany) + ", is more than memory can hold");
    const echinus_stick stick{};
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    arrays.sticks = &stick;
    arrays.stick_count = kMany;
    expect_refused(echinus_deformable_create(&arrays, out(cloth)), ECHINUS_INVALID_ARGUMENT,
                   "the count of sticks");
}

TEST(CArguments, MapsHaveTheKindThatAQueryNeeds) {
    const CMesh mesh = c_torus();
    const CMap distance = c_distance_map(mesh);
    const float points[9] = {};
    echinus_sweep_hit hit;
    expect_refused(echinus_map_sweep(distance.get(), points, 0, points, 0, 1, &hit), ECHINUS_INVALID_ARGUMENT,
                   "map is not an exact map");
    const CMap exact = c_map(mesh);
    echinus_distance_map_statistics statistics{};
    statistics.size = sizeof statistics;
    expect_refused(echinus_map_distance_statistics(exact.get(), &statistics), ECHINUS_INVALID_ARGUMENT,
                   "map is not a distance map");
}

} // namespace
