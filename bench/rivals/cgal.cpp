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

Kernel::Point_3 to_cgal(const Vec3f& p) {
    return {double{p.x}, double{p.y}, double{p.z}};
}

/// Vertices shared, or, where Surface_mesh refuses a face because the mesh is not manifold, each face with
/// corners of its own: the tree does not look at neighbours.
Mesh to_cgal(const TriangleMesh& mesh) {
    using Vertex = Mesh::Vertex_index;
    Mesh result;
    for (const Vec3f& v : mesh.vertices) result.add_vertex(to_cgal(v));
    for (const Triangle& face : mesh.faces) {
        if (result.add_face(Vertex(face[0]), Vertex(face[1]), Vertex(face[2])) != Mesh::null_face()) continue;
        Mesh soup;
        const auto corner = [&](std::uint32_t v) { return soup.add_vertex(to_cgal(mesh.vertices[v])); };
        for (const Triangle& f : mesh.faces) soup.add_face(corner(f[0]), corner(f[1]), corner(f[2]));
        return soup;
    }
    return result;
}

} // namespace

struct CgalRival::Impl {
    std::size_t heap_before = heap_bytes();
    Mesh mesh;
    Tree tree;
    std::optional<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side;
    std::size_t bytes;

    explicit Impl(const TriangleMesh& mesh_) : mesh(to_cgal(mesh_)) {
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
