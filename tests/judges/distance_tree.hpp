#pragma once

#include <echinus/geometry.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus::test {

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
