#include "handles.hpp"

#include <echinus/map_file.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

using namespace echinus;
using namespace echinus::test;

namespace {

/// The options of a program that was compiled with a newer header.
struct NewerOptions {
    echinus_exact_map_options known;
    std::uint32_t unknown = 0;
    std::uint32_t also_unknown = 0;
};

TEST(CStructs, OfANewerHeaderAreTakenIfTheySetNothingNew) {
    const CMesh mesh = c_torus();
    NewerOptions options;
    echinus_exact_map_options_init(&options.known, sizeof options);
    EXPECT_EQ(options.known.size, sizeof options);
    EXPECT_EQ(options.unknown, 0U);
    CMap map;
    expect_ok(echinus_map_build_exact(mesh.get(), &options.known, out(map)));

    options.also_unknown = 1;
    expect_refused(echinus_map_build_exact(mesh.get(), &options.known, out(map)), ECHINUS_INVALID_ARGUMENT,
                   "options sets a member that version");
    EXPECT_EQ(map, nullptr);
}

TEST(CStructs, OfANewerHeaderGetZeroWhereTheLibraryKnowsNothing) {
    struct NewerInfo {
        echinus_map_info known;
        std::uint64_t unknown;
    } info;
    std::memset(&info, 0xFF, sizeof info);
    info.known.size = sizeof info;
    const CMap map = c_map(c_torus());
    expect_ok(echinus_map_describe(map.get(), &info.known));
    EXPECT_EQ(info.known.size, sizeof info);
    EXPECT_EQ(info.known.kind, ECHINUS_MAP_EXACT);
    EXPECT_EQ(info.unknown, 0U);
}

TEST(CStructs, AreRefusedWithASizeThatCannotBeRight) {
    const CMesh mesh = c_torus();
    echinus_exact_map_options options;
    echinus_exact_map_options_init(&options, sizeof options);
    CMap map;
    for (const std::size_t wrong :
         {std::size_t{0}, std::size_t{8}, offsetof(echinus_exact_map_options, find_certain_gaps) - 1,
          std::size_t{5000}, SIZE_MAX}) {
        options.size = wrong;
        expect_refused(echinus_map_build_exact(mesh.get(), &options, out(map)), ECHINUS_INVALID_ARGUMENT,
                       "the size of options is " + std::to_string(wrong));
    }
    echinus_mesh_report report{};
    expect_refused(echinus_mesh_inspect(mesh.get(), &report), ECHINUS_INVALID_ARGUMENT,
                   "the size of report is 0");
}

TEST(CStructs, AreFilledNoFartherThanTheirSize) {
    struct {
        echinus_exact_map_options options;
        unsigned char after[16];
    } guarded;
    std::memset(&guarded, 0xAB, sizeof guarded);
    echinus_exact_map_options_init(&guarded.options, offsetof(echinus_exact_map_options, byte_budget));
    const auto* bytes = reinterpret_cast<const unsigned char*>(&guarded);
    for (std::size_t i = offsetof(echinus_exact_map_options, byte_budget); i < sizeof guarded; ++i)
        ASSERT_EQ(bytes[i], 0xAB) << i;
    echinus_exact_map_options_init(nullptr, sizeof guarded.options);
}

TEST(CStructs, EnumeratorsAreInRange) {
    const CMesh mesh = c_torus();
    echinus_exact_map_options options;
    echinus_exact_map_options_init(&options, sizeof options);
    const std::int32_t wrong = 7;
    std::memcpy(&options.rule, &wrong, sizeof wrong);
    CMap map;
    expect_refused(echinus_map_build_exact(mesh.get(), &options, out(map)), ECHINUS_INVALID_ARGUMENT,
                   "options.rule is 7; expected 0 to 1");
}

// What _init writes are the defaults of C++.
TEST(CStructs, AreFilledWithTheDefaultsOfCpp) {
    echinus_exact_map_options exact;
    echinus_exact_map_options_init(&exact, sizeof exact);
    const ExactMapOptions exact_defaults;
    EXPECT_EQ(exact.divisions, exact_defaults.divisions);
    EXPECT_EQ(exact.byte_budget, exact_defaults.byte_budget);
    EXPECT_EQ(static_cast<int>(exact.rule), static_cast<int>(exact_defaults.rule));
    EXPECT_EQ(static_cast<int>(exact.centre), static_cast<int>(exact_defaults.centre));
    EXPECT_EQ(exact.find_certain_gaps != 0, exact_defaults.find_certain_gaps);

    echinus_distance_map_options distance;
    echinus_distance_map_options_init(&distance, sizeof distance);
    const DistanceMapOptions distance_defaults;
    EXPECT_EQ(distance.longitude_count, distance_defaults.longitude_count);
    EXPECT_EQ(distance.colatitude_count, distance_defaults.colatitude_count);
    EXPECT_EQ(distance.divisions, distance_defaults.divisions);
    EXPECT_EQ(static_cast<int>(distance.correction), static_cast<int>(distance_defaults.correction));
    EXPECT_EQ(static_cast<int>(distance.pole_axis), static_cast<int>(distance_defaults.pole_axis));

    echinus_cloth_options cloth;
    echinus_cloth_options_init(&cloth, sizeof cloth);
    EXPECT_EQ(cloth.column_count, ClothOptions{}.column_count);
    EXPECT_EQ(cloth.width, ClothOptions{}.width);
    EXPECT_EQ(cloth.pose.rotation[0], 1);

    echinus_mesh_cloth_options mesh_cloth;
    echinus_mesh_cloth_options_init(&mesh_cloth, sizeof mesh_cloth);
    EXPECT_EQ(mesh_cloth.scale, MeshClothOptions{}.scale);
    EXPECT_EQ(mesh_cloth.pose.rotation[0], 1);

    echinus_soft_body_options body;
    echinus_soft_body_options_init(&body, sizeof body);
    EXPECT_EQ(body.density, SoftBodyOptions{}.density);
    EXPECT_EQ(body.young_modulus, SoftBodyOptions{}.young_modulus);
    EXPECT_EQ(body.poisson_ratio, SoftBodyOptions{}.poisson_ratio);
    EXPECT_EQ(body.damping, SoftBodyOptions{}.damping);
    EXPECT_EQ(body.scale, SoftBodyOptions{}.scale);
    EXPECT_EQ(body.pose.rotation[0], 1);

    echinus_simulation_options simulation;
    echinus_simulation_options_init(&simulation, sizeof simulation);
    const SimulationOptions defaults;
    EXPECT_EQ(simulation.time_step, defaults.time_step);
    EXPECT_EQ(simulation.iteration_count, defaults.iteration_count);
    EXPECT_EQ(simulation.substep_count, defaults.substep_count);
    EXPECT_EQ(simulation.gravity[2], defaults.gravity.z);
    EXPECT_EQ(simulation.drag, defaults.drag);
    EXPECT_EQ(simulation.stiffness[2], defaults.stiffness[2]);
    EXPECT_EQ(simulation.compliance[2], defaults.compliance[2]);
    EXPECT_EQ(simulation.thickness, ECHINUS_THICKNESS_CHOSEN);
    EXPECT_EQ(simulation.self_thickness, ECHINUS_THICKNESS_CHOSEN);
    EXPECT_EQ(simulation.friction, defaults.friction);
    EXPECT_EQ(simulation.rest_distance, defaults.rest.distance);
    EXPECT_EQ(simulation.rest_speed, defaults.rest.speed);
    EXPECT_EQ(simulation.rest_frame_count, defaults.rest.frame_count);
    EXPECT_EQ(simulation.keep_free, 1);
    EXPECT_EQ(simulation.surface_collision, 0);
    EXPECT_EQ(simulation.bound, defaults.bound);
    EXPECT_EQ(simulation.thread_count, defaults.thread_count);
    EXPECT_EQ(simulation.multilevel != 0, defaults.multilevel);
}

} // namespace
