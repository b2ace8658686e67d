#pragma once

#include "mesh/box_tree.hpp"

#include <echinus/tetrahedra.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// A tree of boxes over the tetrahedra of a body, split at the median of their centres along the longest
/// side.
class TetrahedronTree {
  public:
    /// @param mesh  valid; must outlive the tree
    explicit TetrahedronTree(const TetrahedralMesh& mesh);

    /// The tetrahedron that holds the point, or else the nearest; of several, the one with the smallest
    /// number.
    std::uint32_t nearest(const Vec3d& point) const;

  private:
    static constexpr std::size_t kLeafSize = 4;

    struct Node {
        FaceBox box;
        std::uint32_t begin, end; ///< of order_
        std::uint32_t right;      ///< the left child is the next node
    };
    struct Nearest {
        double distance_sq;
        std::uint32_t tetrahedron;
    };

    FaceBox box_of(std::uint32_t tetrahedron) const;
    void build(std::uint32_t begin, std::uint32_t end);
    void search(std::uint32_t node, const Vec3d& point, Nearest& nearest) const;

    const TetrahedralMesh& mesh_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

/// The point's weights: the volumes of the tetrahedra that it makes with the faces, as shares.
std::array<double, 4> weights_of(const TetrahedralMesh& mesh, const Tetrahedron& tetrahedron,
                                 const Vec3d& point);

} // namespace echinus
