#include "rivals/unshipped/triangle_rivals.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace echinus::rivals {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Triangle_3 triangle_of(const TriangleMesh& mesh, const Triangle& face) {
    const auto corner = [&](std::size_t k) {
        const Vec3f& p = mesh.vertices[face[k]];
        return Kernel::Point_3(p.x, p.y, p.z);
    };
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
