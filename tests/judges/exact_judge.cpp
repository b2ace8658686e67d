#include "judges/exact_judge.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Bbox_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <variant>

namespace echinus::test {

namespace {

/// Predicates are exact, constructions rounded.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
/// Arbitrary-precision integers.
using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;

using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

template <typename K>
typename K::Point_3 to_cgal(const Vec3d& p) {
    return {p.x, p.y, p.z};
}

template <typename K>
typename K::Triangle_3 to_cgal(const std::array<Vec3d, 3>& corners) {
    return {to_cgal<K>(corners[0]), to_cgal<K>(corners[1]), to_cgal<K>(corners[2])};
}

std::array<Vec3d, 3> corners_of(const TriangleMesh& mesh, const Triangle& face) {
    return {Vec3d(mesh.vertices[face[0]]), Vec3d(mesh.vertices[face[1]]), Vec3d(mesh.vertices[face[2]])};
}

using SoupMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using SoupTree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<SoupMesh>>>;

/// Each face has its own corners: trees need no more, and Surface_mesh refuses non-manifold meshes.
SoupMesh soup_of(const TriangleMesh& mesh) {
    SoupMesh soup;
    for (const Triangle& face : mesh.faces) {
        const auto corners = corners_of(mesh, face);
        if (to_cgal<Kernel>(corners).is_degenerate()) continue;
        soup.add_face(soup.add_vertex(to_cgal<Kernel>(corners[0])),
                      soup.add_vertex(to_cgal<Kernel>(corners[1])),
                      soup.add_vertex(to_cgal<Kernel>(corners[2])));
    }
    return soup;
}

} // namespace

struct ExactJudge::Structure {
    explicit Structure(const TriangleMesh& mesh)
        : soup(soup_of(mesh)), tree(CGAL::faces(soup).begin(), CGAL::faces(soup).end(), soup) {
        tree.build();
        tree.accelerate_distance_queries();
        side_of = std::make_unique<Side>(tree);
    }

    using Side = CGAL::Side_of_triangle_mesh<SoupMesh, Kernel, CGAL::Default, SoupTree>;

    SoupMesh soup;
    SoupTree tree;
    std::unique_ptr<const Side> side_of;
};

ExactJudge::ExactJudge(const TriangleMesh& mesh) : structure_(std::make_unique<const Structure>(mesh)) {}
ExactJudge::ExactJudge(ExactJudge&& other) noexcept = default;
ExactJudge::~ExactJudge() = default;

ExactSide ExactJudge::side(const Vec3d& point) const {
    switch ((*structure_->side_of)(to_cgal<Kernel>(point))) {
    case CGAL::ON_BOUNDED_SIDE:
        return ExactSide::Inside;
    case CGAL::ON_BOUNDARY:
        return ExactSide::OnSurface;
    default:
        return ExactSide::Outside;
    }
}

double ExactJudge::distance(const Vec3d& point) const {
    return std::sqrt(structure_->tree.squared_distance(to_cgal<Kernel>(point)));
}

struct ExactRayCaster::Structure {
    explicit Structure(const std::vector<std::array<Vec3d, 3>>& faces) {
        for (const auto& face : faces) {
            const Kernel::Triangle_3 triangle = to_cgal<Kernel>(face);
            if (!triangle.is_degenerate()) triangles.push_back(triangle);
        }
        tree.rebuild(triangles.begin(), triangles.end());
        tree.build();
    }

    std::vector<Kernel::Triangle_3> touched_by(const Kernel::Ray_3& ray) const {
        std::vector<Primitive::Id> ids;
        tree.all_intersected_primitives(ray, std::back_inserter(ids));
        std::vector<Kernel::Triangle_3> touched;
        for (const auto& id : ids) touched.push_back(*id);
        return touched;
    }

    Triangles triangles;
    Tree tree;
};

namespace {

/// Does the ray from the origin through `through` pass through the triangle's inside?
bool meets_inside(const Kernel::Triangle_3& triangle, const Kernel::Point_3& through) {
    const Kernel::Point_3 origin(CGAL::ORIGIN);
    for (int i = 0; i < 3; ++i)
        if (CGAL::coplanar(origin, through, triangle[i], triangle[i + 1])) return false;
    return true;
}

/// d + (e, e^2, e^3), times e^-3 to make it whole. Edge tests on whole numbers below 2^20 give whole numbers
/// below 2^60, whose cofactors stay below 2^41: with e = 2^-50 each power decides before the next one counts.
ExactKernel::Vector_3 perturbed(const Vec3d& d) {
    const ExactKernel::FT scale(0x1p150);
    return {scale * d.x + 0x1p100, scale * d.y + 0x1p50, scale * d.z + 1};
}

/// Where a line through the origin along `d` meets the triangle, as a multiple of d; nothing where it misses
/// the triangle or only lies in its plane.
std::optional<double> parameter_of(const ExactKernel::Triangle_3& triangle, const ExactKernel::Vector_3& d) {
    const ExactKernel::Ray_3 ray(ExactKernel::Point_3(CGAL::ORIGIN), d);
    const auto met = CGAL::intersection(ray, triangle);
    if (!met) return std::nullopt;
    const auto* point = boost::get<ExactKernel::Point_3>(&*met);
    if (point == nullptr) return std::nullopt;
    const ExactKernel::Vector_3 v(CGAL::ORIGIN, *point);
    return CGAL::to_double(v * d / (d * d));
}

ExactKernel::Triangle_3 to_exact(const Kernel::Triangle_3& triangle) {
    const auto corner = [&](int i) {
        return ExactKernel::Point_3(triangle[i].x(), triangle[i].y(), triangle[i].z());
    };
    return {corner(0), corner(1), corner(2)};
}

} // namespace

ExactRayCaster::ExactRayCaster(const std::vector<std::array<Vec3d, 3>>& faces)
    : structure_(std::make_unique<const Structure>(faces)) {}
ExactRayCaster::~ExactRayCaster() = default;

ExactCrossings ExactRayCaster::cast(const Vec3d& direction) const {
    const auto through = to_cgal<Kernel>(direction);
    // After a small turn the ray still misses the faces that it does not touch now, as their distance is
    // positive.
    const auto touched = structure_->touched_by({Kernel::Point_3(CGAL::ORIGIN), through});
    ExactCrossings result;
    result.generic = std::ranges::all_of(touched, [&](const auto& t) { return meets_inside(t, through); });
    const ExactKernel::Vector_3 d =
        result.generic ? ExactKernel::Vector_3(direction.x, direction.y, direction.z) : perturbed(direction);
    const double scale = result.generic ? 1 : 0x1p150;
    for (const auto& triangle : touched)
        if (const auto parameter = parameter_of(to_exact(triangle), d))
            result.parameters.push_back(*parameter * scale);
    std::ranges::sort(result.parameters);
    return result;
}

// ---- Which faces intersect

namespace {

using Point = Kernel::Point_3;
using Segment = Kernel::Segment_3;

/// CGAL's predicates want triangles with an area and segments with a length.
using Shape = std::variant<Point, Segment, Kernel::Triangle_3>;

/// The convex hull of one to three points.
Shape hull_of(std::vector<Point> points) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() == 1) return points[0];
    if (points.size() == 2 || CGAL::collinear(points[0], points[1], points[2]))
        return Segment(points.front(), points.back());
    return Kernel::Triangle_3(points[0], points[1], points[2]);
}

bool meet(const Shape& a, const Shape& b) {
    return std::visit([](const auto& p, const auto& q) { return CGAL::do_intersect(p, q); }, a, b);
}

Point to_cgal(const Vec3f& p) {
    return {p.x, p.y, p.z};
}

/// A mesh with its vertices as CGAL takes them.
struct Surface {
    explicit Surface(const TriangleMesh& mesh) : faces(mesh.faces) {
        for (const Vec3f& vertex : mesh.vertices) points.push_back(to_cgal(vertex));
    }

    Shape hull(const std::vector<std::uint32_t>& vertices) const {
        std::vector<Point> corners;
        for (const std::uint32_t vertex : vertices) corners.push_back(points[vertex]);
        return hull_of(std::move(corners));
    }

    std::vector<Point> points;
    std::vector<Triangle> faces;
};

using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

std::vector<Box> boxes_of(const Surface& surface) {
    std::vector<Box> boxes;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        CGAL::Bbox_3 box;
        for (const std::uint32_t vertex : surface.faces[face]) box += surface.points[vertex].bbox();
        boxes.emplace_back(box, face);
    }
    return boxes;
}

// ---- Faces of one mesh ----

using Vertices = std::vector<std::uint32_t>; // ascending, each once

Vertices vertices_of(const Triangle& face) {
    Vertices vertices(face.begin(), face.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

Vertices common(const Vertices& a, const Vertices& b) {
    Vertices result;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

Vertices without(const Vertices& a, const Vertices& b) {
    Vertices result;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

/// Two faces with a common edge, both with an area, in one plane and to one side of it.
bool folded_flat(const Surface& surface, std::uint32_t u, std::uint32_t v, std::uint32_t a, std::uint32_t b) {
    const auto& points = surface.points;
    return CGAL::coplanar(points[u], points[v], points[a], points[b]) &&
           CGAL::coplanar_orientation(points[u], points[v], points[a], points[b]) == CGAL::POSITIVE;
}

/// Every corner, edge and face of the one against every one of the other with which it has no vertex in
/// common.
bool parts_meet(const Surface& surface, const Vertices& a, const Vertices& b) {
    const auto part_of = [](const Vertices& all, unsigned mask) {
        Vertices part;
        for (std::size_t i = 0; i < all.size(); ++i)
            if ((mask >> i & 1) != 0) part.push_back(all[i]);
        return part;
    };
    for (unsigned i = 1; i < 1U << a.size(); ++i)
        for (unsigned j = 1; j < 1U << b.size(); ++j) {
            const Vertices p = part_of(a, i), q = part_of(b, j);
            if (common(p, q).empty() && meet(surface.hull(p), surface.hull(q))) return true;
        }
    return false;
}

bool intersect_beyond_shared(const Surface& surface, const Triangle& face_a, const Triangle& face_b) {
    const Vertices a = vertices_of(face_a), b = vertices_of(face_b), shared = common(a, b);
    if (a == b) return true;
    const Shape a_hull = surface.hull(a), b_hull = surface.hull(b);
    if (shared.empty()) return meet(a_hull, b_hull);
    const auto is_triangle = [](const Shape& s) { return std::holds_alternative<Kernel::Triangle_3>(s); };
    if (!is_triangle(a_hull) || !is_triangle(b_hull)) return parts_meet(surface, a, b);
    const Vertices a_own = without(a, shared), b_own = without(b, shared);
    if (shared.size() == 2) return folded_flat(surface, shared[0], shared[1], a_own[0], b_own[0]);
    return meet(surface.hull(a_own), b_hull) || meet(a_hull, surface.hull(b_own));
}

} // namespace

bool triangles_intersect_by_cgal(const std::array<Vec3f, 3>& a, const std::array<Vec3f, 3>& b) {
    return meet(hull_of({to_cgal(a[0]), to_cgal(a[1]), to_cgal(a[2])}),
                hull_of({to_cgal(b[0]), to_cgal(b[1]), to_cgal(b[2])}));
}

std::vector<FacePair> intersecting_pairs_by_cgal(const TriangleMesh& first, const TriangleMesh& second) {
    const Surface a(first), b(second);
    std::vector<Box> a_boxes = boxes_of(a), b_boxes = boxes_of(b);
    std::vector<FacePair> pairs;
    CGAL::box_intersection_d(
        a_boxes.begin(), a_boxes.end(), b_boxes.begin(), b_boxes.end(), [&](const Box& p, const Box& q) {
            if (meet(a.hull(vertices_of(a.faces[p.info()])), b.hull(vertices_of(b.faces[q.info()]))))
                pairs.push_back({p.info(), q.info()});
        });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::vector<FacePair> self_intersecting_pairs_by_cgal(const TriangleMesh& mesh) {
    const Surface surface(mesh);
    std::vector<Box> boxes = boxes_of(surface);
    std::vector<FacePair> pairs;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& p, const Box& q) {
        if (intersect_beyond_shared(surface, surface.faces[p.info()], surface.faces[q.info()]))
            pairs.push_back({std::min(p.info(), q.info()), std::max(p.info(), q.info())});
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

} // namespace echinus::test
