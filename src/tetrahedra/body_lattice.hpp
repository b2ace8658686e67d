#pragma once

#include <echinus/geometry.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace echinus {

/// The body-centred cubic lattice: the corners of cubes (level 0) and their centres (level 1). Neighbours
/// along an axis are joined by a *long* edge, a corner and a centre of one cube by a *short* one. Two long
/// edges that cross at right angles, half an edge apart, and the four short edges between them make a
/// tetrahedron.
class BodyLattice {
  public:
    using Vertex = std::uint64_t;

    /// A vertex in half edges from the lattice's first one; all three are even, or all are odd.
    using Place = Vec3<std::int64_t>;

    /// A lattice around a box: the vertices of its hull are farther from the box than half an edge.
    BodyLattice(const Vec3d& low, const Vec3d& high, double size);

    /// How many vertices such a lattice would have, which may be too many to number.
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
    /// Of cubes along each axis. Twice their product is at most TetrahedralizeOptions::kMaxLatticeVertices,
    /// as whoever makes a lattice sees to.
    std::array<std::uint64_t, 3> counts_;
};

/// Eleven edges belong to each vertex, so that every edge belongs to one: the long ones to the next vertex
/// along each axis, and from a vertex of level 0 the short ones to its eight neighbours.
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

/// Calls visit(the four places of a tetrahedron, positive) for each that belongs to a vertex of level 0:
/// those around its three long edges. Their first two places, and their last two, are the ends of a long
/// edge.
template <typename Visit>
void for_each_tetrahedron_at(const BodyLattice::Place& vertex, Visit&& visit) {
    // The four centres around a long edge, counter-clockwise seen against its axis, in half edges.
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

} // namespace echinus
