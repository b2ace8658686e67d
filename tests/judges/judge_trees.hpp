#pragma once

#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <cstdint>
#include <span>
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

using Corners = std::array<Vec3d, 3>;

/// Distance from a point to a triangle, which may have no area. In double, independent of Echinus' code.
double distance_to(const Corners& face, const Vec3d& point);

/// Distances to the nearest point of a surface without its faces with two coinciding corners, by branch and
/// bound over a tree of boxes, in double. CGAL's own tree gives the same (a test compares them) in ten times
/// the time.
class DistanceTree {
  public:
    /// @pre a face has three different corners
    explicit DistanceTree(std::vector<Corners> faces);

    /// @param hint  any face; a near one is faster
    double distance(const Vec3d& point, std::uint32_t hint = 0) const;

    const Corners& face(std::uint32_t number) const { return faces_[number]; }
    std::size_t face_count() const { return faces_.size(); }

  private:
    static constexpr std::uint32_t kLeafSize = 4;

    struct Box {
        Vec3d low, high;
    };
    /// An inner node's children are the next node and `second`; a leaf's faces are order_[first, first +
    /// count).
    struct Node {
        Box box;
        std::uint32_t second = 0;
        std::uint32_t first = 0, count = 0;
    };

    void build(std::uint32_t begin, std::uint32_t end);
    Box box_of(std::span<const std::uint32_t> numbers) const;
    static double distance_sq(const Box& box, const Vec3d& point);

    std::vector<Corners> faces_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace echinus::test
