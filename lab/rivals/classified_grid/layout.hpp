#pragma once

#include "directions/lattice.hpp"

#include <echinus/contact.hpp>
#include <echinus/exact_map.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// The arrays of a classified grid, and the search for a particle's cell.
namespace echinus::rivals {

using CellPlace = Vec3<std::int32_t>; ///< a cell by its column, row and layer

/// Two bits per cell: kOnSurface, and whether the cell, or the centre of one on the surface, is inside.
enum CellState : std::uint32_t { kInsideBit = 1, kSurfaceBit = 2 };

/// A cube of 4 x 4 x 4 cells. Cell x + 4 y of layer z has bits 2 (x + 4 y) of states[z].
struct Brick {
    static constexpr std::int32_t kEdge = 4;

    std::array<std::uint32_t, 4> states{};
    /// The lists of its cells on the surface are list_begins[first_list] and the following, by layer, row and
    /// column, then one number that ends the last.
    std::uint32_t first_list = 0;
    std::uint32_t first_reference = 0; ///< what list_begins count from
};
static_assert(sizeof(Brick) == 24);

/// Number of a cell in its brick.
inline std::uint32_t cell_in_brick(const CellPlace& cell) {
    return static_cast<std::uint32_t>((cell.x & 3) | (cell.y & 3) << 2 | (cell.z & 3) << 4);
}

inline std::uint32_t state_of(const Brick& brick, std::uint32_t cell) {
    return brick.states[cell >> 4] >> (2 * (cell & 15)) & 3;
}

/// How many cells on the surface come before this one in its brick.
inline std::uint32_t rank_in_brick(const Brick& brick, std::uint32_t cell) {
    constexpr std::uint64_t kSurfaceBits = 0xAAAA'AAAA'AAAA'AAAA;
    const std::uint64_t low = (brick.states[0] | std::uint64_t{brick.states[1]} << 32) & kSurfaceBits;
    const std::uint64_t high = (brick.states[2] | std::uint64_t{brick.states[3]} << 32) & kSurfaceBits;
    // Without a branch: which half a particle is in cannot be predicted.
    const std::uint64_t below = (std::uint64_t{1} << (2 * (cell & 31))) - 1;
    const std::uint64_t in_high = ~std::uint64_t{0} * (cell >> 5);
    const std::uint64_t before_low = low & (below | in_high);
    const std::uint64_t before_high = high & below & in_high;
    return static_cast<std::uint32_t>(std::popcount(before_low) + std::popcount(before_high));
}

/// A lattice point in 8 bytes: 21 bits per coordinate.
struct PackedPoint {
    std::uint32_t low, high; ///< x, 21 bits, and the lower 11 of y; the upper 10 of y, and z
};

inline PackedPoint packed(const LatticePoint& p) {
    const auto x = static_cast<std::uint32_t>(p.x), y = static_cast<std::uint32_t>(p.y),
               z = static_cast<std::uint32_t>(p.z);
    return {(x & 0x1F'FFFF) | y << 21, (y >> 11 & 0x3FF) | z << 11};
}

inline Vec3<std::int32_t> unpacked(const PackedPoint& p) {
    const auto signed_of = [](std::uint32_t bits) { return static_cast<std::int32_t>(bits); };
    return {signed_of(p.low << 11) >> 11,
            signed_of(p.high << 22) >> 11 | static_cast<std::int32_t>(p.low >> 21), signed_of(p.high) >> 11};
}

/// Indices in 16 bits where they fit; one of the two is empty.
struct Indices {
    std::vector<std::uint16_t> narrow;
    std::vector<std::uint32_t> wide;

    std::size_t size() const { return narrow.size() + wide.size(); }
    std::size_t size_bytes() const {
        return narrow.size() * sizeof(std::uint16_t) + wide.size() * sizeof(std::uint32_t);
    }
    std::uint32_t operator[](std::size_t i) const { return wide.empty() ? narrow[i] : wide[i]; }
};

/// Where the cells lie. Cell (i, j, k) holds the lattice points from origin + cell_steps (i, j, k) on.
struct GridFrame {
    /// The largest error of a lookup: rounded floats find a cell within 0.4 steps, snapping moves a particle
    /// by 0.5, and the perturbation by less than any step. Faces are listed as if cells were wider by this
    /// number.
    static constexpr std::int32_t kSlack = 2;

    LatticeFrame lattice;
    Vec3f centre; ///< of the lattice
    Vec3<std::int32_t> origin;
    std::int32_t cell_steps = 0;
    std::array<std::int32_t, 3> cell_counts{}, brick_counts{};
    Vec3f cell_limits; ///< cell_counts as floats
    float cells_per_unit = 0;
    Vec3f shift; ///< of the origin against the centre, in cells

    /// In cells from the origin. The kernels round as this does: no fused multiply-add.
    Vec3f in_cells(const Vec3f& point_local) const {
        const Vec3f d = point_local - centre;
        return {d.x * cells_per_unit + shift.x, d.y * cells_per_unit + shift.y,
                d.z * cells_per_unit + shift.z};
    }
    /// False for NaN.
    bool is_within(const Vec3f& g) const {
        return (g.x >= 0) & (g.x < cell_limits.x) & (g.y >= 0) & (g.y < cell_limits.y) & (g.z >= 0) &
               (g.z < cell_limits.z);
    }
    std::size_t brick_count() const {
        return std::size_t(brick_counts[0]) * std::size_t(brick_counts[1]) * std::size_t(brick_counts[2]);
    }
    std::size_t brick_at(const CellPlace& brick) const {
        return (std::size_t(brick.z) * std::size_t(brick_counts[1]) + std::size_t(brick.y)) *
                   std::size_t(brick_counts[0]) +
               std::size_t(brick.x);
    }
    /// The reference point of a cell.
    Vec3<std::int32_t> centre_of(const CellPlace& cell) const {
        const std::int32_t half = cell_steps / 2;
        return {origin.x + cell.x * cell_steps + half, origin.y + cell.y * cell_steps + half,
                origin.z + cell.z * cell_steps + half};
    }
};

inline CellPlace cell_at(const Vec3f& in_cells) {
    return {static_cast<std::int32_t>(in_cells.x), static_cast<std::int32_t>(in_cells.y),
            static_cast<std::int32_t>(in_cells.z)};
}
inline CellPlace brick_of(const CellPlace& cell) {
    return {cell.x >> 2, cell.y >> 2, cell.z >> 2};
}

struct GridArrays {
    static constexpr std::uint32_t kOutside = 0, kInside = 1; ///< bricks that stand for all without surface

    GridFrame frame;
    Indices brick_numbers; ///< [brick_count + 1] by layer, row, column; the last is there to be read beyond
    std::vector<Brick> bricks;
    std::vector<std::uint16_t> list_begins; ///< as Brick says
    /// Winding number of each list's centre; empty where the inside bit says it: 0 or 1.
    std::vector<std::int16_t> windings;
    Indices references;                ///< faces
    std::vector<PackedPoint> vertices; ///< [vertex_count] as in the mesh
    Indices corners;                   ///< [3 face_count + 1] vertices; the last is there to be read beyond

    std::size_t face_count() const { return corners.size() / 3; }
    std::size_t byte_count() const {
        return brick_numbers.size_bytes() + bricks.size() * sizeof(Brick) +
               list_begins.size() * sizeof(std::uint16_t) + windings.size() * sizeof(std::int16_t) +
               references.size_bytes() + vertices.size() * sizeof(PackedPoint) + corners.size_bytes();
    }
    std::array<LatticePoint, 3> face(std::uint32_t number) const {
        const auto corner = [&](std::size_t k) {
            return LatticePoint(unpacked(vertices[corners[3 * std::size_t{number} + k]]));
        };
        return {corner(0), corner(1), corner(2)};
    }
    const Brick& brick(const CellPlace& cell) const {
        return bricks[brick_numbers[frame.brick_at(brick_of(cell))]];
    }
};

/// A cell on the surface.
struct CellList {
    std::uint32_t number;      ///< of the list
    std::uint32_t first, last; ///< references, half open
};

inline CellList list_of(const GridArrays& grid, const Brick& brick, std::uint32_t cell) {
    const std::uint32_t number = brick.first_list + rank_in_brick(brick, cell);
    return {number, brick.first_reference + grid.list_begins[number],
            brick.first_reference + grid.list_begins[number + 1]};
}

/// Winding number of the centre of a cell on the surface.
inline int winding_of_centre(const GridArrays& grid, std::uint32_t list, std::uint32_t state) {
    return grid.windings.empty() ? static_cast<int>(state & kInsideBit) : grid.windings[list];
}

// The batch queries in vector instructions; simd/dispatch.hpp chooses which.

void contains_kernel(const GridArrays& grid, std::span<const Vec3f> points_local,
                     std::span<std::uint8_t> inside);

void contacts_kernel(const GridArrays& grid, std::span<const Vec3f> points_local, float margin,
                     std::span<Contact> contacts);

} // namespace echinus::rivals
