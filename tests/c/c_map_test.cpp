#include "handles.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/map_file.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

using namespace echinus;
using namespace echinus::test;

namespace {

class CMapFile : public TemporaryFolderTest {};

std::vector<std::byte> bytes_of(const CMap& map) {
    CArray bytes;
    expect_ok(echinus_map_serialise(map.get(), out(bytes)));
    const std::span<const std::byte> values = values_of<std::byte>(bytes);
    return {values.begin(), values.end()};
}

/// A copy at an address that is a multiple of 8.
std::vector<double> aligned(std::span<const std::byte> bytes) {
    std::vector<double> result((bytes.size() + 7) / 8);
    std::memcpy(result.data(), bytes.data(), bytes.size());
    return result;
}

/// Counts the calls of a release function.
struct Counter {
    int count = 0;
    static void add(void* context) { ++static_cast<Counter*>(context)->count; }
};

TEST(CMaps, HaveTheBytesOfCpp) {
    const CMesh mesh = c_torus();
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    EXPECT_EQ(bytes_of(c_map(mesh)), serialise(ExactMap::build(torus)));
    EXPECT_EQ(bytes_of(c_distance_map(mesh)), serialise(DistanceMap::build(torus)));

    echinus_exact_map_options exact;
    echinus_exact_map_options_init(&exact, sizeof exact);
    exact.divisions = 9;
    exact.rule = ECHINUS_INSIDE_PARITY;
    exact.thread_count = 1;
    CMap map;
    expect_ok(echinus_map_build_exact(mesh.get(), &exact, out(map)));
    EXPECT_EQ(bytes_of(map), serialise(ExactMap::build(torus, {.divisions = 9, .rule = InsideRule::Parity})));
    exact.divisions = 0;
    exact.byte_budget = 300'000;
    exact.centre = ECHINUS_CENTRE_SEARCH;
    expect_ok(echinus_map_build_exact(mesh.get(), &exact, out(map)));
    EXPECT_EQ(bytes_of(map), serialise(ExactMap::build(torus, {.byte_budget = 300'000,
                                                               .rule = InsideRule::Parity,
                                                               .centre = CentreChoice::Search})));

    echinus_distance_map_options distance;
    echinus_distance_map_options_init(&distance, sizeof distance);
    distance.grid = ECHINUS_GRID_CUBE;
    distance.divisions = 20;
    distance.correction = ECHINUS_CORRECTION_PAPER;
    distance.entry_format = ECHINUS_ENTRY_UNORM16;
    expect_ok(echinus_map_build_distance(mesh.get(), &distance, out(map)));
    EXPECT_EQ(bytes_of(map), serialise(DistanceMap::build(torus, {.grid = DirectionGrid::Cube,
                                                                  .divisions = 20,
                                                                  .correction = VertexCorrection::Paper,
                                                                  .entry_format = EntryFormat::Unorm16})));
    distance.grid = ECHINUS_GRID_SPHERICAL;
    distance.longitude_count = 30;
    distance.colatitude_count = 20;
    distance.pole_axis = ECHINUS_POLE_X;
    expect_ok(echinus_map_build_distance(mesh.get(), &distance, out(map)));
    EXPECT_EQ(bytes_of(map), serialise(DistanceMap::build(torus, {.longitude_count = 30,
                                                                  .colatitude_count = 20,
                                                                  .correction = VertexCorrection::Paper,
                                                                  .entry_format = EntryFormat::Unorm16,
                                                                  .pole_axis = PoleAxis::X})));
}

TEST(CMaps, AreDescribedAsInCpp) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    const ExactMap exact = ExactMap::build(torus);
    const CMesh mesh = c_torus();
    const CMap map = c_map(mesh);
    echinus_map_info info{};
    info.size = sizeof info;
    expect_ok(echinus_map_describe(map.get(), &info));
    EXPECT_EQ(info.kind, ECHINUS_MAP_EXACT);
    EXPECT_EQ(info.radius, exact.view().radius);
    EXPECT_EQ(info.centre[1], exact.view().centre.y);
    EXPECT_EQ(info.byte_count, exact.view().byte_count());
    EXPECT_EQ(info.source_hash, exact.source_hash());
    EXPECT_EQ(info.face_count, torus.faces.size());
    echinus_exact_map_statistics statistics{};
    statistics.size = sizeof statistics;
    expect_ok(echinus_map_exact_statistics(map.get(), &statistics));
    EXPECT_EQ(statistics.face_count, exact.statistics().face_count);
    EXPECT_EQ(statistics.longest_list, exact.statistics().longest_list);
    EXPECT_EQ(statistics.mean_list, exact.statistics().mean_list);
    EXPECT_EQ(statistics.expected_tests, exact.statistics().expected_tests);
    EXPECT_EQ(statistics.certain_share, 1);

    const DistanceMap by_cpp = DistanceMap::build(torus);
    const CMap distance = c_distance_map(mesh);
    expect_ok(echinus_map_describe(distance.get(), &info));
    EXPECT_EQ(info.kind, ECHINUS_MAP_DISTANCE);
    EXPECT_EQ(info.byte_count, by_cpp.view().byte_count());
    echinus_distance_map_statistics entries{};
    entries.size = sizeof entries;
    expect_ok(echinus_map_distance_statistics(distance.get(), &entries));
    EXPECT_EQ(entries.max_entries, by_cpp.statistics().max_entries);
    EXPECT_EQ(entries.corrected_entries, by_cpp.statistics().corrected_entries);
}

TEST(CMaps, HaveTheSurfaceOfCpp) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    const ExactMap exact = ExactMap::build(torus);
    const ExactMapSurface expected = reconstruct_surface(exact.view());
    CMesh mesh;
    CArray classes;
    const CMap map = c_map(c_torus());
    expect_ok(echinus_map_surface(map.get(), out(mesh), out(classes)));
    ASSERT_EQ(echinus_mesh_vertex_count(mesh.get()), expected.mesh.vertices.size());
    EXPECT_EQ(std::memcmp(echinus_mesh_vertices(mesh.get()), expected.mesh.vertices.data(),
                          expected.mesh.vertices.size() * sizeof(Vec3f)),
              0);
    EXPECT_EQ(echinus_mesh_face_count(mesh.get()), expected.mesh.faces.size());
    EXPECT_TRUE(
        same_bits(values_of<std::uint32_t>(classes), std::span<const std::uint32_t>(expected.longest_list)));
    expect_ok(echinus_map_surface(c_distance_map(c_torus()).get(), out(mesh), nullptr));
}

TEST(CMaps, AreBuiltAgainFromOtherVertices) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    CBuilder builder;
    expect_ok(
        echinus_map_builder_create(torus.faces.data()->data(), torus.faces.size(), nullptr, out(builder)));
    CMap map;
    for (const float stretch : {1.0F, 1.5F, 2.0F}) {
        TriangleMesh moved = torus;
        for (Vec3f& vertex : moved.vertices) vertex.x *= stretch;
        expect_ok(echinus_map_builder_rebuild(builder.get(), &moved.vertices.data()->x, moved.vertices.size(),
                                              0, out(map)));
        EXPECT_EQ(bytes_of(map), serialise(ExactMap::build(moved)));
    }
    expect_refused(echinus_map_builder_rebuild(builder.get(), &torus.vertices.data()->x, 5, 0, out(map)),
                   ECHINUS_INVALID_MESH, "face");
}

TEST_F(CMapFile, IsSavedAndLoaded) {
    for (const CMap& map : {c_map(c_torus()), c_distance_map(c_torus())}) {
        expect_ok(echinus_map_save(map.get(), path("torus.ech").c_str()));
        CMap loaded;
        expect_ok(echinus_map_load(path("torus.ech").c_str(), out(loaded)));
        EXPECT_EQ(bytes_of(loaded), bytes_of(map));
        EXPECT_EQ(serialise(load_map(path("torus.ech"))), bytes_of(map));
    }
    expect_refused(echinus_map_save(c_map(c_torus()).get(), path("no/torus.ech").c_str()), ECHINUS_UNWRITABLE,
                   "no");
}

TEST(CMapViews, ReadInPlaceAndReleaseWhenTheLastUserIsGone) {
    const CMap map = c_map(c_torus());
    const std::vector<std::byte> whole = bytes_of(map);
    const std::vector<double> bytes = aligned(whole);
    Counter released;
    CMap view;
    expect_ok(echinus_map_view(bytes.data(), whole.size(), Counter::add, &released, "memory", out(view)));
    EXPECT_EQ(bytes_of(view), whole);

    CDeformable cloth;
    expect_ok(echinus_deformable_cloth(nullptr, out(cloth)));
    echinus_collider collider;
    echinus_collider_init(&collider, sizeof collider, view.get());
    CSimulation simulation;
    expect_ok(echinus_simulation_create(cloth.get(), &collider, 1, nullptr, out(simulation)));
    view.reset();
    EXPECT_EQ(released.count, 0);
    expect_ok(echinus_simulation_step(simulation.get()));
    simulation.reset();
    EXPECT_EQ(released.count, 1);
}

TEST(CMapViews, LeaveTheBytesToTheCallerWhenRefused) {
    const std::vector<std::byte> whole = bytes_of(c_map(c_torus()));
    std::vector<double> bytes = aligned(whole);
    Counter released;
    CMap view;
    expect_refused(
        echinus_map_view(bytes.data(), whole.size() - 8, Counter::add, &released, "memory", out(view)),
        ECHINUS_DAMAGED, "memory");
    const auto* shifted = reinterpret_cast<const std::byte*>(bytes.data()) + 4;
    expect_refused(echinus_map_view(shifted, 64, Counter::add, &released, "memory", out(view)),
                   ECHINUS_INVALID_ARGUMENT, "multiple of 8");
    expect_refused(echinus_map_view(nullptr, 0, Counter::add, &released, "memory", out(view)),
                   ECHINUS_WRONG_FORMAT, "memory");
    EXPECT_EQ(view, nullptr);
    EXPECT_EQ(released.count, 0);
}

} // namespace
