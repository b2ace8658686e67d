#include "rivals/cgal.hpp"

#include "common/heap.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <optional>

using namespace echinus;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;

/// Each face with corners of its own, since Surface_mesh refuses what is not manifold and the tree does not
/// look at neighbours.
Mesh soup_of(const TriangleMesh& mesh) {
    Mesh soup;
    const auto vertex = [&](std::uint32_t i) {
        const Vec3d p(mesh.vertices[i]);
        return soup.add_vertex({p.x, p.y, p.z});
    };
    for (const Triangle& face : mesh.faces) soup.add_face(vertex(face[0]), vertex(face[1]), vertex(face[2]));
    return soup;
}

Kernel::Point_3 to_cgal(const Vec3f& p) {
    return {double{p.x}, double{p.y}, double{p.z}};
}

} // namespace

struct CgalRival::Impl {
    std::size_t heap_before = heap_bytes();
    Mesh mesh;
    Tree tree;
    std::optional<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side;
    std::size_t bytes;

    explicit Impl(const TriangleMesh& mesh_) : mesh(soup_of(mesh_)) {
        tree.insert(faces(mesh).first, faces(mesh).second, mesh);
        tree.build();
        tree.accelerate_distance_queries();
        side.emplace(tree);
        bytes = heap_bytes() - heap_before;
    }
};

CgalRival::CgalRival(const TriangleMesh& mesh) : impl_(std::make_unique<const Impl>(mesh)) {}

CgalRival::~CgalRival() = default;

bool CgalRival::inside(const Vec3f& point) const {
    return (*impl_->side)(to_cgal(point)) == CGAL::ON_BOUNDED_SIDE;
}

Vec3d CgalRival::nearest(const Vec3f& point) const {
    const Kernel::Point_3 p = impl_->tree.closest_point(to_cgal(point));
    return {p.x(), p.y(), p.z()};
}

std::size_t CgalRival::byte_count() const {
    return impl_->bytes;
}
