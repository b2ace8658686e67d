#include "exact_map/query/stretched_contact.hpp"
#include "support/instruction_sets.hpp"
#include "support/meshes.hpp"
#include "support/point_sets.hpp"
#include "support/random_points.hpp"
#include "support/samples.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

using namespace echinus;
using test::joined;
using test::translated;

namespace {

struct Case {
    std::string name;
    TriangleMesh mesh;
    ExactMapOptions options;
};

TriangleMesh without_last_faces(TriangleMesh mesh, std::size_t count) {
    mesh.faces.resize(mesh.faces.size() - count);
    return mesh;
}

/// With a hole in one direction, and certain answers in the others.
TriangleMesh without_face_towards(TriangleMesh mesh, const Vec3f& direction) {
    const auto along = [&](const Triangle& face) {
        float sum = 0;
        for (const std::uint32_t vertex : face) sum += dot(mesh.vertices[vertex], direction);
        return sum;
    };
    mesh.faces.erase(std::ranges::max_element(mesh.faces, {}, along));
    return mesh;
}

std::vector<Case> cases() {
    const TriangleMesh torus = make_torus(1, 0.4, 40, 16);
    const TriangleMesh boxes =
        joined({make_box({2, 2, 2}, 3), translated(make_box({1, 1, 3}, 2), {0.3F, 0.2F, 0.1F})});
    return {
        {"torus", torus, {}},
        {"torus, few cells", torus, {.divisions = 1}},
        {"torus, many cells", torus, {.divisions = 61}},
        {"torus far away", translated(torus, {3e4F, -2e4F, 1e4F}), {}},
        {"overlapping boxes", boxes, {}},
        {"overlapping boxes by parity", boxes, {.rule = InsideRule::Parity}},
        {"a box inside out", test::turned_inside_out(make_box({1, 2, 3}, 2)), {}},
        {"an open sphere", without_last_faces(make_sphere(1, 24, 12), 60), {}},
        {"an open sphere in eight cells",
         without_face_towards(make_sphere(1, 16, 8), {-1, -1, -1}),
         {.divisions = 1}},
        {"a plate", make_box({1, 1, 1e-4F}, 4), {}},
        {"twelve faces", make_box({1, 1, 1}), {.divisions = 3}},
        // Faces with tips so sharp that rounding matters beyond them.
        {"a rod", make_box({1, 2e-3F, 1e-3F}), {}},
        {"spokes", make_sphere(1, 700, 3), {}},
    };
}

/// All over the lattice and beyond it; on the surface, on its vertices, and a rounding error away from them;
/// on walls of cells; and not finite.
std::vector<Vec3f> telling_points(const ExactMapView& map, const TriangleMesh& mesh) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    test::Random random(1);
    std::vector<Vec3f> points = test::surface_points(mesh, 1000);
    for (const Vec3f& p : test::surface_points(mesh, 500, 0)) points.push_back(p);
    for (const Vec3f& p : test::surface_points(mesh, 500, 1e-6)) points.push_back(p);
    for (int n = 0; n < 1000; ++n) points.push_back(map.centre + test::in_cube(random, 1.3F * map.radius));
    for (int n = 0; n < 300; ++n) points.push_back(map.centre + test::in_cube(random, 1e-5F * map.radius));
    for (int n = 0; n < 300; ++n) points.push_back(map.centre + test::in_cube(random, 5 * map.radius));
    for (float far = 4; far < 1e15F; far *= 8)
        for (int n = 0; n < 20; ++n)
            points.push_back(map.centre + test::unit_vector(random) * (far * map.radius));
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 7)
        points.push_back(mesh.vertices[i] + test::in_cube(random, 0.01F * map.radius));
    for (const Vec3f& vertex : mesh.vertices) points.push_back(vertex);
    for (int x = -8; x <= 8; ++x)
        for (int y = -8; y <= 8; ++y)
            for (int z = -8; z <= 8; z += 4)
                points.push_back(map.centre + Vec3f{float(x), float(y), float(z)} * (map.radius / 8));
    points = test::sampled(points);
    for (const float far : {1e10F, 3e38F, -3e38F, kInfinity, -kInfinity, kNan})
        for (const Vec3f& p :
             {Vec3f{far, 0, 0}, Vec3f{0, far, 0}, Vec3f{0.1F, 0.2F, far}, Vec3f{far, far, far}})
            points.push_back(p);
    points.push_back(map.centre);
    return points;
}

/// NaN is itself, and 0 is not -0.
bool same_bits(float a, float b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}
bool same_bits(const Vec3f& a, const Vec3f& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
bool same_bits(const Contact& a, const Contact& b) {
    return same_bits(a.point, b.point) && same_bits(a.normal, b.normal) && a.depth == b.depth &&
           a.face == b.face && a.inside == b.inside && a.certain == b.certain && a.feature == b.feature;
}

void expect_same_sides(const ExactMapView& map, StridedSpan<const Vec3f> points, unsigned thread_count) {
    std::vector<std::uint8_t> inside(points.size(), 7);
    contains_batch(map, points, inside, thread_count);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < inside.size(); ++i) { // classify() is the reference
        const bool expected = classify(map, points[i]).inside;
        if ((inside[i] != (expected ? 1 : 0) || contains(map, points[i]) != expected) && ++wrong <= 3)
            ADD_FAILURE() << "point " << i << " of " << inside.size() << ": " << points[i].x << " "
                          << points[i].y << " " << points[i].z;
    }
    EXPECT_EQ(wrong, 0U);
}

std::vector<Contact> one_by_one(const ExactMapView& map, StridedSpan<const Vec3f> points, float margin,
                                const Vec3d& stretch) {
    std::vector<Contact> contacts;
    for (std::size_t i = 0; i < points.size(); ++i)
        contacts.push_back(stretched_contact(map, points[i], margin, stretch));
    return contacts;
}

std::vector<Contact> by_reference(const ExactMapView& map, StridedSpan<const Vec3f> points, float margin,
                                  const Vec3d& stretch) {
    return test::under_instruction_set("scalar", [&] { return one_by_one(map, points, margin, stretch); });
}

void expect_same_contacts(const std::vector<Contact>& expected, const std::vector<Contact>& contacts,
                          StridedSpan<const Vec3f> points) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < contacts.size(); ++i)
        if (!same_bits(contacts[i], expected[i]) && ++wrong <= 3)
            ADD_FAILURE() << "point " << i << ": " << points[i].x << " " << points[i].y << " " << points[i].z
                          << ", face " << contacts[i].face << " and not " << expected[i].face << ", depth "
                          << contacts[i].depth << " and not " << expected[i].depth;
    EXPECT_EQ(wrong, 0U);
}

void expect_same_contacts(const std::vector<Contact>& expected, const ExactMapView& map,
                          StridedSpan<const Vec3f> points, float margin, const Vec3d& stretch,
                          unsigned thread_count) {
    std::vector<Contact> contacts(points.size());
    stretched_contacts_batch(map, points, margin, contacts, stretch, thread_count);
    expect_same_contacts(expected, contacts, points);
}

void expect_same_contacts(const ExactMapView& map, StridedSpan<const Vec3f> points, float margin,
                          const Vec3d& stretch, unsigned thread_count) {
    expect_same_contacts(by_reference(map, points, margin, stretch), map, points, margin, stretch,
                         thread_count);
}

struct SignedDistances {
    std::vector<float> distances;
    std::vector<Vec3f> gradients;
};

SignedDistances signed_distances_one_by_one(const ExactMapView& map, StridedSpan<const Vec3f> points) {
    SignedDistances result{std::vector<float>(points.size()), std::vector<Vec3f>(points.size())};
    for (std::size_t i = 0; i < points.size(); ++i)
        result.distances[i] = signed_distance(map, points[i], &result.gradients[i]);
    return result;
}

SignedDistances signed_distances_by_reference(const ExactMapView& map, StridedSpan<const Vec3f> points) {
    return test::under_instruction_set("scalar", [&] { return signed_distances_one_by_one(map, points); });
}

void expect_same_signed_distances(const SignedDistances& expected, const ExactMapView& map,
                                  StridedSpan<const Vec3f> points, unsigned thread_count) {
    std::vector<float> distances(points.size(), 7), alone(points.size(), 7);
    std::vector<Vec3f> gradients(points.size(), {7, 7, 7});
    signed_distance_batch(map, points, distances, gradients, thread_count);
    signed_distance_batch(map, points, alone, {}, thread_count);
    const SignedDistances singly = signed_distances_one_by_one(map, points);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if ((!same_bits(distances[i], expected.distances[i]) || !same_bits(alone[i], distances[i]) ||
             !same_bits(gradients[i], expected.gradients[i]) ||
             !same_bits(singly.distances[i], expected.distances[i]) ||
             !same_bits(singly.gradients[i], expected.gradients[i])) &&
            ++wrong <= 3)
            ADD_FAILURE() << "point " << i << ": " << points[i].x << " " << points[i].y << " " << points[i].z
                          << ", distance " << distances[i] << ", " << alone[i] << " alone, "
                          << singly.distances[i] << " by a call of its own, and not "
                          << expected.distances[i];
    EXPECT_EQ(wrong, 0U);
}

} // namespace

TEST(ExactMapBatch, AgreesWithContainsUnderEveryInstructionSet) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const ExactMap map = ExactMap::build(c.mesh, c.options);
        const std::vector<Vec3f> points = telling_points(map, c.mesh);
        test::under_each_instruction_set([&](std::string_view name) {
            SCOPED_TRACE(std::string(name));
            expect_same_sides(map, points, 1);
        });
    }
}

TEST(ExactMapBatch, AgreesWithContactUnderEveryInstructionSet) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const ExactMap map = ExactMap::build(c.mesh, c.options);
        const std::vector<Vec3f> points = telling_points(map, c.mesh);
        const float radius = map.view().radius;
        const std::pair<float, Vec3d> askings[] = {{0, {1, 1, 1}},
                                                   {0.05F * radius, {1, 1, 1}},
                                                   {0.05F * radius, {2, -1, 0.5}},
                                                   {4.5F * radius, {1, 0.7, 0.3}}};
        for (const auto& [margin, stretch] : askings) {
            const std::vector<Contact> expected = by_reference(map, points, margin, stretch);
            test::under_each_instruction_set([&, margin = margin, stretch = stretch](std::string_view name) {
                SCOPED_TRACE(std::string(name));
                expect_same_contacts(expected, map, points, margin, stretch, 1);
                expect_same_contacts(expected, one_by_one(map, points, margin, stretch), points);
            });
        }
    }
}

TEST(ExactMapBatch, AgreesWithSignedDistanceUnderEveryInstructionSet) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const ExactMap map = ExactMap::build(c.mesh, c.options);
        const std::vector<Vec3f> points = telling_points(map, c.mesh);
        const SignedDistances expected = signed_distances_by_reference(map, points);
        test::under_each_instruction_set([&](std::string_view name) {
            SCOPED_TRACE(std::string(name));
            expect_same_signed_distances(expected, map, points, 1);
        });
    }
}

TEST(ExactMapBatch, TakesAnyNumberOfPointsAtAnyStride) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    const ExactMap map = ExactMap::build(mesh);
    struct Particle {
        Vec3f position;
        float mass;
    };
    const std::vector<Vec3f> points = test::surface_points(mesh, 600);
    std::vector<Particle> particles;
    for (const Vec3f& point : points) particles.push_back({point, 1});
    test::under_each_instruction_set([&](std::string_view name) {
        SCOPED_TRACE(std::string(name));
        for (std::size_t count :
             {0, 1, 2, 15, 16, 17, 31, 32, 33, 47, 48, 63, 64, 65, 100, 255, 256, 257, 511, 512, 513, 600}) {
            expect_same_sides(map, {points.data(), count}, 1);
            const StridedSpan<const Vec3f> strided(&particles[0].position, count, sizeof(Particle));
            expect_same_sides(map, strided, 1);
            expect_same_contacts(map, strided, 0.01F, {1, 1, 1}, 1);
            expect_same_signed_distances(signed_distances_by_reference(map, strided), map, strided, 1);
        }
    });
}

TEST(ExactMapBatch, GivesTheSameAnswersOnAnyNumberOfThreads) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    const ExactMap map = ExactMap::build(mesh);
    const std::vector<Vec3f> points = test::surface_points(mesh, 30'000);
    const SignedDistances expected = signed_distances_by_reference(map, points);
    for (unsigned thread_count : {0U, 2U, 3U}) {
        expect_same_sides(map, points, thread_count);
        expect_same_contacts(map, points, 0, {1, 1, 1}, thread_count);
        expect_same_signed_distances(expected, map, points, thread_count);
    }
}

TEST(ExactMapBatch, CountsLongListsOfFacesToo) {
    // Two hundred boxes at one place: every list is longer than one prepared block.
    TriangleMesh many = make_box({1, 2, 3});
    for (int n = 0; n < 200; ++n) many = joined({many, make_box({1, 2, 3})});
    const ExactMap map = ExactMap::build(many, {.divisions = 4});
    const std::vector<Vec3f> points = telling_points(map, many);
    test::under_each_instruction_set([&](std::string_view) { expect_same_sides(map, points, 1); });
}

TEST(ExactMapBatch, AnswersWithIndicesOf32BitsToo) {
    // More than 65 536 faces; then as many vertices as well.
    for (const TriangleMesh& mesh : {make_sphere(1, 260, 130), make_sphere(1, 400, 200)}) {
        const ExactMap map = ExactMap::build(mesh, {.divisions = 20});
        ASSERT_FALSE(map.view().references.wide.empty());
        const std::vector<Vec3f> points = test::sampled(test::surface_points(mesh, 3000));
        const std::vector<Contact> expected = by_reference(map, points, 0, {1, 1, 1});
        const SignedDistances expected_distances = signed_distances_by_reference(map, points);
        test::under_each_instruction_set([&](std::string_view name) {
            SCOPED_TRACE(std::string(name));
            expect_same_sides(map, points, 1);
            expect_same_contacts(expected, map, points, 0, {1, 1, 1}, 1);
            expect_same_contacts(expected, one_by_one(map, points, 0, {1, 1, 1}), points);
            expect_same_signed_distances(expected_distances, map, points, 1);
        });
    }
}

TEST(ExactMapBatch, AgreesWithContactWhenTheWorldIsSquashed) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    const ExactMap map = ExactMap::build(mesh);
    const std::vector<Vec3f> points = test::surface_points(mesh, 300);
    for (const Vec3d& stretch : {Vec3d{1, 1e-5, 1e-3}, Vec3d{1, 1e-25, 1e-25}, Vec3d{1e-25, 1, 1e-50}}) {
        const std::vector<Contact> expected = by_reference(map, points, 0.2F, stretch);
        test::under_each_instruction_set([&](std::string_view name) {
            SCOPED_TRACE(std::string(name));
            expect_same_contacts(expected, map, points, 0.2F, stretch, 1);
            expect_same_contacts(expected, one_by_one(map, points, 0.2F, stretch), points);
        });
    }
}

TEST(ExactMapBatch, AnswersCrowdsAndStragglersAlike) {
    // Neighbours share a walk through the tree, others have one of their own.
    const TriangleMesh mesh = make_torus(1, 0.4, 100, 40);
    const ExactMap map = ExactMap::build(mesh);
    test::Random random(3);
    std::vector<Vec3f> points;
    for (int crowd = 0; crowd < 40; ++crowd) {
        const Vec3f middle = test::in_cube(random, 1.5F);
        for (int n = 0; n < 40; ++n) points.push_back(middle + test::in_cube(random, 0.01F));
        for (int n = 0; n < 10; ++n) points.push_back(test::in_cube(random, 2));
    }
    const std::vector<Contact> expected = by_reference(map, points, 0.1F, {1, 1, 1});
    const SignedDistances distances = signed_distances_by_reference(map, points);
    test::under_each_instruction_set([&](std::string_view name) {
        SCOPED_TRACE(std::string(name));
        for (const std::size_t call_size : {3U, 50U, 300U, 2000U})
            for (std::size_t begin = 0; begin < points.size(); begin += call_size) {
                const std::size_t count = std::min<std::size_t>(call_size, points.size() - begin);
                const std::vector<Contact> part(&expected[begin], &expected[begin] + count);
                expect_same_contacts(part, map, {&points[begin], count}, 0.1F, {1, 1, 1}, 1);
            }
        expect_same_signed_distances(distances, map, points, 1);
    });
}

TEST(ExactMapBatch, AnswersWhereAllFacesAreAboutEquallyNear) {
    for (const TriangleMesh& mesh : {make_sphere(1, 80, 40), make_sphere(1, 5, 3)}) {
        const ExactMap map = ExactMap::build(mesh);
        test::Random random(4);
        std::vector<Vec3f> points{map.view().centre, {0, 0, 0}};
        for (const float reach : {1e-6F, 1e-3F, 0.1F})
            for (int n = 0; n < 40; ++n) points.push_back(test::in_cube(random, reach));
        const std::vector<Contact> expected = by_reference(map, points, 0, {1, 1, 1});
        test::under_each_instruction_set([&](std::string_view name) {
            SCOPED_TRACE(std::string(name));
            expect_same_contacts(expected, map, points, 0, {1, 1, 1}, 1);
            expect_same_contacts(expected, one_by_one(map, points, 0, {1, 1, 1}), points);
        });
    }
}
