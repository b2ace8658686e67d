// Queries of triangles agree with CGAL: intersections exactly, distances to rounding.

#include "directions/lattice.hpp"
#include "judges/exact_judge.hpp"
#include "judges/nasty_meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/surface_queries.hpp>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

using namespace echinus;
using namespace echinus::test;

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using QueryCorners = std::array<Vec3d, 3>;

Kernel::Point_3 to_cgal(const Vec3d& p) {
    return {p.x, p.y, p.z};
}

QueryCorners in_double(const TrianglePoints& t) {
    return {Vec3d(t[0]), Vec3d(t[1]), Vec3d(t[2])};
}

/// In exact arithmetic: of two triangles that do not meet, edges are nearest or a corner and a face.
double distance_by_cgal(const QueryCorners& a, const QueryCorners& b) {
    std::array<Kernel::Point_3, 3> p, q;
    for (std::size_t k = 0; k < 3; ++k) {
        p[k] = to_cgal(a[k]);
        q[k] = to_cgal(b[k]);
    }
    Kernel::FT least = std::numeric_limits<double>::max();
    const auto offer = [&](const Kernel::FT& candidate) { least = std::min(least, candidate); };
    const auto edge = [](const std::array<Kernel::Point_3, 3>& t, std::size_t k) {
        return Kernel::Segment_3(t[k], t[(k + 1) % 3]);
    };
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) offer(CGAL::squared_distance(edge(p, i), edge(q, j)));
    for (const auto& [corners, others] : {std::pair(&p, &q), std::pair(&q, &p)}) {
        const Kernel::Triangle_3 triangle((*corners)[0], (*corners)[1], (*corners)[2]);
        if (triangle.is_degenerate()) continue; // it is its edges
        for (std::size_t k = 0; k < 3; ++k) {
            if (CGAL::do_intersect(edge(*others, k), triangle)) return 0;
            offer(CGAL::squared_distance((*others)[k], triangle));
        }
    }
    return std::sqrt(CGAL::to_double(least));
}

TrianglePoints random_triangle(Random& random, const ExactMap& map, float size) {
    const float radius = map.view().radius;
    const Vec3f middle = map.view().centre + in_sphere(random, 1.2F * radius);
    return {middle + in_cube(random, size * radius), middle + in_cube(random, size * radius),
            middle + in_cube(random, size * radius)};
}

/// A triangle parallel to a face, where nearest points are not unique.
TrianglePoints beside(const TriangleMesh& mesh, std::size_t face, float height) {
    const auto [a, b, c] = mesh.faces[face];
    const Vec3f p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
    const Vec3f normal = cross(q - p, r - p);
    const Vec3f offset = normal * (height / length(normal));
    return {p + offset, q + offset, r + offset};
}

} // namespace

TEST(SurfaceQueriesOracle, TrianglesIntersectTheSnappedFacesAsCgalSays) {
    Random random(1);
    for (const auto& [name, mesh] : generated_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        const ExactMapView& view = map.view();
        const LatticeFrame frame(view.centre, view.radius);
        TriangleMesh lattice;
        for (const auto& v : view.vertices) lattice.vertices.push_back(Vec3f(v));
        for (std::size_t f = 0; f < view.face_count(); ++f)
            lattice.faces.push_back({view.corners[3 * f], view.corners[3 * f + 1], view.corners[3 * f + 2]});
        for (int i = 0; i < 150; ++i) {
            const TrianglePoints triangle =
                i % 3 == 0 ? beside(mesh, static_cast<std::size_t>(i) % mesh.faces.size(), 0)
                           : random_triangle(random, map, 0.3F);
            TriangleMesh snapped{{}, {{0, 1, 2}}};
            for (const Vec3f& p : triangle) snapped.vertices.push_back(Vec3f(rounded(frame.to_lattice(p))));
            ASSERT_EQ(intersects(view, triangle), !intersecting_pairs_by_cgal(snapped, lattice).empty())
                << name << ", " << i;
        }
    }
}

TEST(SurfaceQueriesOracle, DistancesAreCgalsFromBelow) {
    Random random(2);
    FaceLists lists;
    for (const auto& [name, mesh] : generated_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        const ExactMapView& view = map.view();
        const LatticeFrame frame(view.centre, view.radius);
        const double tolerance = 1e-6 * view.radius;
        for (int i = 0; i < 12; ++i) {
            TrianglePoints triangle =
                i % 3 == 0 ? beside(mesh, static_cast<std::size_t>(17 * i) % mesh.faces.size(), 0.01F)
                           : random_triangle(random, map, i % 3 == 1 ? 0.3F : 0.01F);
            if (i % 4 == 3) triangle[2] = triangle[1] + (triangle[1] - triangle[0]) * 1e-6F; // a sliver
            const double reach = 0.2 * view.radius;
            faces_within_batch(view, triangle, std::vector<Triangle>{{0, 1, 2}}, static_cast<float>(reach),
                               lists);
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t f = 0; f < view.face_count(); ++f) {
                QueryCorners face;
                for (std::size_t k = 0; k < 3; ++k)
                    face[k] = frame.to_local(Vec3d(view.vertices[view.corners[3 * f + k]]));
                const double distance = distance_by_cgal(in_double(triangle), face);
                least = std::min(least, distance);
                if (std::fabs(distance - reach) < tolerance) continue;
                ASSERT_EQ(std::binary_search(lists[0].begin(), lists[0].end(), view.face_numbers[f]),
                          distance < reach)
                    << name << ", " << i << ": face " << f << " at " << distance << " of " << reach;
            }
            const float found = clearance(view, triangle).distance;
            ASSERT_LE(found, least * (1 + 1e-12)) << name << ", " << i;
            ASSERT_GE(found, least - tolerance) << name << ", " << i;
        }
    }
}

// Sweeps of particles from any distance meet what CGAL's rational numbers say.

namespace {

using Rational = CGAL::Exact_rational;

/// The part of a way that is near the map's centre, in lattice steps. Brought near in rational numbers, so
/// that double does for all that follows.
struct NearWay {
    Vec3d from, to;
    double share; ///< of the way, where it is nearest to the centre
};

/// None where the way ends before it is near, or begins after.
std::optional<NearWay> near_way(const LatticeFrame& frame, const Vec3f& from, const Vec3f& to) {
    Rational start[3], way[3], along = 0, size_sq = 0;
    for (int c = 0; c < 3; ++c) {
        const auto coordinate = [c](const auto& v) { return double{c == 0 ? v.x : c == 1 ? v.y : v.z}; };
        start[c] = Rational(coordinate(from)) - Rational(coordinate(frame.centre));
        way[c] = Rational(coordinate(to)) - Rational(coordinate(from));
        along -= start[c] * way[c];
        size_sq += way[c] * way[c];
    }
    const Rational middle = along / size_sq;
    const Rational half(4 * frame.step * static_cast<double>(kLatticeExtent) /
                        std::sqrt(CGAL::to_double(size_sq)));
    const Rational first = std::max(Rational(middle - half), Rational(0));
    const Rational last = std::min(Rational(middle + half), Rational(1));
    if (first >= last) return std::nullopt;
    const auto place_at = [&](const Rational& share) {
        double place[3];
        for (int c = 0; c < 3; ++c)
            place[c] = CGAL::to_double(Rational((start[c] + way[c] * share) / Rational(frame.step)));
        return Vec3d{place[0], place[1], place[2]};
    };
    return NearWay{place_at(first), place_at(last), CGAL::to_double(middle)};
}

double distance_to_line(const Vec3d& p, const NearWay& way) {
    const Vec3d along = way.to - way.from;
    return length(cross(p - way.from, along)) / length(along);
}

/// Between a line and a segment.
double distance_to_edge(const NearWay& way, const Vec3d& a, const Vec3d& b) {
    const Vec3d normal = cross(way.to - way.from, b - a);
    const Vec3d across = cross(way.to - way.from, normal);
    const double a_side = dot(a - way.from, across), b_side = dot(b - way.from, across);
    if (a_side * b_side < 0) return std::fabs(dot(a - way.from, normal)) / length(normal);
    return std::min(distance_to_line(a, way), distance_to_line(b, way));
}

/// The first face that the way meets on the map's lattice.
struct Meeting {
    std::uint32_t face = kNoIndex;
    bool entering = false;
    Vec3d place;
    double steepness = 1; ///< sine of the angle between way and face
    bool clear = true;    ///< a way two lattice steps beside this one meets the same faces
};

Meeting first_meeting(const ExactMapView& map, const NearWay& way) {
    constexpr double kClear = 2;
    Meeting meeting;
    double first = 1;
    for (std::size_t face = 0; face < map.face_count(); ++face) {
        const auto corner = [&](std::size_t k) { return Vec3d(map.vertices[map.corners[3 * face + k]]); };
        const Vec3d a = corner(0), b = corner(1), c = corner(2);
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            meeting.clear = meeting.clear && distance_to_edge(way, p, q) > kClear;
        const Vec3d normal = cross(b - a, c - a), along = way.to - way.from;
        const double rate = dot(normal, along), share = dot(normal, a - way.from) / rate;
        const Vec3d place = way.from + along * share;
        const auto left_of = [&](const Vec3d& p, const Vec3d& q) {
            return dot(cross(q - p, place - p), normal) > 0;
        };
        if (!(share >= 0 && share < first) || !left_of(a, b) || !left_of(b, c) || !left_of(c, a)) continue;
        first = share;
        meeting.face = map.face_numbers[face];
        meeting.entering = rate < 0;
        meeting.place = place;
        meeting.steepness = std::fabs(rate) / (length(normal) * length(along));
    }
    return meeting;
}

struct Way {
    Vec3f from, to;
};

/// Ways that pass near the place (x, 0, 0), although floats of that size are far apart: through the origin,
/// in every direction; far along one axis or two; from nearby; and away.
Way way_past(Random& random, float x, int kind, float far, float near) {
    const Vec3f direction = unit_vector(random), other = unit_vector(random) * near;
    const float back = -std::ldexp(far, static_cast<int>(random() % 5) - 2);
    switch (kind) {
    case 0:
        return {direction * far, direction * back};
    case 1:
        return {{direction.x * far, other.x, other.y}, {direction.x * back, other.z, other.x}};
    case 2:
        return {{x + other.x, direction.y * far, direction.z * far},
                {x + other.y, direction.y * back, direction.z * back}};
    case 3:
        return {Vec3f{x, 0, 0} + other, direction * far};
    default:
        return {direction * far, direction * (1.5F * far)};
    }
}

} // namespace

TEST(SweepOracle, ParticlesFromAnyDistanceMeetTheFaceThatTheirWayMeets) {
    Random random(1);
    int met = 0, missed = 0;
    for (const auto& [size, x] : {std::pair(1e-14F, 0.0F), {1.0F, 0.0F}, {1.0F, 300.0F}, {1e14F, 0.0F}})
        for (const auto& [name, original] : generated_meshes()) {
            TriangleMesh mesh = translated(original, in_cube(random, 0.6F) + Vec3f{x, 0, 0});
            for (Vec3f& vertex : mesh.vertices) vertex *= size;
            const ExactMap map = ExactMap::build(mesh);
            const ExactMapView& view = map.view();
            const LatticeFrame frame(view.centre, view.radius);
            for (int n = 0; n < 200; ++n) {
                const float far = std::pow(10.0F, uniform(random, 3 + std::log10(view.radius), 37.5F));
                const auto [from, to] = way_past(random, x * size, n % 5, far, view.radius);
                const SweepHit hit = sweep(view, from, to);
                const auto way = near_way(frame, from, to);
                if (!way) {
                    ASSERT_FALSE(hit.found());
                    continue;
                }
                // Two steps, and the rounding of the point to float.
                const double tolerance = 2 + 0x1p-23 * length(hit.point) / frame.step;
                const Vec3d place = frame.to_lattice(hit.point);
                if (hit.found()) ASSERT_LT(distance_to_line(place, *way), tolerance) << name << ", " << far;
                const Meeting meeting = first_meeting(view, *way);
                if (!meeting.clear) continue;
                ASSERT_EQ(hit.face, meeting.face) << name << ", " << far << ", " << n % 5;
                missed += !hit.found();
                if (!hit.found()) continue;
                ++met;
                ASSERT_EQ(hit.entering, meeting.entering);
                ASSERT_LT(length(place - meeting.place), tolerance / meeting.steepness);
                if (n % 5 < 3) ASSERT_NEAR(hit.fraction, way->share, 1e-2);
            }
        }
    EXPECT_GT(met, 1000);
    EXPECT_GT(missed, 100);
}
