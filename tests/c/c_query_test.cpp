// The answers of C are those of C++ bit for bit, for every kind of map, stride and count.

#include "handles.hpp"
#include "support/random_points.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>
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
    expect_ok(
        echinus_map_classify(map.get(), &points.data()->x, points.size(), 0, inside.data(), certain.data()));
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
    expect_ok(echinus_map_classify(distance.get(), &points.data()->x, points.size(), 0, inside.data(),
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
    expect_ok(echinus_map_sweep(map.get(), floats.data(), 20, &to.data()->x, 0, from.size(), hits.data()));
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
    expect_ok(echinus_map_intersects(map.get(), first, kCount, 36, meets.data()));
    expect_ok(echinus_map_clearance(map.get(), first, kCount, 0, 0.5F, clearances.data()));
    expect_ok(echinus_map_sweep_triangles(map.get(), first, 0, &to.front()[0].x, 36, kCount, hits.data()));
    for (std::size_t i = 0; i < kCount; ++i) {
        ASSERT_EQ(meets[i] != 0, intersects(by_cpp.view(), from[i])) << i;
        const Clearance clear = clearance(by_cpp.view(), from[i], 0.5F);
        ASSERT_EQ(std::memcmp(&clearances[i], &clear, sizeof clear), 0) << i;
        const TriangleSweepHit hit = sweep(by_cpp.view(), from[i], to[i]);
        ASSERT_EQ(std::memcmp(&hits[i], &hit, sizeof hit), 0) << i;
    }
    expect_refused(echinus_map_intersects(map.get(), first, kCount, 12, meets.data()),
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
    expect_refused(ask(20), ECHINUS_INVALID_ARGUMENT, "names vertex");
    EXPECT_EQ(offsets, nullptr);
}

} // namespace
