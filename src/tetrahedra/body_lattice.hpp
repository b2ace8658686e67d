#pragma once

#include <echinus/exact_map.hpp>
#include <echinus/geometry.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace echinus {

/// The body-centred cubic lattice: the corners of cubes (level 0) and their centres (level 1). Neighbours
/// along an axis are joined by a *long* edge, and a corner and the centre of a cube by a *short* one. Two
/// long edges that are perpendicular, half an edge apart, and the four short edges between them form a
/// tetrahedron.
class BodyLattice {
  public:
    using Vertex = std::uint64_t;

    /// The position of a vertex in half edges from the first vertex of the lattice; all three are even, or
    /// all odd.
    using Place = Vec3<std::int64_t>;

    /// Makes a lattice around a box: the vertices of its hull are more than half an edge outside the box.
    BodyLattice(const Vec3d& low, const Vec3d& high, double size);

    /// The number of vertices that such a lattice would have, to be checked before it is made.
    static double vertex_count_around(const Vec3d& low, const Vec3d& high, double size);

    double size() const { return size_; }
    std::size_t vertex_count() const { return 2 * counts_[0] * counts_[1] * counts_[2]; }
    std::size_t slab_count() const { return counts_[2]; }
    std::size_t slab_size() const { return 2 * counts_[0] * counts_[1]; }

    Place place_of(Vertex vertex) const {
        const auto level = static_cast<std::int64_t>(vertex % 2);
        Vertex rest = vertex / 2;
        const auto x = static_cast<std::int64_t>(rest % counts_[0]);
        rest /= counts_[0];
        return {2 * x + level, 2 * static_cast<std::int64_t>(rest % counts_[1]) + level,
                2 * static_cast<std::int64_t>(rest / counts_[1]) + level};
    }
    /// @pre contains(place)
    Vertex vertex_at(const Place& place) const {
        const auto index = [](std::int64_t coordinate) { return static_cast<Vertex>(coordinate / 2); };
        return 2 * ((index(place.z) * counts_[1] + index(place.y)) * counts_[0] + index(place.x)) +
               static_cast<Vertex>(place.x % 2);
    }
    bool contains(const Place& place) const {
        const auto within = [](std::int64_t coordinate, std::uint64_t count) {
            return coordinate >= 0 && coordinate < 2 * static_cast<std::int64_t>(count);
        };
        return within(place.x, counts_[0]) && within(place.y, counts_[1]) && within(place.z, counts_[2]);
    }
    Vec3d position(const Place& place) const { return origin_ + Vec3d(place) * (size_ / 2); }
    Vec3d position(Vertex vertex) const { return position(place_of(vertex)); }

  private:
    Vec3d origin_;
    double size_;
    /// The number of cube corners along each axis. Twice their product is at most
    /// TetrahedralizeOptions::kMaxLatticeVertices; the creator of a lattice must ensure this.
    std::array<std::uint64_t, 3> counts_;
};

/// The edges that belong to a vertex. Every edge belongs to exactly one: long edges go to the next vertex
/// along each axis, and short edges from a vertex of level 0 to its eight neighbours.
inline constexpr int kEdgeCount = 11;
inline constexpr int kLongEdgeCount = 3;
inline constexpr std::array<BodyLattice::Place, kEdgeCount> kEdges{{{2, 0, 0},
                                                                    {0, 2, 0},
                                                                    {0, 0, 2},
                                                                    {-1, -1, -1},
                                                                    {1, -1, -1},
                                                                    {-1, 1, -1},
                                                                    {1, 1, -1},
                                                                    {-1, -1, 1},
                                                                    {1, -1, 1},
                                                                    {-1, 1, 1},
                                                                    {1, 1, 1}}};

/// Calls visit(the four positions of a tetrahedron, positively oriented) for each tetrahedron that belongs to
/// a vertex of level 0: those around its three long edges. The first two positions are the ends of a long
/// edge, and so are the last two.
template <typename Visit>
void for_each_tetrahedron_at(const BodyLattice::Place& vertex, Visit&& visit) {
    // The four centres around a long edge, counter-clockwise seen against the direction of its axis, in half
    // edges.
    constexpr std::array<std::array<int, 2>, 4> kRing{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    const std::array<std::int64_t, 3> from{vertex.x, vertex.y, vertex.z};
    const auto place = [](const std::array<std::int64_t, 3>& p) {
        return BodyLattice::Place{p[0], p[1], p[2]};
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<std::int64_t, 3> to = from;
        to[axis] += 2;
        const auto centre = [&](std::size_t corner) {
            std::array<std::int64_t, 3> p = from;
            p[axis] += 1;
            p[(axis + 1) % 3] += kRing[corner % 4][0];
            p[(axis + 2) % 3] += kRing[corner % 4][1];
            return place(p);
        };
        for (std::size_t corner = 0; corner < 4; ++corner)
            visit(std::array<BodyLattice::Place, 4>{vertex, place(to), centre(corner), centre(corner + 1)});
    }
}

enum class LatticeSide : std::uint8_t { Outside, Inside, OnSurface };

/// The side of each vertex of a lattice, in one byte each.
using LatticeSides = std::vector<LatticeSide>;

/// Determines the side of every vertex by queries of the map.
/// @param progress  called with the completed share
LatticeSides find_sides(const ExactMapView& map, const BodyLattice& lattice, unsigned thread_count,
                        const std::function<void(double)>& progress);

/// Where a lattice edge crosses the surface.
struct CutPoint {
    BodyLattice::Vertex vertex; ///< the vertex to which the edge belongs
    std::uint8_t edge;          ///< its number in kEdges
    float fraction;             ///< the fraction of the edge, from `vertex` on; 0 to 1

    std::uint64_t key() const { return vertex * kEdgeCount + edge; }
};

/// The fraction of the segment from an outside point to an inside point at which the surface is crossed, 0 to
/// 1; of several crossings, the first.
using FindEntry = std::function<double(const Vec3d& outside, const Vec3d& inside)>;

/// Finds the entry by a query of the map.
double find_entry(const ExactMapView& map, const Vec3d& outside, const Vec3d& inside);

/// The cut points of a lattice, one on each edge between an inside and an outside vertex.
class CutPoints {
  public:
    /// Table 1 of Labelle and Shewchuk 2007: with these shares of long and short edges, within which a vertex
    /// is moved onto the surface, the least dihedral angle is as large as possible.
    static constexpr double kLongShare = 0.24999, kShortShare = 0.41189;

    /// @param find  called by several threads concurrently
    CutPoints(const BodyLattice& lattice, const LatticeSides& sides, const FindEntry& find,
              unsigned thread_count);

    std::size_t size() const { return points_.size(); }
    const CutPoint& operator[](std::size_t index) const { return points_[index]; }
    BodyLattice::Vertex far_end(std::size_t index) const;
    Vec3d position(std::size_t index) const;

    /// The cut point on the edge between two neighbours. @pre there is one
    std::size_t between(const BodyLattice::Place& a, const BodyLattice::Place& b) const;

    /// Moves vertices that are too close to one of their cut points onto it. They become OnSurface and lose
    /// their other cut points (Labelle and Shewchuk 2007, section 3.2). Too close means nearer than the
    /// shares of edges above, on which the tetrahedra's angles depend. Of several cut points, the nearest is
    /// chosen.
    void warp(LatticeSides& sides);

    /// The position of a vertex, warped or not.
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

/// Adds the part of a lattice tetrahedron that is inside the surface, by the stencils of Labelle and Shewchuk
/// 2007, figure 3: one to three tetrahedra, positively oriented, if a corner is inside, otherwise none.
/// Neighbours divide the quadrilateral on their common face along the same diagonal.
/// @param corners  as for_each_tetrahedron_at() gives them
void add_stencil(const BodyLattice& lattice, const LatticeSides& sides, const CutPoints& cuts,
                 const std::array<BodyLattice::Place, 4>& corners, std::vector<StencilTetrahedron>& result);

} // namespace echinus
