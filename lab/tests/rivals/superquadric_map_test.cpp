#include "bad_meshes.hpp"
#include "property/shape_judge.hpp"
#include "property/shape_parts.hpp"
#include "rivals/superquadric_map/superquadric.hpp"
#include "rivals/superquadric_map/superquadric_map.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/point_sets.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::rivals;
using test::joined;
using test::translated;
using test::turned_inside_out;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

SuperquadricMapOptions with_segments(std::uint32_t count) {
    SuperquadricMapOptions options;
    options.segment_count = count;
    options.decomposition_face_limit = 500; // for the sake of time
    return options;
}

SuperquadricMapOptions small_grid(std::uint32_t segments = 0) {
    SuperquadricMapOptions options = with_segments(segments);
    options.omega_count = 60;
    options.eta_count = 40;
    return options;
}

/// Decomposed in a fifth of the time that 30 x 12 segments take.
TriangleMesh coarse_torus() {
    return make_torus(1, 0.4, 20, 8);
}

/// Everywhere, and near the surface.
std::vector<Vec3f> points_around(const TriangleMesh& mesh, std::size_t count = 4000) {
    std::vector<Vec3f> points = test::uniform_points(mesh, count);
    const std::vector<Vec3f> near = test::surface_points(mesh, count, 0.03);
    points.insert(points.end(), near.begin(), near.end());
    return points;
}

/// The largest distance from the surface at which the map is wrong about the side.
double farthest_wrong(const SuperquadricMap& map, const TriangleMesh& mesh) {
    const ExactMap exact = ExactMap::build(mesh);
    double farthest = 0;
    for (const Vec3f& p : points_around(mesh)) {
        const Contact truth = contact(exact, p, 1e9F);
        if (map.contains(p) != truth.inside)
            farthest = std::max(farthest, std::fabs(static_cast<double>(truth.depth)));
    }
    return farthest;
}

TriangleMesh rotated(TriangleMesh mesh, const Rotation& rotation) {
    for (Vec3f& p : mesh.vertices) p = Vec3f(rotation.apply(Vec3d(p)));
    return mesh;
}

void expect_same_answers(const SuperquadricMap& map, const SuperquadricMap& other, const TriangleMesh& mesh) {
    for (const Vec3f& p : points_around(mesh, 500)) {
        const Contact a = map.contact(p, 0.1F), b = other.contact(p, 0.1F);
        ASSERT_EQ(a.inside, b.inside);
        ASSERT_EQ(a.depth, b.depth);
        ASSERT_EQ(a.normal, b.normal);
        ASSERT_EQ(a.point, b.point);
    }
}

} // namespace

TEST(SuperquadricMap, OfASphereIsRightToWithinItsTriangles) {
    // An edge of 3 degrees keeps a triangle within 1 - cos(1.5 degrees) = 3e-4 of the sphere, and samples are
    // closer than that to each other.
    const TriangleMesh sphere = translated(make_sphere(1, 120, 60), {3, 4, 5});
    const SuperquadricMap map = SuperquadricMap::build(sphere, with_segments(1));
    EXPECT_EQ(map.segment_count(), 1U);
    EXPECT_LT(farthest_wrong(map, sphere), 1e-3);
    for (const Vec3f& p : points_around(sphere)) {
        const Vec3f from_centre = p - Vec3f{3, 4, 5};
        const float r = length(from_centre);
        if (r < 0.02F || std::fabs(r - 1) < 2e-3F) continue;
        const Contact contact = map.contact(p, 0.5F);
        ASSERT_EQ(contact.inside, r < 1);
        ASSERT_EQ(contact.found(), r < 1.5F) << r;
        if (!contact.found()) continue;
        EXPECT_NEAR(contact.depth, 1 - r, 2e-3);
        EXPECT_GT(dot(contact.normal, from_centre) / r, std::cos(0.06F));
        EXPECT_NEAR(length(contact.normal), 1, 1e-5);
        EXPECT_NEAR(length(contact.point - (p + from_centre * (contact.depth / r))), 0, 2e-3);
    }
}

TEST(SuperquadricMap, OfABoxInAnyPoseIsRightToWhatTheSpacingOfItsSamplesAllows) {
    // At an exponent of 0.1 the formula has no sample between 0.6 of a half side and -0.6: (pi / 400)^0.1 =
    // 0.62.
    for (const Rotation& rotation : {Rotation{}, Rotation::about({1, 2, 3}, 0.8)}) {
        const TriangleMesh box = rotated(make_box({2, 1, 0.6}, 4), rotation);
        const SuperquadricMap map = SuperquadricMap::build(box, with_segments(1));
        EXPECT_EQ(map.segment_count(), 1U);
        EXPECT_LT(farthest_wrong(map, box), 0.03);
        // From the middle of a face the way out is straight.
        const Vec3f up(rotation.apply({0, 0, 1}));
        const Contact contact = map.contact(up * 0.2F);
        EXPECT_NEAR(contact.depth, 0.1, 0.03);
        EXPECT_GT(dot(contact.normal, up), 0.9F);
    }
}

TEST(SuperquadricMap, OfASuperquadricIsRightToWithinItsTriangles) {
    Superquadric shape;
    shape.centre = {10, 20, 30};
    shape.rotation = Rotation::about({3, 1, 2}, 1.1);
    shape.sizes = {3, 2, 1.5};
    shape.eta_exponent = 0.7;
    shape.omega_exponent = 0.9;
    const TriangleMesh mesh = tessellate(shape, 80, 120);
    const SuperquadricMap map = SuperquadricMap::build(mesh, small_grid(1));
    EXPECT_LT(farthest_wrong(map, mesh), 0.03);
}

TEST(SuperquadricMap, OfATorusErrsNoFartherThanItsSegmentsAllowForConcavity) {
    const TriangleMesh torus = make_torus(1, 0.4, 30, 12);
    EXPECT_LT(farthest_wrong(SuperquadricMap::build(torus, with_segments(12)), torus), 0.1);
}

TEST(SuperquadricMap, AnswersForTheUnionOfPartsThatOverlap) {
    const TriangleMesh parts =
        joined({make_sphere(1, 48, 24), translated(make_sphere(1, 48, 24), {1.2F, 0, 0})});
    const SuperquadricMap map = SuperquadricMap::build(parts, with_segments(2));
    EXPECT_EQ(map.segment_count(), 2U);
    EXPECT_LT(farthest_wrong(map, parts), 0.01);
    // Half-way between the centres a particle is 0.4 deep in both; nearer to one it goes that one's way.
    EXPECT_NEAR(map.contact({0.6F, 0, 0}).depth, 0.4, 0.01);
    const Contact left = map.contact({-0.5F, 0, 0});
    EXPECT_NEAR(left.depth, 0.5, 0.01);
    EXPECT_NEAR(left.normal.x, -1, 0.01);
    const Contact right = map.contact({1.7F, 0, 0});
    EXPECT_NEAR(right.normal.x, 1, 0.01);
    EXPECT_NEAR(right.point.x, 2.2, 0.01);
}

TEST(SuperquadricMap, CountsTheBytesOfItsLayoutAndKeepsToABudget) {
    const TriangleMesh torus = coarse_torus();
    SuperquadricMapOptions options = with_segments(4);
    EXPECT_EQ(SuperquadricMap::build(torus, options).byte_count(), 4U * (76 + 400 * 8 + 40'000 * 4));
    options.sample_format = EntryFormat::Unorm16;
    EXPECT_EQ(SuperquadricMap::build(torus, options).byte_count(), 4U * (76 + 400 * 8 + 40'000 * 2));
    options.byte_budget = 210'000;
    const SuperquadricMap map = SuperquadricMap::build(torus, options);
    EXPECT_LE(map.byte_count(), 210'000U);
    EXPECT_GT(map.byte_count(), 200'000U);
    EXPECT_EQ(map.omega_count(), map.eta_count());
}

TEST(SuperquadricMap, AnswersAlikeFrom16Bits) {
    const TriangleMesh torus = coarse_torus();
    SuperquadricMapOptions options = small_grid(8);
    const SuperquadricMap full = SuperquadricMap::build(torus, options);
    options.sample_format = EntryFormat::Unorm16;
    const SuperquadricMap half = SuperquadricMap::build(torus, options);
    for (const Vec3f& p : points_around(torus)) {
        const Contact a = full.contact(p), b = half.contact(p);
        if (std::fabs(a.depth) > 1e-4F) {
            ASSERT_EQ(a.inside, b.inside);
        }
        if (a.inside && b.inside) {
            ASSERT_NEAR(a.depth, b.depth, 1e-4);
        }
    }
}

TEST(SuperquadricMap, DoesNotDependOnThreadsWindingOrVerticesThatAreNotShared) {
    const TriangleMesh torus = make_torus(1, 0.4, 30, 12);
    SuperquadricMapOptions options = small_grid(8);
    const SuperquadricMap map = SuperquadricMap::build(torus, options);
    options.thread_count = 1;
    expect_same_answers(map, SuperquadricMap::build(torus, options), torus);
    TriangleMesh apart;
    for (const Triangle& face : torus.faces) {
        const auto first = static_cast<std::uint32_t>(apart.vertices.size());
        for (const std::uint32_t v : face) apart.vertices.push_back(torus.vertices[v]);
        apart.faces.push_back({first, first + 1, first + 2});
    }
    EXPECT_LT(farthest_wrong(SuperquadricMap::build(apart, small_grid(12)), torus), 0.2);
    EXPECT_LT(farthest_wrong(SuperquadricMap::build(turned_inside_out(torus), small_grid(12)), torus), 0.2);
}

TEST(SuperquadricMap, AnswersBatchesLikeSingleParticles) {
    const TriangleMesh torus = coarse_torus();
    const SuperquadricMap map = SuperquadricMap::build(torus, small_grid(8));
    const std::vector<Vec3f> points = points_around(torus, 500);
    std::vector<std::uint8_t> inside(points.size(), 2);
    std::vector<Contact> contacts(points.size());
    map.contains_batch(points, inside);
    map.contacts_batch(points, contacts);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Contact contact = map.contact(points[i], 0.05F);
        ASSERT_EQ(inside[i], map.contains(points[i]) ? 1 : 0);
        ASSERT_EQ(contact.inside, inside[i] == 1);
        ASSERT_EQ(contacts[i].found(), contact.inside);
        ASSERT_EQ(contacts[i].depth, contact.inside ? contact.depth : 0);
        if (!contact.found()) {
            ASSERT_EQ(contact.point, points[i]);
            ASSERT_EQ(contact.depth, 0);
        }
        if (contact.found() && !contact.inside) {
            ASSERT_TRUE(contact.depth < 0 && contact.depth >= -0.05F);
        }
    }
}

TEST(SuperquadricMap, TakesNaNAndInfinityAndWhatIsFarAwayForOutside) {
    const SuperquadricMap map = SuperquadricMap::build(make_box({2, 2, 2}), small_grid());
    for (const float bad : {kNan, kInfinity, -kInfinity, std::numeric_limits<float>::max(), 1e9F})
        for (const Vec3f& p : {Vec3f{bad, 0, 0}, Vec3f{0, bad, 0}, Vec3f{0, 0, bad}, Vec3f{bad, bad, bad}})
            for (const float margin : {0.0F, 1.0F, kNan}) {
                EXPECT_FALSE(map.contains(p));
                EXPECT_FALSE(map.contact(p, margin).found());
            }
    EXPECT_TRUE(map.contains({0, 0, 0}));
    const Contact at_centre = map.contact({0, 0, 0});
    EXPECT_GT(at_centre.depth, 0.99F);
    EXPECT_NEAR(length(at_centre.normal), 1, 1e-5);
}

TEST(SuperquadricMap, WorksForSolidsOfEverySize) {
    for (const float size : {1e-12F, 1e12F}) {
        TriangleMesh torus = make_torus(1, 0.4, 30, 12);
        for (Vec3f& p : torus.vertices) p *= size;
        const SuperquadricMap map = SuperquadricMap::build(torus, small_grid(12));
        EXPECT_TRUE(map.contains({size, 0, 0}));
        EXPECT_FALSE(map.contains({0, 0, 0}));
        EXPECT_NEAR(map.contact({size, 0, 0}).depth / size, 0.4, 0.15);
    }
}

TEST(SuperquadricMap, TellsOfItsProgressAndStopsWhenTheListenerThrows) {
    std::vector<std::string> stages;
    const auto note = [&](std::string_view stage, double) {
        if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    };
    (void)SuperquadricMap::build(make_torus(1, 0.4, 20, 10), small_grid(3), note);
    EXPECT_EQ(stages, (std::vector<std::string>{"simplify", "decompose", "fit", "sample"}));
    EXPECT_THROW((void)SuperquadricMap::build(make_torus(1, 0.4, 20, 10), small_grid(3),
                                              [](std::string_view stage, double) {
                                                  if (stage == "fit") throw std::runtime_error("stop");
                                              }),
                 std::runtime_error);
}

TEST(SuperquadricMap, IsTheSameWhetherItsSegmentsWereFittedForItOrForAnother) {
    const TriangleMesh torus = make_torus(1, 0.4, 20, 10);
    const SuperquadricSegments segments = SuperquadricSegments::fit(torus, with_segments(5));
    ASSERT_GE(segments.count(), 5U);
    (void)SuperquadricMap::sample(segments, small_grid());
    SuperquadricMapOptions options = with_segments(5);
    options.byte_budget = 20'000;
    const SuperquadricMap map = SuperquadricMap::sample(segments, options);
    EXPECT_LE(map.byte_count(), 20'000U);
    expect_same_answers(map, SuperquadricMap::build(torus, options), torus);
}

TEST(SuperquadricMap, HasNoSegmentsWhereThereIsNoVolume) {
    TriangleMesh squashed = make_box({1, 1, 1}, 2);
    for (Vec3f& p : squashed.vertices) p.z = 0;
    for (const TriangleMesh& mesh : {test::flat_mesh(), squashed}) {
        const SuperquadricMap map = SuperquadricMap::build(mesh);
        EXPECT_EQ(map.segment_count(), 0U);
        EXPECT_FALSE(map.contains({0.1F, 0.1F, 0}));
        EXPECT_FALSE(map.contact({0.1F, 0.1F, 0}, 10).found());
    }
}

TEST(SuperquadricMap, RefusesOptionsOutOfBounds) {
    const auto refuses = [](const char* words, auto&& change) {
        SuperquadricMapOptions options;
        change(options);
        test::expect_error(ErrorCode::InvalidOptions, words, [&] {
            (void)SuperquadricMap::build(make_box({1, 1, 1}), options);
        });
    };
    refuses("segment_count", [](auto& o) { o.segment_count = 5000; });
    refuses("omega_count", [](auto& o) { o.omega_count = 3; });
    refuses("eta_count", [](auto& o) { o.eta_count = 5000; });
    refuses("concavity", [](auto& o) { o.concavity = 0; });
    refuses("concavity", [](auto& o) { o.concavity = std::numeric_limits<double>::quiet_NaN(); });
    refuses("decomposition_face_limit", [](auto& o) { o.decomposition_face_limit = 3; });
    refuses("budget", [](auto& o) { o.byte_budget = 100; });
}

TEST(SuperquadricMapOfTheHorse, HasSeventeenSegmentsOnRequestAndTellsMostParticlesRight) {
    const std::filesystem::path file = std::filesystem::path(ECHINUS_SHARED) / "meshes/horse_6k.obj";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const TriangleMesh horse = read_mesh(file);
    SuperquadricMapOptions options;
    options.segment_count = 17;
    options.decomposition_face_limit = 3000; // for the sake of time
    const SuperquadricMap map = SuperquadricMap::build(horse, options);
    EXPECT_EQ(map.segment_count(), 17U);

    const ExactMap exact = ExactMap::build(horse);
    const auto wrong_share = [&](const std::vector<Vec3f>& points) {
        std::size_t wrong = 0;
        for (const Vec3f& p : points) wrong += map.contains(p) != contains(exact, p) ? 1 : 0;
        return static_cast<double>(wrong) / static_cast<double>(points.size());
    };
    EXPECT_LT(wrong_share(test::uniform_points(horse, 20'000)), 0.002);
    EXPECT_LT(wrong_share(test::surface_points(horse, 20'000)), 0.04);
}

// Superquadric maps of shapes that designers make. They are approximate: what is asked is what holds all the
// same.

using namespace echinus::test;
using rivals::SuperquadricMap;

namespace {

SuperquadricMap make_map(const TriangleMesh& mesh, std::uint32_t segment_count) {
    rivals::SuperquadricMapOptions options;
    options.segment_count = segment_count;
    options.omega_count = 60;
    options.eta_count = 40;
    options.decomposition_face_limit = 300; // for the sake of time
    options.thread_count = 1;
    return SuperquadricMap::build(mesh, options);
}

std::vector<Vec3f> points_around(const TriangleMesh& mesh, std::size_t count, Choices& choices) {
    const Sphere sphere = inspect(mesh).bounding_sphere;
    std::vector<Vec3f> points;
    while (points.size() < count) {
        const auto coordinate = [&] { return choices.within(-1.3, 1.3) * sphere.radius; };
        const double x = coordinate(), y = coordinate();
        points.emplace_back(Vec3d(sphere.centre) + Vec3d{x, y, coordinate()});
    }
    return points;
}

bool is_convex(const TriangleMesh& mesh) {
    const double tolerance = 1e-5 * inspect(mesh).bounding_sphere.radius;
    return std::ranges::all_of(mesh.faces, [&](const Triangle& face) {
        const Vec3d a(mesh.vertices[face[0]]), b(mesh.vertices[face[1]]), c(mesh.vertices[face[2]]);
        const Vec3d normal = cross(b - a, c - a);
        return std::ranges::all_of(mesh.vertices, [&](const Vec3f& v) {
            return dot(normal, Vec3d(v) - a) <= tolerance * length(normal);
        });
    });
}

} // namespace

TEST(SuperquadricShapes, HaveNothingInsideThatIsFarBeyondTheirBox) {
    std::size_t map_count = 0;
    for (std::uint64_t seed = 1; map_count < 12; ++seed) {
        const Shape shape = make_shape(seed);
        if (shape.mesh.faces.size() > 100) continue;
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + shape.recipe);
        ++map_count;
        const SuperquadricMap map = make_map(shape.mesh, 0);
        const Box box = box_of(shape.mesh);
        const double radius = inspect(shape.mesh).bounding_sphere.radius;
        Choices choices(seed);
        const std::vector<Vec3f> points = points_around(shape.mesh, 400, choices);
        std::vector<std::uint8_t> inside(points.size());
        map.contains_batch(points, inside);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3f& p = points[i];
            const Contact found = map.contact(p, static_cast<float>(radius));
            ASSERT_EQ(map.contains(p), inside[i] != 0);
            ASSERT_EQ(found.inside, inside[i] != 0);
            if (found.found()) ASSERT_NEAR(length(found.normal), 1, 1e-4);
            ASSERT_TRUE(is_finite(found.point));
            const Vec3f low = box.low - p, high = p - box.high;
            const double beyond = std::max({low.x, low.y, low.z, high.x, high.y, high.z});
            if (found.inside) ASSERT_LT(beyond, 0.2 * radius) << p.x << " " << p.y << " " << p.z;
        }
    }
}

TEST(SuperquadricShapes, AreOnTheRightSideOfAConvexOneButNearItsEdges) {
    std::size_t map_count = 0, point_count = 0, wrong_count = 0;
    for (std::uint64_t seed = 270; map_count < 25; ++seed) {
        const Shape shape = make_shape(seed);
        if (!is_convex(shape.mesh)) continue;
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + shape.recipe);
        ++map_count;
        const double radius = inspect(shape.mesh).bounding_sphere.radius;
        const SuperquadricMap map = make_map(shape.mesh, 1);
        const ShapeJudge judge(shape.mesh, 1e-5 * radius);
        Choices choices(seed);
        for (const Vec3f& p : points_around(shape.mesh, 400, choices)) {
            const std::optional<int> winding = judge.winding(Vec3d(p));
            if (!winding) continue;
            ++point_count;
            if (map.contains(p) == (*winding != 0)) continue;
            ++wrong_count;
            ASSERT_LT(judge.distance(Vec3d(p)), 0.4 * radius) << p.x << " " << p.y << " " << p.z;
        }
    }
    EXPECT_LT(wrong_count, point_count / 200);
}
