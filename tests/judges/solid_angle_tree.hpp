#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <vector>

namespace echinus::test {

/// The generalised winding number of an open or non-manifold surface, exact up to the rounding of double.
///
/// Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding
/// Numbers" (2013), section 4.2: seen from outside its convex hull, a patch covers the same solid angle as
/// any other surface with its border, so a fan over the border replaces all its faces. Nothing is
/// approximated.
class SolidAngleTree {
  public:
    explicit SolidAngleTree(const TriangleMesh& mesh);

    double winding_number(const Vec3d& point) const;

  private:
    struct Edge {
        std::uint32_t from, to;
        std::int32_t multiplicity;
    };
    /// A patch: order_[first, first + count), or a fan over edges_[first_edge, first_edge + edge_count) from
    /// `apex`.
    struct Node {
        Vec3d low, high;
        std::uint32_t first = 0, count = 0;
        std::uint32_t first_edge = 0, edge_count = 0;
        std::uint32_t apex = 0;
        std::uint32_t second = 0; ///< the children are the next node and this one; 0 for a leaf
    };

    void build(std::uint32_t begin, std::uint32_t end);
    void find_box(Node& node) const;
    void find_border(Node& node);
    std::uint32_t split(const Node& node);
    double solid_angle(std::uint32_t index, const Vec3d& point) const;

    std::vector<Vec3d> vertices_; ///< each position once
    std::vector<Triangle> faces_;
    std::vector<std::uint32_t> order_;
    std::vector<Edge> edges_;
    std::vector<Node> nodes_;
};

} // namespace echinus::test
