#include "exact_map/layout.hpp"
#include "exact_map/query/nearest.hpp"
#include "exact_map/query/stretched_contact.hpp"
#include "support/instruction_sets.hpp"
#include "support/meshes.hpp"
#include "support/point_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace echinus;
using test::joined;
using test::translated;
using test::turned_inside_out;

namespace {

/// |x| + |y| + |z| = 2^19: its bounding radius makes the lattice step 1, so that lattice points are whole
/// numbers.
TriangleMesh lattice_octahedron() {
    TriangleMesh mesh;
    const float r = 1 << 19;
    mesh.vertices = {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
    mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return mesh;
}

} // namespace

TEST(ExactMapContains, DecidesToTheLastLatticeStep) {
    for (std::uint32_t divisions : {1U, 4U, 24U}) {
        const ExactMap map = ExactMap::build(lattice_octahedron(), {.divisions = divisions});
        ASSERT_EQ(map.view().radius, 524'288.0F);
        test::Random random(divisions);
        std::uniform_int_distribution<int> share(0, 1 << 19);
        for (int n = 0; n < 20'000; ++n) {
            // A point of the face x + y + z = 2^19, and its neighbours one step in and out.
            const int x = share(random);
            const int y = n % 3 == 0 ? 0 : n % 3 == 1 ? (1 << 19) - x : share(random) % ((1 << 19) - x + 1);
            const int z = (1 << 19) - x - y;
            const Vec3f mirror{n & 1 ? 1.0F : -1.0F, n & 2 ? 1.0F : -1.0F, n & 4 ? 1.0F : -1.0F};
            const auto at = [&](int step) {
                const int k = x >= y && x >= z ? 0 : y >= z ? 1 : 2; // move the largest coordinate
                return Vec3f{mirror.x * static_cast<float>(x + (k == 0 ? step : 0)),
                             mirror.y * static_cast<float>(y + (k == 1 ? step : 0)),
                             mirror.z * static_cast<float>(z + (k == 2 ? step : 0))};
            };
            ASSERT_TRUE(contains(map, at(-1))) << x << " " << y << " " << z;
            ASSERT_FALSE(contains(map, at(1))) << x << " " << y << " " << z;
        }
    }
}

TEST(ExactMapContains, AgreesWithTheWindingNumber) {
    const TriangleMesh sphere = make_sphere(1, 24, 12);
    const TriangleMesh small = make_sphere(0.5, 16, 8);
    const TriangleMesh box = make_box({1, 1, 1}, 2);
    const TriangleMesh meshes[] = {
        make_torus(1, 0.4, 30, 12),
        make_box({2, 1, 0.5}, 3),
        joined({sphere, small}),                               // nested
        joined({sphere, turned_inside_out(small)}),            // a cavity
        joined({box, translated(box, {0.5F, 0.25F, 0.125F})}), // overlapping
        joined({translated(box, {3, 0, 0}), translated(box, {-3, 0, 0})}),
        turned_inside_out(sphere),
        joined({box, box}),
        make_box({1, 1e-4, 1e-4}),
        test::make_two_wedges(),
        test::make_four_wedges(),
        test::make_open_mouth(),
    };
    test::Random random(1);
    for (const TriangleMesh& mesh : meshes)
        for (InsideRule rule : {InsideRule::Nonzero, InsideRule::Parity})
            for (std::uint32_t divisions : {0U, 1U, 9U}) {
                const ExactMap map = ExactMap::build(mesh, {.divisions = divisions, .rule = rule});
                for (int n = 0; n < 2000; ++n) {
                    const Vec3f p = test::in_sphere(random, 1.2F * map.view().radius);
                    const int winding = static_cast<int>(std::lround(winding_number(mesh, Vec3d(p))));
                    const bool expected = rule == InsideRule::Nonzero ? winding != 0 : winding % 2 != 0;
                    if (contains(map, p) != expected)
                        ASSERT_LT(unsigned_distance(mesh, Vec3d(p)), 4e-6 * map.view().radius);
                }
            }
}

TEST(ExactMapContains, AnswersTheSameForEveryResolution) {
    // Points on the lattice of the mesh's own coordinates: many lie on faces, edges, vertices and walls of
    // cells.
    const TriangleMesh mesh = joined({make_box({2, 2, 2}, 4), translated(make_box({2, 2, 2}, 2), {1, 1, 1})});
    const ExactMap coarse = ExactMap::build(mesh, {.divisions = 1});
    for (std::uint32_t divisions : {2U, 5U, 32U}) {
        const ExactMap fine = ExactMap::build(mesh, {.divisions = divisions});
        for (int x = -10; x <= 20; ++x)
            for (int y = -10; y <= 20; ++y)
                for (int z = -10; z <= 20; ++z) {
                    const Vec3f p = Vec3f(Vec3d(double(x), double(y), double(z)) * 0.125);
                    ASSERT_EQ(contains(coarse, p), contains(fine, p)) << x << " " << y << " " << z;
                }
    }
}

TEST(ExactMapContains, IsRightWhereTheCentreLiesOnTheSurface) {
    // Two boxes that touch at the centre of their bounding sphere: with a corner, along an edge, with a side.
    const TriangleMesh box = make_box({2, 2, 2});
    for (const Vec3f& offset : {Vec3f{1, 1, 1}, Vec3f{1, 1, 0}, Vec3f{1, 0, 0}}) {
        const TriangleMesh mesh = joined({translated(box, offset), translated(box, -offset)});
        const ExactMap map = ExactMap::build(mesh);
        test::Random random(2);
        for (int n = 0; n < 5000; ++n) {
            const Vec3f p = test::in_sphere(random, n % 2 == 0 ? 3.0F : 0.01F);
            const bool expected = std::abs(winding_number(mesh, Vec3d(p))) > 0.5;
            if (contains(map, p) != expected) ASSERT_LT(unsigned_distance(mesh, Vec3d(p)), 2e-5);
        }
    }
}

TEST(ExactMapContains, TreatsNaNAndInfinityAsOutside) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                      -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max()})
        for (const Vec3f& p : {Vec3f{bad, 0, 0}, Vec3f{0, bad, 0}, Vec3f{0, 0, bad}})
            EXPECT_FALSE(contains(map, p));
    EXPECT_TRUE(contains(map, map.view().centre));
}

TEST(ExactMapContact, IsNotCertainOfAPointWithNaN) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::vector<Vec3f> points{{kNaN, 0, 0}, {0, kNaN, 0}, {0, 0, kNaN}, {kInfinity, 0, 0}, {0, 0, 0}};
    std::vector<Contact> contacts(points.size());
    contacts_batch(map, points, 1, contacts);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(contacts[i].certain, i >= 3);
        EXPECT_EQ(contact(map, points[i], 1).certain, i >= 3);
        EXPECT_EQ(classify(map, points[i]).certain, i >= 3);
    }
}

TEST(ExactMapContact, FindsTheNearestPointOfTheWholeSurface) {
    test::Random random(1);
    for (const TriangleMesh& mesh :
         {make_torus(1, 0.4, 40, 16), make_box({2, 1, 0.25}, 3), make_sphere(1, 20, 10)}) {
        const ExactMap map = ExactMap::build(mesh);
        const float radius = map.view().radius;
        for (int n = 0; n < 2000; ++n) {
            const Vec3f p = test::in_sphere(random, radius);
            const double expected = unsigned_distance(mesh, Vec3d(p));
            const Contact c = contact(map, p, 10 * radius);
            ASSERT_TRUE(c.found());
            ASSERT_EQ(c.inside, contains(map, p));
            ASSERT_NEAR(c.depth, c.inside ? expected : -expected, 1e-5 * radius);
            ASSERT_NEAR(length(p + c.normal * c.depth - c.point), 0, 1e-5F * radius);
            ASSERT_NEAR(unsigned_distance(mesh, Vec3d(c.point)), 0, 1e-5 * radius);
            ASSERT_LT(static_cast<std::size_t>(c.face), mesh.faces.size());
        }
    }
}

TEST(ExactMapContact, IsExactAtTheCentreOfABall) {
    const ExactMap map = ExactMap::build(make_sphere(1, 100, 50));
    const Contact c = contact(map, {0, 0, 0});
    EXPECT_TRUE(c.inside);
    EXPECT_NEAR(c.depth, unsigned_distance(make_sphere(1, 100, 50), {}), 1e-5);
}

TEST(ExactMapContact, EndsAtTheMargin) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    const Vec3f p{0.25F, 0.5F, 1.1F};
    EXPECT_FALSE(contact(map, p).found());
    EXPECT_FALSE(contact(map, p, 0.0999F).found());
    const Contact c = contact(map, p, 0.1001F);
    EXPECT_TRUE(c.found());
    EXPECT_FALSE(c.inside);
    EXPECT_NEAR(c.depth, -0.1F, 1e-5F);
    EXPECT_EQ(contact(map, p, std::nanf("")).point, p);
}

TEST(ExactMapContact, HasThePseudonormalOnTheSurface) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    const auto normal = [&](const Vec3f& p) { return contact(map, p, 1e-3F).normal; };
    const float half = std::sqrt(0.5F);
    const float third = std::sqrt(1.0F / 3);
    EXPECT_NEAR(length(normal({0.3F, 0.2F, 1}) - Vec3f{0, 0, 1}), 0, 1e-4F);
    EXPECT_NEAR(length(normal({0.3F, 1, 1}) - Vec3f{0, half, half}), 0, 1e-4F);
    EXPECT_NEAR(length(normal({1, -1, 1}) - Vec3f{third, -third, third}), 0, 1e-4F);
}

TEST(ExactMapContact, FindsANeedleThatIsThinnerThanTheLattice) {
    const TriangleMesh needle = make_box({1, 1e-7, 1e-7});
    const TriangleMesh mesh = test::joined({make_box({1, 1, 1}, 2), test::translated(needle, {1.5F, 0, 0})});
    const ExactMap map = ExactMap::build(mesh);
    EXPECT_EQ(map.statistics().dropped_faces, needle.faces.size());
    for (const Vec3f& p : {Vec3f{1.5F, 0.1F, 0}, Vec3f{2.2F, 0, 0.1F}, Vec3f{1.9F, -0.01F, 0.01F}}) {
        const Contact c = contact(map, p, 1);
        EXPECT_FALSE(c.inside);
        EXPECT_NEAR(-c.depth, unsigned_distance(mesh, Vec3d(p)), 1e-5);
    }
}

TEST(ExactMapContact, HasANormalOutOfTheSolidWhicheverWayTheFacesAreTurned) {
    const ExactMap map = ExactMap::build(test::turned_inside_out(make_box({2, 2, 2})));
    for (float x : {0.9F, 0.999999F, 1.0F, 1.000001F, 1.05F})
        EXPECT_NEAR(length(contact(map, {x, 0.2F, 0.1F}, 0.1F).normal - Vec3f{1, 0, 0}), 0, 1e-4F) << x;
    const SweepHit in = sweep(map, {1.5F, 0.2F, 0.1F}, {0.5F, 0.2F, 0.1F});
    EXPECT_TRUE(in.entering);
    EXPECT_EQ(in.normal, (Vec3f{1, 0, 0}));
    const SweepHit out = sweep(map, {0.5F, 0.2F, 0.1F}, {1.5F, 0.2F, 0.1F});
    EXPECT_FALSE(out.entering);
    EXPECT_EQ(out.normal, (Vec3f{1, 0, 0}));
}

TEST(ExactMapContact, HasTheNormalOfTheNearestFaceOnAPlateWithoutThickness) {
    TriangleMesh plate{{{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}},
                       {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}}};
    const ExactMap map = ExactMap::build(plate);
    EXPECT_EQ(std::fabs(contact(map, {1e-6F, 0.1F, 0.2F}, 0.1F).normal.x), 1);
}

TEST(ExactMapContact, LeadsOutOfAWorldThatIsStretchedOutOfShape) {
    const ExactMap map = ExactMap::build(make_box({1, 1, 1}));
    const Contact c = stretched_contact(map, {0.1F, 0.2F, -0.4F}, 0, {1, 1, 1e-7});
    EXPECT_NEAR(c.point.z, -0.5F, 1e-4F);
    EXPECT_NEAR(c.normal.z, -1, 1e-4F);
}

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Vec3d> places_near_and_far() {
    test::Random random(1);
    std::vector<Vec3d> places{{0, 0, 0}};
    for (const float reach : {1e-3F, 0.5F, 1.1F, 1.5F, 3.0F, 5.0F, 1e3F, 1e12F})
        for (int n = 0; n < 10; ++n)
            places.push_back(Vec3d(test::in_cube(random, reach)) * static_cast<double>(kLatticeExtent));
    return places;
}

} // namespace

TEST(NearestFaces, OfOnePlaceDoNotDependOnTheLeafThatTheSearchBeginsWith) {
    // The last leaf has three faces only.
    TriangleMesh mesh = make_torus(1, 0.4, 25, 9);
    mesh.faces.resize(mesh.faces.size() - 7);
    const ExactMap map = ExactMap::build(mesh);
    const auto leaf_count =
        static_cast<std::uint32_t>((map.view().face_count() + TreeNode::kWidth - 1) / TreeNode::kWidth);
    ASSERT_NE(map.view().face_count() % TreeNode::kWidth, 0U);
    const Vec3d stretch{1, 1, 1};
    for (const Vec3d& place : places_near_and_far())
        for (const double farthest : {kInfinity, 0.2 * static_cast<double>(kLatticeExtent), 0.0}) {
            const std::uint32_t expected = nearest_face(map, place, stretch, farthest).value_or(kNoFace);
            test::under_each_instruction_set([&](std::string_view name) {
                for (std::uint32_t leaf = 0; leaf < leaf_count; ++leaf)
                    ASSERT_EQ(find_nearest_face(map, stretch, {place, farthest, leaf}), expected)
                        << name << ", leaf " << leaf << ", " << place.x << " " << place.y << " " << place.z;
                ASSERT_EQ(find_nearest_face(map, stretch, {place, farthest, kNoLeaf}), expected);
            });
        }
}

TEST(NearestFaces, AreFoundAroundMapsWithFewerFacesThanALeafHolds) {
    const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const ExactMap map = ExactMap::build(tetrahedron);
    for (const Vec3d& place : places_near_and_far()) {
        const std::uint32_t expected = nearest_face(map, place, {1, 1, 1}, kInfinity).value_or(kNoFace);
        test::under_each_instruction_set([&](std::string_view name) {
            EXPECT_EQ(find_nearest_face(map, {1, 1, 1}, {place, kInfinity, kNoLeaf}), expected) << name;
        });
    }
}

TEST(NearestFaces, OfPlacesNearTheSurfaceAreSoughtFromALeafNearBy) {
    const TriangleMesh mesh = make_torus(1, 0.4, 100, 40);
    const ExactMap map = ExactMap::build(mesh);
    const LatticeFrame frame = frame_of(map);
    int missed = 0;
    for (const Vec3f& p : test::surface_points(mesh, 500)) {
        const Vec3d place = frame.to_lattice(p);
        const std::uint32_t leaf = leaf_near(map, place);
        if (leaf == kNoLeaf) { // the place's ray passes the surface
            ++missed;
            continue;
        }
        double nearest = kInfinity;
        for (std::uint32_t k = 0; k < TreeNode::kWidth; ++k) {
            const auto face = static_cast<std::uint32_t>(leaf * TreeNode::kWidth + k);
            nearest = std::min(nearest, nearest_point_on_face(map, face, place, {1, 1, 1}).distance);
        }
        ASSERT_LT(nearest, 0.1 * static_cast<double>(kLatticeExtent)); // a cell is 0.03 wide
    }
    EXPECT_LT(missed, 25);
}

namespace {

/// How much the lattice and the rounding to float may change a distance.
double tolerance(const ExactMapView& map, double distance) {
    return 4e-6 * double{map.radius} + 1e-7 * std::fabs(distance);
}

/// In the bounding sphere, near the surface, and up to a million radii away.
std::vector<Vec3f> points_near_and_far(const ExactMapView& map, const TriangleMesh& mesh) {
    test::Random random(5);
    std::vector<Vec3f> points = test::surface_points(mesh, 500);
    for (int n = 0; n < 1000; ++n) points.push_back(map.centre + test::in_cube(random, 1.5F * map.radius));
    for (float far = 2; far < 1e6F; far *= 3)
        for (int n = 0; n < 40; ++n)
            points.push_back(map.centre + test::unit_vector(random) * (far * map.radius));
    return points;
}

std::vector<TriangleMesh> closed_meshes() {
    return {make_torus(1, 0.4, 40, 16), make_box({2, 1, 0.25}, 3),
            test::translated(make_sphere(1e-3, 20, 10), {0.1F, -0.2F, 0.3F}),
            test::turned_inside_out(make_box({1, 1, 1}))};
}

} // namespace

TEST(ExactMapSignedDistance, IsTheDistanceOfTheSurfaceNegativeInside) {
    for (const TriangleMesh& mesh : closed_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        for (const Vec3f& p : points_near_and_far(map, mesh)) {
            const float found = signed_distance(map, p);
            ASSERT_EQ(std::signbit(found), contains(map, p));
            const double expected = unsigned_distance(mesh, Vec3d(p));
            ASSERT_NEAR(std::fabs(found), expected, tolerance(map, expected))
                << p.x << " " << p.y << " " << p.z;
        }
    }
}

TEST(ExactMapSignedDistance, IsTheOppositeOfTheDepthOfAContact) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    const ExactMap map = ExactMap::build(mesh);
    for (const Vec3f& p : points_near_and_far(map, mesh)) {
        const Contact c = contact(map, p, std::numeric_limits<float>::infinity());
        ASSERT_TRUE(c.found());
        Vec3f gradient;
        ASSERT_EQ(signed_distance(map, p, &gradient), -c.depth);
        ASSERT_EQ(gradient, c.normal);
    }
}

TEST(ExactMapSignedDistance, ChangesNoFasterThanThePointMoves) {
    test::Random random(6);
    for (const TriangleMesh& mesh : closed_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        for (const Vec3f& p : points_near_and_far(map, mesh)) {
            const float reach = length(p - map.view().centre);
            for (const float step : {1e-6F, 1e-3F, 0.3F}) {
                const Vec3f q = p + test::unit_vector(random) * (step * reach);
                const double from = signed_distance(map, p), to = signed_distance(map, q);
                ASSERT_LE(std::fabs(from - to), length(Vec3d(p) - Vec3d(q)) + 2 * tolerance(map, from));
            }
        }
    }
}

TEST(ExactMapSignedDistance, MovesWithTheMesh) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    const ExactMap map = ExactMap::build(mesh);
    const Vec3f offset{16, -8, 32};
    const ExactMap moved = ExactMap::build(test::translated(mesh, offset));
    for (const Vec3f& p : points_near_and_far(map, mesh)) {
        const double here = signed_distance(map, p), there = signed_distance(moved, p + offset);
        const double rounding = 3e-6 + 1e-7 * double{length(p)}; // of moved vertices and points
        ASSERT_NEAR(std::fabs(here), std::fabs(there), rounding + 2 * tolerance(map, here));
    }
}

TEST(ExactMapSignedDistance, HasAUnitGradientThatLeadsFromTheNearestPoint) {
    for (const TriangleMesh& mesh : closed_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        const double radius = map.view().radius;
        for (const Vec3f& p : points_near_and_far(map, mesh)) {
            Vec3f gradient;
            const double distance = signed_distance(map, p, &gradient);
            ASSERT_NEAR(length(gradient), 1, 1e-6F);
            const Vec3d foot = Vec3d(p) - Vec3d(gradient) * distance;
            const double rounding = 1e-5 * radius + 2e-7 * std::fabs(distance);
            ASSERT_LE(unsigned_distance(mesh, foot), rounding);
            // Along it the distance grows as fast as the point moves.
            const float step = 1e-2F * map.view().radius;
            if (distance < 0 || distance > 3 * radius)
                continue; // a medial axis may lie ahead; float is coarse
            ASSERT_NEAR(signed_distance(map, p + gradient * step), distance + step, 2e-3 * step);
        }
    }
}

TEST(ExactMapSignedDistance, KeepsTheSideOnTheSurface) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    int inside_count = 0;
    for (const Vec3f& p : {Vec3f{1, 0.1F, 0.2F}, Vec3f{-1, 0.1F, 0.2F}, Vec3f{0.1F, 1, 0.2F},
                           Vec3f{0.1F, -1, 0.2F}, Vec3f{0.1F, 0.2F, 1}, Vec3f{0.1F, 0.2F, -1}}) {
        Vec3f gradient;
        const float found = signed_distance(map, p, &gradient);
        EXPECT_NEAR(found, 0, 1e-6F);
        EXPECT_EQ(std::signbit(found), contains(map, p));
        inside_count += std::signbit(found) ? 1 : 0;
        EXPECT_GT(dot(gradient, p), 0.999F); // out of the solid from either side
    }
    EXPECT_EQ(inside_count, 3); // by the perturbation of ties
}

TEST(ExactMapSignedDistance, IsNanOrInfiniteForPointsThatAreNotFinite) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    Vec3f gradient{1, 2, 3};
    for (const Vec3f& p : {Vec3f{kNan, 0, 0}, Vec3f{0, kInfinity, kNan}, Vec3f{0, 0, -kNan}}) {
        EXPECT_TRUE(std::isnan(signed_distance(map, p, &gradient)));
        EXPECT_EQ(gradient, Vec3f{});
    }
    for (const Vec3f& p : {Vec3f{kInfinity, 0, 0}, Vec3f{0, -kInfinity, kInfinity}}) {
        EXPECT_EQ(signed_distance(map, p, &gradient), kInfinity);
        EXPECT_EQ(gradient, Vec3f{});
    }
    constexpr float kFar = std::numeric_limits<float>::max();
    EXPECT_EQ(signed_distance(map, {kFar, 0, 0}, &gradient), kFar);
    EXPECT_EQ(gradient, (Vec3f{1, 0, 0}));
    EXPECT_EQ(signed_distance(map, {kFar, kFar, kFar}, &gradient), kInfinity); // beyond the range of float
    EXPECT_NEAR(length(gradient), 1, 1e-6F);
}

TEST(ExactMapSignedDistance, TakesABatchOfNoPoints) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    signed_distance_batch(map, {}, {});
    signed_distance_batch(map, {}, {}, {}, 0);
}

TEST(ExactMapSignedDistance, OfAnOpenSurfaceHasTheSignOfTheGeneralisedWindingNumber) {
    TriangleMesh bowl = make_sphere(1, 24, 12);
    std::erase_if(bowl.faces, [&](const Triangle& face) { return bowl.vertices[face[0]].z > 0.4F; });
    const ExactMap map = ExactMap::build(bowl);
    std::size_t inside_count = 0, computed_count = 0;
    for (const Vec3f& p : points_near_and_far(map, bowl)) {
        const float found = signed_distance(map, p);
        const Containment side = classify(map, p);
        ASSERT_EQ(std::signbit(found), side.inside);
        const double expected = unsigned_distance(bowl, Vec3d(p));
        ASSERT_NEAR(std::fabs(found), expected, tolerance(map, expected));
        inside_count += side.inside ? 1 : 0;
        computed_count += side.computed ? 1 : 0;
        if (std::fabs(winding_number(bowl, Vec3d(p)) - 0.5) > 1e-4 && expected > 1e-5)
            ASSERT_EQ(side.inside, winding_number(bowl, Vec3d(p)) > 0.5);
    }
    EXPECT_GT(inside_count, 100U);
    EXPECT_GT(computed_count, 100U);
}
