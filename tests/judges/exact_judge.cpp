#include "judges/exact_judge.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

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

} // namespace echinus::test
