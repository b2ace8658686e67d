#pragma once

#include <echinus/directions.hpp>
#include <echinus/geometry.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace echinus {

/// Rotates coordinates cyclically so that the one along `axis` becomes the last; the bits stay the same.
template <typename T>
Vec3<T> turned_last(PoleAxis axis, const Vec3<T>& v) {
    switch (axis) {
    case PoleAxis::X:
        return {v.y, v.z, v.x};
    case PoleAxis::Y:
        return {v.z, v.x, v.y};
    default:
        return v;
    }
}

/// The inverse of turned_last(): the rotations for X and Y are inverse to each other.
template <typename T>
Vec3<T> turned_back(PoleAxis axis, const Vec3<T>& v) {
    if (axis == PoleAxis::Z) return v;
    return turned_last(axis == PoleAxis::X ? PoleAxis::Y : PoleAxis::X, v);
}

/// The common base of grids of squares: distances are interpolated bilinearly between the four samples around
/// a direction.
class BilinearGrid {
  public:
    /// The four samples around a direction, and its position between them.
    struct Cell {
        std::array<std::uint32_t, 4> corners; ///< (0,0), (1,0), (0,1), (1,1), the first number along u
        float u, v;                           ///< in [0, 1]
    };

    /// The weights of the four corners.
    static std::array<float, 4> weights(const Cell& cell) {
        return {(1 - cell.u) * (1 - cell.v), cell.u * (1 - cell.v), (1 - cell.u) * cell.v, cell.u * cell.v};
    }
    /// "the sample which is closer to (phi_d, theta_d) as the reference sample" (section 2.2): distances
    /// along u and v in cells.
    static std::size_t reference_corner(const Cell& cell) {
        return (cell.u > 0.5F ? 1U : 0U) + (cell.v > 0.5F ? 2U : 0U);
    }
    /// Interpolation uses all four corners.
    static bool is_sample(const Cell&, std::size_t) { return true; }

    struct Derivatives {
        std::array<float, 4> along_u, along_v;
    };
    static Derivatives weight_derivatives(const Cell& cell) {
        return {{cell.v - 1, 1 - cell.v, -cell.v, cell.v}, {cell.u - 1, -cell.u, 1 - cell.u, cell.u}};
    }

    static double radial_norm(const Vec3d& d) { return length(d); }
    /// The largest entry of a map whose bounding sphere has this radius.
    static float largest_entry(float radius) { return radius; }

    // The interpolated quantity is the distance.
    static float interpolant(float entry, float) { return entry; }
    static float interpolant_at(const Vec3d& d) { return static_cast<float>(length(d)); }
    template <typename Coordinates>
    static float distance_of(float interpolated, const Coordinates&) {
        return interpolated;
    }
    static bool is_farther(float interpolant, float other) { return interpolant > other; }
    /// An entry whose interpolant was moved by `shift`.
    static float moved(float entry, float shift, bool outward) {
        return outward ? entry + shift : entry - shift;
    }
};

} // namespace echinus
