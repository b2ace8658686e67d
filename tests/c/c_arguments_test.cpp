#include "handles.hpp"

#include <echinus/version.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

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
    const auto* shifted = reinterpret_cast<const float*>(reinterpret_cast<const char*>(floats.data()) + 2);
    expect_refused(ask(shifted, 4, 0), ECHINUS_INVALID_ARGUMENT,
                   "the address of points is not a multiple of 4");
}

TEST(CArguments, ArraysAreNoLargerThanMemory) {
    constexpr std::size_t kMany = std::size_t{1} << 60;
    const echinus_stick stick{};
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    arrays.sticks = &stick;
    arrays.stick_count = kMany;
    CDeformable deformable;
    expect_refused(echinus_deformable_create(&arrays, out(deformable)), ECHINUS_INVALID_ARGUMENT,
                   "the count of sticks, 1152921504606846976, is more than memory can hold");
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
