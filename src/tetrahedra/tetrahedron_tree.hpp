#pragma once

#include "geometry/box_tree.hpp"

#include <echinus/tetrahedra.hpp>

#include <array>
#include <cstdint>

namespace echinus {

/// The tetrahedra of a body in a tree of boxes.
class TetrahedronTree {
  public:
    /// @param mesh  valid, with a tetrahedron; must outlive the tree
    explicit TetrahedronTree(const TetrahedralMesh& mesh);

    /// The tetrahedron that holds the point, or else the nearest; of several, the one with the smallest
    /// number.
    std::uint32_t nearest(const Vec3d& point) const;

  private:
    struct Nearest {
        double distance;
        std::uint32_t tetrahedron;
    };

    void search(std::uint32_t node, const Vec3d& point, Nearest& nearest) const;

    const TetrahedralMesh& mesh_;
    BoxTree tree_;
};

/// The point's weights: the volumes of the tetrahedra that it makes with the faces, as shares.
std::array<double, 4> weights_of(const TetrahedralMesh& mesh, const Tetrahedron& tetrahedron,
                                 const Vec3d& point);

} // namespace echinus
