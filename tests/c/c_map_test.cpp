#include "handles.hpp"
#include "support/random_points.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/map_file.hpp>
#include <echinus/mesh.hpp>
#include <echinus/surface_queries.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

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
        expect_ok(echinus_map_save(map.get(), path("torus.ech").string().c_str()));
        CMap loaded;
        expect_ok(echinus_map_load(path("torus.ech").string().c_str(), out(loaded)));
        EXPECT_EQ(bytes_of(loaded), bytes_of(map));
        EXPECT_EQ(serialise(load_map(path("torus.ech"))), bytes_of(map));
    }
    expect_refused(echinus_map_save(c_map(c_torus()).get(), path("no/torus.ech").string().c_str()),
                   ECHINUS_UNWRITABLE, "no");
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
    echinus_simulation_options options;
    echinus_simulation_options_init(&options, sizeof options);
    options.solver = ECHINUS_SOLVER_JAKOBSEN;
    expect_ok(echinus_simulation_create(cloth.get(), &collider, 1, &options, out(simulation)));
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

// The answers of C are those of C++ bit for bit, for every kind of map, stride and count.

namespace {

/// A torus with a hole, so that some answers are not certain.
TriangleMesh open_torus() {
    TriangleMesh mesh = make_torus(1.0, 0.4, 60, 24);
    mesh.faces.resize(mesh.faces.size() - 200);
    return mesh;
}

std::vector<Vec3f> points_everywhere(std::size_t count) {
    Random random(3);
    std::vector<Vec3f> points;
    while (points.size() < count) points.push_back(in_cube(random, 1.6F));
    for (std::size_t i = 10; i + 1 < count; i += 97) points[i].y = i % 2 == 0 ? kNan : kInfinity;
    return points;
}

/// Points within vertex structs of `stride` bytes.
std::vector<float> spread(std::span<const Vec3f> points, std::size_t stride) {
    const std::size_t width = stride / sizeof(float);
    std::vector<float> result(points.size() * width, -7);
    for (std::size_t i = 0; i < points.size(); ++i)
        std::memcpy(&result[i * width], &points[i], sizeof(Vec3f));
    return result;
}

/// Every member but the padding.
bool same_answer(const echinus_contact& a, const Contact& b) {
    return std::memcmp(&a, &b, offsetof(echinus_contact, feature) + 1) == 0;
}
bool same_answer(const echinus_sweep_hit& a, const SweepHit& b) {
    return std::memcmp(&a, &b, offsetof(echinus_sweep_hit, entering) + 1) == 0;
}

template <typename Map>
void expect_answers_of_cpp(const echinus_map* map, const Map& by_cpp) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{3000}}) {
        const std::vector<Vec3f> points = points_everywhere(count);
        std::vector<std::uint8_t> expected_inside(count);
        contains_batch(by_cpp.view(), points, expected_inside);
        std::vector<Contact> expected(count);
        contacts_batch(by_cpp.view(), points, 0.1F, expected);

        for (const std::size_t stride : {std::size_t{0}, std::size_t{12}, std::size_t{16}, std::size_t{40}}) {
            const std::vector<float> floats = spread(points, stride == 0 ? 12 : stride);
            std::vector<std::uint8_t> inside(count, 9);
            expect_ok(echinus_map_contains(map, floats.data(), count, stride, 1, inside.data()));
            EXPECT_EQ(inside, expected_inside);
            std::vector<echinus_contact> contacts(count);
            expect_ok(echinus_map_contacts(map, floats.data(), count, stride, 0.1F, 0, contacts.data()));
            for (std::size_t i = 0; i < count; ++i) ASSERT_TRUE(same_answer(contacts[i], expected[i])) << i;
        }
    }
}

TEST(CQueries, OfAnExactMapAreThoseOfCpp) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    expect_answers_of_cpp(c_map(c_mesh_of(torus)).get(), ExactMap::build(torus));
}

TEST(CQueries, OfADistanceMapAreThoseOfCpp) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    expect_answers_of_cpp(c_distance_map(c_mesh_of(torus)).get(), DistanceMap::build(torus));
}

TEST(CQueries, SayWhereTheyAreCertain) {
    const ExactMap by_cpp = ExactMap::build(open_torus());
    const CMap map = c_map(c_mesh_of(open_torus()));
    const std::vector<Vec3f> points = points_everywhere(3000);
    std::vector<std::uint8_t> inside(points.size()), certain(points.size());
    expect_ok(echinus_map_classify(map.get(), &points.data()->x, points.size(), 0, 1, inside.data(),
                                   certain.data()));
    std::size_t uncertain_count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Containment expected = classify(by_cpp.view(), points[i]);
        ASSERT_EQ(inside[i] != 0, expected.inside) << i;
        ASSERT_EQ(certain[i] != 0, expected.certain) << i;
        uncertain_count += certain[i] == 0 ? 1 : 0;
    }
    EXPECT_GT(uncertain_count, 0U);

    const CMap distance = c_distance_map(c_torus());
    const DistanceMap distance_by_cpp = DistanceMap::build(make_torus(1.0, 0.4, 60, 24));
    expect_ok(echinus_map_classify(distance.get(), &points.data()->x, points.size(), 0, 1, inside.data(),
                                   certain.data()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(inside[i] != 0, contains(distance_by_cpp.view(), points[i])) << i;
        ASSERT_EQ(certain[i], 1) << i;
    }
}

TEST(CQueries, MeasureSignedDistancesAsInCpp) {
    const ExactMap by_cpp = ExactMap::build(open_torus());
    const CMap map = c_map(c_mesh_of(open_torus()));
    const std::vector<Vec3f> points = points_everywhere(2000);
    std::vector<float> expected(points.size()), distances(points.size(), -7);
    std::vector<Vec3f> expected_gradients(points.size()), gradients(points.size());
    signed_distance_batch(by_cpp.view(), points, expected, expected_gradients);
    for (const std::size_t stride : {std::size_t{0}, std::size_t{24}}) {
        const std::vector<float> floats = spread(points, stride == 0 ? 12 : stride);
        expect_ok(echinus_map_signed_distance(map.get(), floats.data(), points.size(), stride, 1,
                                              distances.data(), &gradients.data()->x));
        EXPECT_TRUE(same_bits(std::span<const float>(distances), std::span<const float>(expected)));
        EXPECT_TRUE(same_bits(std::span<const Vec3f>(gradients), std::span<const Vec3f>(expected_gradients)));
        std::ranges::fill(distances, -7.0F);
        expect_ok(echinus_map_signed_distance(map.get(), floats.data(), points.size(), stride, 0,
                                              distances.data(), nullptr));
        EXPECT_TRUE(same_bits(std::span<const float>(distances), std::span<const float>(expected)));
    }
    expect_refused(echinus_map_signed_distance(c_distance_map(c_torus()).get(), &points.data()->x, 5, 0, 1,
                                               distances.data(), nullptr),
                   ECHINUS_INVALID_ARGUMENT, "map is not an exact map");
}

TEST(CQueries, TellWindingNumbersAsInCpp) {
    const ExactMap by_cpp = ExactMap::build(open_torus());
    const CMap map = c_map(c_mesh_of(open_torus()));
    const std::vector<Vec3f> points = points_everywhere(2000);
    std::vector<float> expected(points.size()), found(points.size(), -7);
    for (const float tolerance : {0.0F, 0.1F}) {
        winding_number_batch(by_cpp.view(), points, expected, tolerance);
        expect_ok(echinus_map_winding_number(map.get(), &points.data()->x, points.size(), 0, tolerance, 0,
                                             found.data()));
        EXPECT_TRUE(same_bits(std::span<const float>(found), std::span<const float>(expected)));
    }
    expect_refused(echinus_map_winding_number(map.get(), &points.data()->x, 5, 0, -1, 1, found.data()),
                   ECHINUS_INVALID_ARGUMENT, "tolerance");
    expect_refused(echinus_map_winding_number(c_distance_map(c_torus()).get(), &points.data()->x, 5, 0, 0, 1,
                                              found.data()),
                   ECHINUS_INVALID_ARGUMENT, "map is not an exact map");
}

TEST(CQueries, SweepAsInCpp) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    const ExactMap by_cpp = ExactMap::build(torus);
    const CMap map = c_map(c_mesh_of(torus));
    const std::vector<Vec3f> points = points_everywhere(2000);
    const std::span<const Vec3f> from = std::span(points).first(1000), to = std::span(points).last(1000);
    const std::vector<float> floats = spread(from, 20);
    std::vector<echinus_sweep_hit> hits(from.size());
    expect_ok(echinus_map_sweep(map.get(), floats.data(), 20, &to.data()->x, 0, from.size(), 1, hits.data()));
    std::size_t hit_count = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const SweepHit expected = sweep(by_cpp.view(), from[i], to[i]);
        ASSERT_TRUE(same_answer(hits[i], expected)) << i;
        hit_count += expected.found() ? 1 : 0;
    }
    EXPECT_GT(hit_count, 100U);
}

TEST(CQueries, OfTrianglesAreThoseOfCpp) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    const ExactMap by_cpp = ExactMap::build(torus);
    const CMap map = c_map(c_mesh_of(torus));
    constexpr std::size_t kCount = 300;
    Random random(5);
    std::vector<TrianglePoints> from, to;
    for (std::size_t i = 0; i < kCount; ++i) {
        const Vec3f place = in_cube(random, 1.5F), way = in_cube(random, 1);
        TrianglePoints triangle;
        for (Vec3f& corner : triangle) corner = place + in_cube(random, 0.1F);
        from.push_back(triangle);
        for (Vec3f& corner : triangle) corner += way;
        to.push_back(triangle);
    }
    from[7][1].x = kNan;

    std::vector<std::uint8_t> meets(kCount);
    std::vector<echinus_clearance> clearances(kCount);
    std::vector<echinus_triangle_sweep_hit> hits(kCount);
    const float* first = &from.front()[0].x;
    expect_ok(echinus_map_intersects(map.get(), first, kCount, 36, 1, meets.data()));
    expect_ok(echinus_map_clearance(map.get(), first, kCount, 0, 0.5F, 1, clearances.data()));
    expect_ok(echinus_map_sweep_triangles(map.get(), first, 0, &to.front()[0].x, 36, kCount, 1, hits.data()));
    for (std::size_t i = 0; i < kCount; ++i) {
        ASSERT_EQ(meets[i] != 0, intersects(by_cpp.view(), from[i])) << i;
        const Clearance clear = clearance(by_cpp.view(), from[i], 0.5F);
        ASSERT_EQ(std::memcmp(&clearances[i], &clear, sizeof clear), 0) << i;
        const TriangleSweepHit hit = sweep(by_cpp.view(), from[i], to[i]);
        ASSERT_EQ(std::memcmp(&hits[i], &hit, sizeof hit), 0) << i;
    }
    expect_refused(echinus_map_intersects(map.get(), first, kCount, 12, 1, meets.data()),
                   ECHINUS_INVALID_ARGUMENT, "at least 36");
}

TEST(CQueries, FindTheFacesWithinReachOfAMesh) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 60, 24);
    const ExactMap by_cpp = ExactMap::build(torus);
    const CMap map = c_map(c_mesh_of(torus));
    const TriangleMesh ball = make_sphere(0.9, 20, 10);
    FaceLists expected;
    faces_within_batch(by_cpp.view(), ball.vertices, ball.faces, 0.1F, expected);
    CArray offsets, faces;
    const auto ask = [&](std::size_t vertex_count) {
        return echinus_map_faces_within(map.get(), &ball.vertices.data()->x, vertex_count, 0,
                                        ball.faces.data()->data(), ball.faces.size(), 0.1F, 1, out(offsets),
                                        out(faces));
    };
    expect_ok(ask(ball.vertices.size()));
    EXPECT_TRUE(
        same_bits(values_of<std::uint32_t>(offsets), std::span<const std::uint32_t>(expected.offsets)));
    EXPECT_TRUE(same_bits(values_of<std::uint32_t>(faces), std::span<const std::uint32_t>(expected.faces)));
    EXPECT_GT(expected.faces.size(), 100U);
    expect_refused(ask(20), ECHINUS_INVALID_ARGUMENT, "refers to vertex");
    EXPECT_EQ(offsets, nullptr);
}

} // namespace
