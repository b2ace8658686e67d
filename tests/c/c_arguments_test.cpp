#include "handles.hpp"

#include <echinus/map_file.hpp>
#include <echinus/version.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

using namespace echinus::test;

namespace {

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
                   ECHINUS_OUT_OF_MEMORY, "echinus_mesh_create: out of memory");
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

TEST(CArguments, AreNotNeededForNoPoints) {
    const CMap map = c_map(c_torus());
    echinus_collider collider;
    echinus_collider_init(&collider, sizeof collider, map.get());
    CArray offsets, faces;
    expect_ok(echinus_map_contains(map.get(), nullptr, 0, 0, 1, nullptr));
    expect_ok(echinus_map_classify(map.get(), nullptr, 0, 0, 1, nullptr, nullptr));
    expect_ok(echinus_map_contacts(map.get(), nullptr, 0, 0, 0, 1, nullptr));
    expect_ok(echinus_map_sweep(map.get(), nullptr, 0, nullptr, 0, 0, 1, nullptr));
    expect_ok(echinus_map_intersects(map.get(), nullptr, 0, 0, 1, nullptr));
    expect_ok(echinus_map_clearance(map.get(), nullptr, 0, 0, 1, 1, nullptr));
    expect_ok(echinus_map_sweep_triangles(map.get(), nullptr, 0, nullptr, 0, 0, 1, nullptr));
    expect_ok(echinus_map_faces_within(map.get(), nullptr, 0, 0, nullptr, 0, 1, 1, out(offsets), out(faces)));
    EXPECT_EQ(values_of<std::uint32_t>(offsets).size(), 1U);
    EXPECT_EQ(values_of<std::uint32_t>(faces).size(), 0U);
    expect_ok(echinus_collider_contains(&collider, nullptr, 0, 0, 1, nullptr));
    expect_ok(echinus_collider_contacts(&collider, nullptr, 0, 0, 0, 1, nullptr));
}

TEST(CArguments, StridesAreWholeFloatsAndWideEnough) {
    const CMap map = c_map(c_torus());
    const std::array<float, 64> floats{};
    std::array<std::uint8_t, 4> inside{};
    const auto ask = [&](const float* first, std::size_t count, std::size_t stride) {
        return echinus_map_contains(map.get(), first, count, stride, 1, inside.data());
    };
    expect_ok(ask(floats.data(), 4, 16));
    const auto* shifted = reinterpret_cast<const float*>(reinterpret_cast<const char*>(floats.data()) + 2);
    expect_refused(ask(shifted, 4, 0), ECHINUS_INVALID_ARGUMENT,
                   "the address of points is not a multiple of 4");
}

TEST(CArguments, ArraysAreNoLargerThanMemory) {
    constexpr std::size_t kMany = std::size_t{1} << 60;
    const echinus_distance_constraint constraint{};
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    arrays.constraints = &constraint;
    arrays.constraint_count = kMany;
    CDeformable deformable;
    expect_refused(echinus_deformable_create(&arrays, out(deformable)), ECHINUS_INVALID_ARGUMENT,
                   "the count of constraints, 1152921504606846976, is more than memory can hold");
}

TEST(CArguments, MapsHaveTheKindThatAQueryNeeds) {
    const CMesh mesh = c_torus();
    const CMap distance = c_distance_map(mesh);
    const float points[9] = {};
    echinus_sweep_hit hit;
    expect_refused(echinus_map_sweep(distance.get(), points, 0, points, 0, 1, 1, &hit),
                   ECHINUS_INVALID_ARGUMENT, "map is not an exact map");
    const CMap exact = c_map(mesh);
    echinus_distance_map_statistics statistics{};
    statistics.size = sizeof statistics;
    expect_refused(echinus_map_distance_statistics(exact.get(), &statistics), ECHINUS_INVALID_ARGUMENT,
                   "map is not a distance map");
}

} // namespace

using namespace echinus;

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

TEST(CStructs, OfAnOlderHeaderAreReadAndFilledNoFartherThanTheyKnow) {
    const CMesh mesh = c_torus();
    echinus_repair_options options;
    echinus_repair_options_init(&options, sizeof options);
    options.size = offsetof(echinus_repair_options, close_seams);
    options.close_seams = 7; // beyond the size
    CMesh repaired;
    expect_ok(echinus_mesh_repair(mesh.get(), &options, out(repaired), nullptr, nullptr));

    const float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::uint32_t corners[4] = {0, 1, 2, 3};
    CTetrahedra corner;
    expect_ok(echinus_tetrahedra_create(positions, 4, 0, corners, 1, out(corner)));
    CDeformable body;
    expect_ok(echinus_deformable_soft_body(corner.get(), nullptr, out(body)));
    echinus_deformable_arrays arrays{};
    arrays.size = offsetof(echinus_deformable_arrays, tetrahedra);
    expect_ok(echinus_deformable_read(body.get(), &arrays));
    EXPECT_EQ(arrays.particle_count, 4U);
    EXPECT_EQ(arrays.tetrahedron_count, 0U);
    arrays.size = sizeof arrays;
    expect_ok(echinus_deformable_read(body.get(), &arrays));
    EXPECT_EQ(arrays.tetrahedron_count, 1U);
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

} // namespace

namespace {

const std::array<double, 3> kPlace{448262, 5411932, 112};

/// A box of 1 x 0.9 x 0.8 around the place.
CMesh far_box() {
    const TriangleMesh box = make_box({1, 0.9, 0.8});
    std::vector<double> vertices;
    for (const Vec3f& vertex : box.vertices)
        vertices.insert(vertices.end(), {vertex.x + kPlace[0], vertex.y + kPlace[1], vertex.z + kPlace[2]});
    CMesh mesh;
    expect_ok(echinus_mesh_create_double(vertices.data(), box.vertices.size(), box.faces[0].data(),
                                         box.faces.size(), out(mesh)));
    return mesh;
}

} // namespace

TEST(CFarAway, MeshesAndMapsHaveAnOrigin) {
    const CMesh mesh = far_box();
    const double* origin = echinus_mesh_origin(mesh.get());
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(origin[axis], kPlace[axis]);
    echinus_mesh_report report{};
    report.size = sizeof report;
    expect_ok(echinus_mesh_inspect(mesh.get(), &report));
    EXPECT_NEAR(report.signed_volume, 0.72, 1e-6);
    EXPECT_EQ(report.rounding_step, 0);

    const CMap map = c_map(mesh);
    echinus_map_info info{};
    info.size = sizeof info;
    expect_ok(echinus_map_describe(map.get(), &info));
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(info.origin[axis], kPlace[axis]);

    const std::array<double, 6> points{448262, 5411932.44, 112, 448262, 5411932.46, 112};
    std::array<float, 6> local{};
    expect_ok(echinus_to_local(points.data(), 2, info.origin, local.data()));
    std::array<float, 2> distances{};
    expect_ok(echinus_map_signed_distance(map.get(), local.data(), 2, 0, 1, distances.data(), nullptr));
    EXPECT_NEAR(distances[0], -0.01, 3e-6);
    EXPECT_NEAR(distances[1], 0.01, 3e-6);

    echinus_tetrahedralize_options options;
    echinus_tetrahedralize_options_init(&options, sizeof options);
    options.lattice_size = 0.3;
    CTetrahedra body;
    expect_ok(echinus_tetrahedralize(map.get(), &options, out(body), nullptr));
    EXPECT_EQ(echinus_tetrahedra_origin(body.get())[1], kPlace[1]);
}

TEST(CFarAway, CallersWithTheStructsOfBeforeGetWhatTheyKnow) {
    const CMesh mesh = far_box();
    echinus_mesh_report report{};
    report.size = offsetof(echinus_mesh_report, rounding_step);
    report.rounding_step = -1;
    expect_ok(echinus_mesh_inspect(mesh.get(), &report));
    EXPECT_NEAR(report.signed_volume, 0.72, 1e-6);
    EXPECT_EQ(report.rounding_step, -1);
    echinus_map_info info{};
    info.size = offsetof(echinus_map_info, origin);
    info.origin[0] = -1;
    expect_ok(echinus_map_describe(c_map(mesh).get(), &info));
    EXPECT_EQ(info.face_count, 12U);
    EXPECT_EQ(info.origin[0], -1);
}
