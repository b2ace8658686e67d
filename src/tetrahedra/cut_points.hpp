#pragma once

#include "tetrahedra/body_lattice.hpp"

#include <echinus/exact_map.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace echinus {

enum class LatticeSide : std::uint8_t { Outside, Inside, OnSurface };

/// The side of each vertex of a lattice, in one byte each.
using LatticeSides = std::vector<LatticeSide>;

/// Asks the map for the side of every vertex.
/// @param progress  called with the share that is done
LatticeSides find_sides(const ExactMapView& map, const BodyLattice& lattice, unsigned thread_count,
                        const std::function<void(double)>& progress);

/// Where a lattice edge crosses the surface.
struct CutPoint {
    BodyLattice::Vertex vertex; ///< to which the edge belongs
    std::uint8_t edge;          ///< its number in kEdges
    float fraction;             ///< of the edge, from `vertex` on; 0 to 1

    std::uint64_t key() const { return vertex * kEdgeCount + edge; }
};

/// The share of the way from a place outside to one inside at which the surface is crossed, 0 to 1; of
/// several crossings, the first.
using FindEntry = std::function<double(const Vec3d& outside, const Vec3d& inside)>;

/// Asks the map.
double find_entry(const ExactMapView& map, const Vec3d& outside, const Vec3d& inside);

/// The cut points of a lattice, one on each edge between an inside and an outside vertex.
class CutPoints {
  public:
    /// Labelle and Shewchuk 2007, table 1: with these shares of long and short edges, within which a vertex
    /// is moved onto the surface, the least dihedral angle is largest.
    static constexpr double kLongShare = 0.24999, kShortShare = 0.41189;

    /// @param find  called by several threads at once
    CutPoints(const BodyLattice& lattice, const LatticeSides& sides, const FindEntry& find,
              unsigned thread_count);

    std::size_t size() const { return points_.size(); }
    const CutPoint& operator[](std::size_t index) const { return points_[index]; }
    BodyLattice::Vertex far_end(std::size_t index) const;
    Vec3d position(std::size_t index) const;

    /// The cut point on the edge between two neighbours. @pre there is one
    std::size_t between(const BodyLattice::Place& a, const BodyLattice::Place& b) const;

    /// Moves vertices that lie too near to a cut point of theirs onto it, where they are OnSurface and lose
    /// their other cut points (Labelle and Shewchuk 2007, section 3.2): nearer than a share of the edge that
    /// the tetrahedra's angles depend on. Of several, the nearest.
    void warp(LatticeSides& sides);

    /// Where a vertex lies, warped or not.
    Vec3d position_of(const BodyLattice::Place& place) const;

  private:
    struct Warp {
        BodyLattice::Vertex vertex;
        Vec3d position;
    };

    const BodyLattice& lattice_;
    std::vector<CutPoint> points_; ///< ascending by key()
    std::vector<Warp> warps_;      ///< ascending by vertex
};

/// A corner of a tetrahedron before vertices are numbered: a vertex of the lattice, or a cut point.
struct StencilCorner {
    static constexpr std::uint64_t kCutPoint = std::uint64_t{1} << 63U;

    std::uint64_t key; ///< the vertex's number, or the cut point's plus kCutPoint

    bool is_cut_point() const { return (key & kCutPoint) != 0; }
    std::uint64_t number() const { return key & ~kCutPoint; }
};
using StencilTetrahedron = std::array<StencilCorner, 4>;

/// Adds the part of a lattice tetrahedron that the surface leaves inside, by the stencils of Labelle and
/// Shewchuk 2007, figure 3: one to three tetrahedra, positive, where it has a corner inside; none otherwise.
/// Neighbours cut the quadrilateral on their common face along the same diagonal.
/// @param corners  as for_each_tetrahedron_at() gives them
void add_stencil(const BodyLattice& lattice, const LatticeSides& sides, const CutPoints& cuts,
                 const std::array<BodyLattice::Place, 4>& corners, std::vector<StencilTetrahedron>& result);

} // namespace echinus
