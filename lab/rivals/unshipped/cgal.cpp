#include "rivals/common/closed_mesh.hpp"
#include "rivals/unshipped/unshipped.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <optional>

namespace echinus::rivals {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using BoxTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;

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

class CgalTree final : public System {
  public:
    explicit CgalTree(const TriangleMesh& mesh) : mesh_(to_cgal(mesh)) {
        tree_.insert(faces(mesh_).first, faces(mesh_).second, mesh_);
        tree_.build();
        tree_.accelerate_distance_queries();
        side_.emplace(tree_);
        bytes_ = heap_bytes() - heap_before_;
    }

    std::string name() const override { return "cgal"; }
    std::size_t byte_count() const override { return bytes_; }
    std::string_view counted() const override { return "what the construction took from the heap"; }

    bool contains(const Vec3f& point) const override {
        return is_finite(point) && (*side_)(to_cgal(point)) == CGAL::ON_BOUNDED_SIDE;
    }

    Contact contact(const Vec3f& point, float margin) const override {
        const bool inside = contains(point);
        if (!is_finite(point) || (!inside && !(margin > 0))) return no_contact(point);
        const Kernel::Point_3 nearest = tree_.closest_point(to_cgal(point));
        const Vec3d out = Vec3d(nearest.x(), nearest.y(), nearest.z()) - Vec3d(point);
        const double distance = length(out);
        if (!inside && distance > double{margin}) return no_contact(point);
        const double depth = inside ? distance : -distance;
        Contact result =
            contact_along(point, static_cast<float>(depth), depth != 0 ? Vec3f(out * (1 / depth)) : Vec3f{});
        result.inside = inside;
        return result;
    }

    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override {
        for (std::size_t i = 0; i < points.size(); ++i) inside[i] = contains(points[i]);
    }
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const override {
        for (std::size_t i = 0; i < points.size(); ++i) contacts[i] = contact(points[i], margin);
    }
    using System::contacts_batch;

  private:
    std::size_t heap_before_ = heap_bytes();
    Mesh mesh_;
    BoxTree tree_;
    std::optional<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side_;
    std::size_t bytes_ = 0;
};

} // namespace

std::unique_ptr<const System> cgal_tree(const TriangleMesh& mesh) {
    require_closed(mesh, "a parity of crossings");
    return std::make_unique<const CgalTree>(mesh);
}

namespace {

using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Triangle_3 triangle_of(const TriangleMesh& mesh, const Triangle& face) {
    const auto corner = [&](std::size_t k) { return to_cgal(mesh.vertices[face[k]]); };
    return {corner(0), corner(1), corner(2)};
}

class CgalTriangles final : public TriangleRival {
  public:
    explicit CgalTriangles(const TriangleMesh& model) {
        for (const Triangle& face : model.faces)
            if (const auto triangle = triangle_of(model, face); !triangle.is_degenerate())
                triangles_.push_back(triangle);
        tree_.insert(triangles_.begin(), triangles_.end());
        tree_.build();
    }

    void find_intersecting(const TriangleMesh& mesh, std::span<std::uint8_t> meets) const override {
        for (std::size_t i = 0; i < mesh.faces.size(); ++i)
            meets[i] = tree_.do_intersect(triangle_of(mesh, mesh.faces[i]));
    }

  private:
    Triangles triangles_;
    Tree tree_;
};

} // namespace

std::unique_ptr<const TriangleRival> cgal_triangles(const TriangleMesh& model) {
    return std::make_unique<const CgalTriangles>(model);
}

} // namespace echinus::rivals
