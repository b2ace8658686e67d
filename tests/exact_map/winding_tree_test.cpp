#include "directions/face_cone.hpp"
#include "exact_map/build/open_surface.hpp"
#include "exact_map/layout.hpp"
#include "exact_map/query/winding_tree.hpp"
#include "support/instruction_sets.hpp"
#include "support/meshes.hpp"
#include "support/point_sets.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/map_file.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>

using namespace echinus;

namespace {

using Real = long double;

/// The sum over all faces of the snapped mesh, by van Oosterom and Strackee. A place on a face counts as
/// moved by (e, e^2, e^3). In long double volumes around places of the lattice are exact.
Real full_winding_number(const ExactMapView& map, const Vec3<Real>& place) {
    Real sum = 0;
    for (std::uint32_t face = 0; face < map.face_count(); ++face) {
        const auto corners = face_corners(map, face);
        const Vec3<Real> a = Vec3<Real>(corners[0]) - place, b = Vec3<Real>(corners[1]) - place,
                         c = Vec3<Real>(corners[2]) - place;
        const Real la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
        const LatticePoint normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (normal == LatticePoint{}) continue;
        const Real volume = dot(a, cross(b, c));
        const Real base = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        const Real half = std::fabs(std::atan2(volume, base));
        const bool is_behind = volume != 0 ? volume > 0 : sign_of_perturbation(normal) < 0;
        sum += is_behind ? 2 * half : -2 * half;
    }
    return sum / (4 * std::numbers::pi_v<Real>);
}

/// The place that a query of a point is about: on the lattice where it may be.
Vec3<Real> queried_place(const ExactMapView& map, const Vec3f& point) {
    const Vec3d place = frame_of(map).to_lattice(point);
    const auto is_within = [](double x) { return std::fabs(x) <= double{kLatticeExtent} + 0.5; };
    if (is_within(place.x) && is_within(place.y) && is_within(place.z)) return Vec3<Real>(rounded(place));
    return Vec3<Real>(place);
}

std::vector<Vec3f> points_around(const ExactMapView& map, const TriangleMesh& mesh) {
    std::vector<Vec3f> points = test::uniform_points(mesh, 250);
    for (const Vec3f& p : test::surface_points(mesh, 150)) points.push_back(p);
    for (const Vec3f& p : test::surface_points(mesh, 50, 1e-4)) points.push_back(p);
    test::Random random(9);
    for (const float far : {1.1F, 2.0F, 30.0F, 1e6F})
        for (int n = 0; n < 10; ++n)
            points.push_back(map.centre + test::unit_vector(random) * (far * map.radius));
    points.push_back(map.centre);
    return points;
}

double distance_from_half(Real winding) {
    return static_cast<double>(std::fabs(winding - std::floor(winding) - Real{0.5}));
}

/// From where the side turns.
double distance_from_turn(InsideRule rule, Real winding) {
    return rule == InsideRule::Parity ? distance_from_half(winding)
                                      : static_cast<double>(std::fabs(std::fabs(winding) - Real{0.5}));
}

bool is_inside(InsideRule rule, Real winding) {
    const std::int64_t number = std::llrint(winding);
    return rule == InsideRule::Parity ? number % 2 != 0 : number != 0;
}

} // namespace

TEST(WindingTree, AgreesWithTheFullWindingNumberAtEveryPoint) {
    for (const auto& [name, mesh] : test::soups())
        for (const InsideRule rule : {InsideRule::Nonzero, InsideRule::Parity}) {
            const ExactMap map = ExactMap::build(mesh, {.rule = rule});
            ASSERT_FALSE(map.view().border.empty()) << name;
            for (const Vec3f& p : points_around(map, mesh)) {
                const Real full = full_winding_number(map, queried_place(map, p));
                const Containment found = classify(map, p);
                const double from_turn = distance_from_turn(rule, full);
                if (from_turn > 1e-7) // what both sums are rounded
                    ASSERT_EQ(found.inside, is_inside(rule, full)) << name << ", winding number " << full;
                if (found.computed && std::fabs(from_turn - kCertainMargin) > 1e-7)
                    ASSERT_EQ(found.certain, from_turn > kCertainMargin)
                        << name << ", winding number " << full;
                if (!found.computed) ASSERT_GE(from_turn, kCertainMargin - 1e-6) << name;
            }
        }
}

TEST(WindingTree, GivesTheWindingNumberToTheTolerance) {
    for (const auto& [name, mesh] : test::soups()) {
        const ExactMap map = ExactMap::build(mesh);
        for (const Vec3f& p : points_around(map, mesh)) {
            const auto full = static_cast<double>(full_winding_number(map, queried_place(map, p)));
            const double rounding = 1e-7 * std::max(1.0, std::fabs(full)); // to float
            for (const float tolerance : {0.3F, 1e-2F, 1e-4F, 0.0F}) {
                const float found = winding_number(map, p, tolerance);
                ASSERT_NEAR(found, full, std::max(double{tolerance}, 1e-8) + rounding) << name;
                if (distance_from_half(full) > 1e-6)
                    ASSERT_EQ(std::llrint(found), std::llrint(full)) << name << ", " << tolerance;
            }
        }
    }
}

TEST(WindingTree, GivesTheSameBitsUnderEveryInstructionSet) {
    for (const auto& [name, mesh] : test::soups()) {
        const ExactMap map = ExactMap::build(mesh);
        std::vector<Vec3f> points = points_around(map, mesh);
        for (const Vec3f& vertex : mesh.vertices)
            if (points.size() < 800) points.push_back(vertex);
        std::vector<float> expected, found(points.size());
        for (const Vec3f& p : points) expected.push_back(winding_number(map, p));
        test::under_each_instruction_set([&, name = name](std::string_view instruction_set) {
            for (const unsigned thread_count : {1U, 3U}) {
                winding_number_batch(map, points, found, 1e-2F, thread_count);
                EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(float)), 0)
                    << name << ", " << instruction_set;
            }
            std::vector<std::uint8_t> inside(points.size());
            contains_batch(map, points, inside);
            for (std::size_t i = 0; i < points.size(); ++i)
                ASSERT_EQ(inside[i] != 0, contains(map, points[i])) << name << ", " << instruction_set;
        });
    }
}

TEST(WindingTree, TellsTheSideOfAPlaceOnAFaceAsAClosedSurfaceDoes) {
    const TriangleMesh closed = make_box({2, 2, 2}, 16);
    TriangleMesh open = closed;
    std::erase_if(open.faces, [&](const Triangle& face) { // a hole in the middle of the top
        const Vec3f middle = open.vertices[face[0]] + open.vertices[face[1]] + open.vertices[face[2]];
        return middle.z > 2.99F && std::fabs(middle.x) < 1 && std::fabs(middle.y) < 1;
    });
    const ExactMap closed_map = ExactMap::build(closed), open_map = ExactMap::build(open);
    ASSERT_TRUE(open_map.view().winding_tree->has_caps);
    test::Random random(4);
    for (int n = 0; n < 600; ++n) {
        Vec3f p = test::in_cube(random, 0.9F);
        (n % 3 == 0 ? p.x : n % 3 == 1 ? p.y : p.z) = n % 2 == 0 ? -1.0F : 1.0F;
        if (p.z > 0.3F) continue; // beside the hole the surface differs
        ASSERT_EQ(winding_number(open_map, p, 1e-3F) > 0.5F, contains(closed_map, p))
            << p.x << " " << p.y << " " << p.z;
    }
}

TEST(WindingTree, AnswersOnEdgesAndVertices) {
    for (const auto& [name, mesh] : test::soups()) {
        const ExactMap map = ExactMap::build(mesh);
        for (std::size_t i = 0; i < mesh.faces.size(); i += 17) {
            const Vec3f a = mesh.vertices[mesh.faces[i][0]], b = mesh.vertices[mesh.faces[i][1]];
            for (const Vec3f& p : {a, b, (a + b) * 0.5F})
                ASSERT_TRUE(std::isfinite(winding_number(map, p))) << name;
        }
    }
}

TEST(WindingTree, HoldsCapsWhereTheyAreFarFewerThanTheFaces) {
    for (const auto& [name, mesh] : test::soups()) {
        const ExactMap map = ExactMap::build(mesh);
        const ExactMapView& view = map.view();
        ASSERT_EQ(view.winding_tree->has_caps, 2 * view.border.size() <= view.face_count()) << name;
        ASSERT_EQ(view.winding_tree->moments.size(), view.winding_tree->nodes.size()) << name;
    }
}

/// They have as many edges as the tube has faces, but most of their triangles are short.
TEST(WindingTree, HoldsCapsOfATubeOfLongFaces) {
    TriangleMesh tube;
    constexpr std::uint32_t kSides = 300;
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        const auto x = static_cast<float>(std::cos(angle)), y = static_cast<float>(std::sin(angle));
        tube.vertices.insert(tube.vertices.end(), {{x, y, -1}, {x, y, 1}});
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
        tube.faces.insert(tube.faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    }
    const ExactMap map = ExactMap::build(tube);
    EXPECT_TRUE(map.view().winding_tree->has_caps);
    test::Random random(6);
    for (int i = 0; i < 200; ++i) {
        const Vec3f p = test::in_cube(random, 1.5F);
        EXPECT_NEAR(winding_number(map, p, 1e-3F), winding_number(tube, Vec3d(p)), 2e-3);
    }
}

TEST(BorderCaps, CloseAnySurface) {
    TriangleMesh torn =
        make_sphere(1, 40, 20); // any three of its vertices but those of a parallel have an area
    std::erase_if(torn.faces, [n = 0](const Triangle&) mutable { return n++ % 5 == 0; });
    torn.faces.push_back(torn.faces.front()); // an edge that counts twice
    for (const TriangleMesh& mesh : {test::random_triangles(200, 1), torn}) {
        LatticeMesh lattice = snap_to_lattice(mesh);
        const std::vector<BorderEdge> border = find_border(lattice);
        ASSERT_FALSE(border.empty());
        const std::vector<Vec3<std::int32_t>> vertices(lattice.vertices.begin(), lattice.vertices.end());
        for (const Triangle& cap : cap_border(border, vertices)) lattice.faces.push_back(cap);
        EXPECT_TRUE(find_border(lattice).empty());
    }
}

TEST(BorderCaps, LeaveOpenWhatLeadsNowhere) {
    const std::vector<Vec3<std::int32_t>> vertices{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}};
    const std::vector<BorderEdge> dangling{{0, 1, 1}, {1, 2, 1}, {2, 0, 1}, {2, 3, 1}};
    EXPECT_EQ(cap_border(dangling, vertices).size(), 1U);
    const std::vector<BorderEdge> of_nothing{{0, 1, 1}, {1, 99, 1}, {99, 0, 1}}; // there is no vertex 99
    EXPECT_TRUE(cap_border(of_nothing, vertices).empty());
    EXPECT_TRUE(cap_border({}, vertices).empty());
}

TEST(WindingTree, OfAFileAnswersAsTheMapThatWasSaved) {
    for (const auto& [name, mesh] : test::soups()) {
        const ExactMap map = ExactMap::build(mesh);
        const auto bytes = std::make_shared<const std::vector<std::byte>>(serialise(map));
        const ExactMap loaded = std::get<ExactMap>(load_map(*bytes, bytes, name));
        ASSERT_EQ(loaded.view().winding_tree->moments.size(), map.view().winding_tree->moments.size());
        ASSERT_EQ(loaded.view().winding_tree->has_caps, map.view().winding_tree->has_caps);
        ASSERT_EQ(loaded.view().byte_count(), map.view().byte_count());
        for (const Vec3f& p : points_around(map, mesh))
            ASSERT_EQ(winding_number(loaded, p), winding_number(map, p)) << name;
    }
}

TEST(WindingNumber, OfAClosedSurfaceIsWhole) {
    const ExactMap map = ExactMap::build(test::joined(
        {make_box({2, 2, 2}), make_box({1, 1, 1}), test::turned_inside_out(make_box({0.5, 9, 9}))}));
    EXPECT_EQ(winding_number(map, {0.9F, 0.1F, 0.2F}), 1);
    EXPECT_EQ(winding_number(map, {0.4F, 0.1F, 0.2F}), 2);
    EXPECT_EQ(winding_number(map, {0.1F, 0.1F, 0.2F}), 1);
    EXPECT_EQ(winding_number(map, {0.1F, 3, 0.2F}), -1);
    EXPECT_EQ(winding_number(map, {50, 3, 0.2F}), 0);
}

TEST(WindingNumber, OfASmallHoleIsTheFullSum) {
    TriangleMesh pierced = make_torus(1, 0.4, 20, 10);
    pierced.faces.pop_back();
    const ExactMap map = ExactMap::build(pierced);
    ASSERT_TRUE(map.view().winding_tree->has_caps);
    for (const Vec3f& p : points_around(map, pierced)) {
        const auto full = static_cast<double>(full_winding_number(map, queried_place(map, p)));
        ASSERT_NEAR(winding_number(map, p, 0), full, 1e-4)
            << p.x << " " << p.y << " " << p.z << " " << length(p - map.view().centre);
    }
}

TEST(WindingNumber, IsNanOrZeroForPointsThatAreNotFinite) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const TriangleMesh& mesh : {make_box({2, 2, 2}), test::random_triangles(30, 1)}) {
        const ExactMap map = ExactMap::build(mesh);
        EXPECT_TRUE(std::isnan(winding_number(map, {0, kNan, 0})));
        EXPECT_TRUE(std::isnan(winding_number(map, {kInfinity, kNan, 0})));
        EXPECT_EQ(winding_number(map, {0, -kInfinity, 0}), 0);
        EXPECT_NEAR(winding_number(map, {3e38F, 3e38F, -3e38F}), 0, 1e-6F);
        EXPECT_EQ(winding_number(map, {0, 0, 0}, kNan), winding_number(map, {0, 0, 0}, 0));
        winding_number_batch(map, {}, {});
    }
}
