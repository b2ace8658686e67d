#include "exact_map/query/stretched_contact.hpp"
#include "property/generators.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

using namespace echinus;

namespace {

constexpr int kExactPointCount = 60;

test::PortableRandom random_for_exact_points() {
    return test::PortableRandom(*rc::gen::arbitrary<std::uint32_t>().as("seed of the points"));
}

ExactMapOptions random_options() {
    ExactMapOptions options;
    options.divisions = *rc::gen::inRange(0U, 20U).as("divisions");
    options.rule = *rc::gen::elementOf(std::vector{InsideRule::Nonzero, InsideRule::Parity}).as("rule");
    options.centre = *rc::gen::elementOf(
        std::vector{CentreChoice::BoundingSphere, CentreChoice::BoundingSphere, CentreChoice::Search});
    return options;
}

/// Near the map's surface, on its vertices, or anywhere.
Vec3f random_point(const TriangleMesh& mesh, const ExactMapView& map, test::PortableRandom& random) {
    const Triangle& face =
        mesh.faces[static_cast<std::size_t>(random.uniform(0, 0.999) * double(mesh.faces.size()))];
    const Vec3d a(mesh.vertices[face[0]]), b(mesh.vertices[face[1]]), c(mesh.vertices[face[2]]);
    const double kind = random.uniform(0, 1);
    if (kind < 0.2) return Vec3f(a);
    const double u = random.uniform(0, 1), v = random.uniform(0, 1);
    const auto away = [&] { return random.uniform(-1, 1) * double{map.radius}; };
    const Vec3d shift{away(), away(), away()};
    if (kind < 0.6) return Vec3f(a + (b - a) * (u * (1 - v)) + (c - a) * (u * v) + shift * 0.01);
    return Vec3f(Vec3d(map.centre) + shift);
}

/// Moves, mirrors and scales everything.
struct Placement {
    Rotation rotation;
    double scale;
    bool mirror;
    Vec3d offset;

    Vec3d operator()(const Vec3d& p) const {
        const Vec3d mirrored{mirror ? -p.x : p.x, p.y, p.z};
        return rotation.apply(mirrored) * scale + offset;
    }
};

Placement random_placement(const ExactMapView& map) {
    test::PortableRandom random(*rc::gen::arbitrary<std::uint32_t>().as("seed of the placement"));
    Placement placement;
    placement.rotation =
        Rotation::about({random.uniform(-1, 1), random.uniform(-1, 1), 1}, random.uniform(-3, 3));
    placement.scale = std::pow(10, *rc::gen::inRange(-6, 7).as("power of ten of the scale"));
    placement.mirror = *rc::gen::arbitrary<bool>().as("mirrored");
    const double reach =
        *rc::gen::inRange(0, 101).as("offset in radii") * double{map.radius} * placement.scale;
    placement.offset = Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)} * reach;
    return placement;
}

TriangleMesh placed(TriangleMesh mesh, const Placement& placement) {
    for (Vec3f& vertex : mesh.vertices) vertex = Vec3f(placement(Vec3d(vertex)));
    if (placement.mirror)
        for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

double largest_coordinate(const TriangleMesh& mesh) {
    double largest = 0;
    for (const Vec3f& v : mesh.vertices)
        largest = std::max({largest, std::fabs(double{v.x}), std::fabs(double{v.y}), std::fabs(double{v.z})});
    return largest;
}

} // namespace

RC_GTEST_PROP(ExactMap, AnswersTheSameWhereverTheWholeIsPlaced, ()) {
    const TriangleMesh mesh = test::random_mesh();
    const ExactMapOptions options = random_options();
    const ExactMap map = ExactMap::build(mesh, options);
    const Placement placement = random_placement(map.view());
    const TriangleMesh moved = placed(mesh, placement);
    const ExactMap moved_map = ExactMap::build(moved, options);
    // Two lattice steps plus the rounding of the moved vertices and the particle.
    const double step =
        std::max(double{map.view().radius}, moved_map.view().radius / placement.scale) / (1 << 19);
    const double rounding = 4 * 0x1p-24 * largest_coordinate(moved) / placement.scale;
    auto random = random_for_exact_points();
    for (int n = 0; n < kExactPointCount; ++n) {
        const Vec3f p = random_point(mesh, map.view(), random);
        if (contains(map, p) == contains(moved_map, Vec3f(placement(Vec3d(p))))) continue;
        RC_ASSERT(unsigned_distance(mesh, Vec3d(p)) <= 2 * 2 * step + rounding);
    }
}

RC_GTEST_PROP(ExactMap, AnswersTheSameForEveryResolutionAndRuleOfASimpleSolid, ()) {
    const TriangleMesh mesh = test::random_part();
    const ExactMap coarse = ExactMap::build(mesh, {.divisions = 1});
    const ExactMap fine =
        ExactMap::build(mesh, {.divisions = *rc::gen::inRange(2U, 40U), .rule = InsideRule::Parity});
    auto random = random_for_exact_points();
    for (int n = 0; n < kExactPointCount; ++n) {
        const Vec3f p = random_point(mesh, coarse, random);
        RC_ASSERT(contains(coarse, p) == contains(fine, p));
        RC_ASSERT(contact(coarse, p, 1).depth == contact(fine, p, 1).depth);
    }
}

RC_GTEST_PROP(ExactMap, GivesContactsThatAreSound, ()) {
    const TriangleMesh mesh = test::random_mesh();
    const ExactMap map = ExactMap::build(mesh, random_options());
    const double radius = map.view().radius;
    auto random = random_for_exact_points();
    for (int n = 0; n < kExactPointCount; ++n) {
        const Vec3f p = random_point(mesh, map, random);
        const auto margin = static_cast<float>(random.uniform(0, 0.5) * radius);
        const Contact c = contact(map, p, margin);
        RC_ASSERT(c.inside == contains(map, p));
        RC_ASSERT(c.certain);
        const double distance = unsigned_distance(mesh, Vec3d(p));
        const double tolerance = 1e-5 * radius;
        if (!c.found()) {
            RC_ASSERT(!c.inside && distance >= margin - tolerance);
            RC_ASSERT(c.depth == 0 && c.face == Contact::kUnknownFace && c.feature == Feature::Unknown);
            RC_ASSERT(c.point == p);
            continue;
        }
        RC_ASSERT(std::fabs(std::fabs(c.depth) - distance) <= tolerance);
        RC_ASSERT((c.inside ? c.depth >= 0 : c.depth <= 0));
        RC_ASSERT(std::fabs(length(c.normal) - 1) < 1e-5F);
        RC_ASSERT(c.feature != Feature::Unknown);
        RC_ASSERT(length(Vec3d(p) + Vec3d(c.normal) * double{c.depth} - Vec3d(c.point)) <= tolerance);
        const Triangle& face = mesh.faces[static_cast<std::size_t>(c.face)];
        const TriangleMesh only{mesh.vertices, {face}};
        RC_ASSERT(unsigned_distance(only, Vec3d(c.point)) <= tolerance);
    }
}

RC_GTEST_PROP(ExactMap, FindsTheNearestPointOfAStretchedWorld, ()) {
    const TriangleMesh mesh = test::random_mesh();
    const ExactMap map = ExactMap::build(mesh);
    const auto factor = [] {
        const double size = std::ldexp(*rc::gen::inRange(1, 9).as("stretch"), -3);
        return *rc::gen::arbitrary<bool>().as("mirrored") ? -size : size;
    };
    const double x = factor(), y = factor();
    const Vec3d stretch{x, y, factor()};
    TriangleMesh world = mesh;
    for (Vec3f& v : world.vertices) v = Vec3f(Vec3d{v.x * stretch.x, v.y * stretch.y, v.z * stretch.z});
    auto random = random_for_exact_points();
    for (int n = 0; n < kExactPointCount; ++n) {
        const Vec3f p = random_point(mesh, map, random);
        const Vec3d in_world{p.x * stretch.x, p.y * stretch.y, p.z * stretch.z};
        const Contact c = stretched_contact(map, p, 1e30F, stretch);
        RC_ASSERT(c.found());
        const double tolerance = 1e-5 * map.view().radius;
        RC_ASSERT(std::fabs(std::fabs(c.depth) - unsigned_distance(world, in_world)) <= tolerance);
        const Vec3d point{c.point.x * stretch.x, c.point.y * stretch.y, c.point.z * stretch.z};
        RC_ASSERT(length(in_world + Vec3d(c.normal) * double{c.depth} - point) <= 2 * tolerance);
    }
}

RC_GTEST_PROP(ExactMap, SweepsAreOfOneMindWithContains, ()) {
    const TriangleMesh mesh = test::random_part();
    const ExactMap map = ExactMap::build(mesh, random_options());
    auto random = random_for_exact_points();
    for (int n = 0; n < kExactPointCount; ++n) {
        const Vec3f from = random_point(mesh, map, random), to = random_point(mesh, map, random);
        const SweepHit hit = sweep(map, from, to);
        if (!hit.found()) {
            RC_ASSERT(contains(map, from) == contains(map, to));
            continue;
        }
        RC_ASSERT(hit.entering == !contains(map, from));
        RC_ASSERT(hit.fraction >= 0 && hit.fraction <= 1);
        RC_ASSERT(unsigned_distance(mesh, Vec3d(hit.point)) <= 1e-5 * map.view().radius);
    }
}
