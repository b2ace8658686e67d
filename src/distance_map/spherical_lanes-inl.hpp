// SphericalGrid for a vector of particles: the same members with the same bits.

#include "distance_map/lanes-inl.hpp"

#include <echinus/distance_map.hpp>

#if defined(ECHINUS_DISTANCE_MAP_SPHERICAL_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_SPHERICAL_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_SPHERICAL_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_SPHERICAL_LANES_INL_HPP
#endif

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

class SphericalLanes {
  public:
    explicit SphericalLanes(const DistanceMapView& map)
        : pole_axis_(map.pole_axis), columns_(static_cast<std::int32_t>(map.longitude_count)),
          rows_(static_cast<std::int32_t>(map.colatitude_count)),
          per_phi_(static_cast<float>(map.longitude_count) / (2 * kPi)),
          per_theta_(static_cast<float>(map.colatitude_count) / kPi) {}

    HWY_INLINE Vectors to_grid(const Vectors& v) const {
        switch (pole_axis_) {
        case PoleAxis::X:
            return {v.y, v.z, v.x};
        case PoleAxis::Y:
            return {v.z, v.x, v.y};
        default:
            return v;
        }
    }
    HWY_INLINE Vectors from_grid(const Vectors& v) const {
        switch (pole_axis_) {
        case PoleAxis::X:
            return {v.z, v.x, v.y};
        case PoleAxis::Y:
            return {v.y, v.z, v.x};
        default:
            return v;
        }
    }

    struct Coordinates {
        Floats along_phi, along_theta;
    };

    HWY_INLINE Coordinates coordinates_of(const Vectors& d_grid) const {
        const Floats horizontal = hn::Sqrt(hn::Add(hn::Mul(d_grid.x, d_grid.x), hn::Mul(d_grid.y, d_grid.y)));
        const Floats phi = angle_of(d_grid.y, d_grid.x);
        const Floats theta = angle_of(horizontal, d_grid.z);
        return {hn::Mul(phi, splat(per_phi_)), hn::Sub(hn::Mul(theta, splat(per_theta_)), splat(0.5F))};
    }

    struct Cell {
        Ints i, j; ///< its corner (0, 0); j is -1 or the last row beyond a pole
        Floats u, v;
    };

    /// @param wanted  other lanes get some cell
    HWY_INLINE Cell cell_at(const Coordinates& at, Mask wanted) const {
        const Floats along_phi = hn::IfThenElseZero(wanted, at.along_phi);
        const Floats along_theta = hn::IfThenElseZero(wanted, at.along_theta);
        const Ints phi_floor = floor_to_int(along_phi);
        const Ints j = floor_to_int(along_theta);
        const Mask negative = as_mask(hn::Lt(phi_floor, hn::Zero(kInt)));
        return {choose(negative, hn::Add(phi_floor, splat_int(columns_)), phi_floor), j,
                hn::Sub(along_phi, hn::ConvertTo(kFloat, phi_floor)),
                hn::Sub(along_theta, hn::ConvertTo(kFloat, j))};
    }

    HWY_INLINE std::array<Ints, 4> corners(const Cell& cell) const {
        const Ints next = hn::Add(cell.i, splat_int(1));
        const Ints next_i = choose(as_mask(hn::Eq(next, splat_int(columns_))), hn::Zero(kInt), next);
        const Ints next_j = hn::Add(cell.j, splat_int(1));
        return {corner(cell.i, cell.j), corner(next_i, cell.j), corner(cell.i, next_j),
                corner(next_i, next_j)};
    }

    /// Where both corners of each row are neighbours in the arrays: everywhere but at the seam and the poles.
    struct CornerRows {
        Ints lower, upper; ///< the directions (0, 0) and (0, 1)
        Mask exist;
    };
    HWY_INLINE CornerRows corner_rows(const Cell& cell) const {
        const Ints lower = hn::Add(hn::Mul(cell.j, splat_int(columns_)), cell.i);
        const IntMask beyond_pole =
            hn::Or(hn::Lt(cell.j, hn::Zero(kInt)), hn::Gt(cell.j, splat_int(rows_ - 2)));
        const IntMask on_seam = hn::Gt(cell.i, splat_int(columns_ - 2));
        return {lower, hn::Add(lower, splat_int(columns_)), none_of(as_mask(hn::Or(beyond_pole, on_seam)))};
    }

    /// Values of the corners of the rows as corners(cell) orders them.
    static HWY_INLINE std::array<Ints, 4> corners_of_cell(const Cell&, const std::array<Ints, 4>& values) {
        return values;
    }

    HWY_INLINE std::array<Floats, 4> weights(const Cell& cell) const {
        const Floats left = hn::Sub(splat(1), cell.u);
        const Floats low = hn::Sub(splat(1), cell.v);
        return {hn::Mul(left, low), hn::Mul(cell.u, low), hn::Mul(left, cell.v), hn::Mul(cell.u, cell.v)};
    }

    HWY_INLINE Ints of_reference(const Cell& cell, const std::array<Ints, 4>& values) const {
        const Mask right = hn::Gt(cell.u, splat(0.5F));
        const Mask high = hn::Gt(cell.v, splat(0.5F));
        return choose(high, choose(right, values[3], values[2]), choose(right, values[1], values[0]));
    }

    struct Derivatives {
        std::array<Floats, 4> along_u, along_v;
    };
    HWY_INLINE Derivatives weight_derivatives(const Cell& cell) const {
        const Floats one = splat(1);
        return {{hn::Sub(cell.v, one), hn::Sub(one, cell.v), hn::Neg(cell.v), cell.v},
                {hn::Sub(cell.u, one), hn::Neg(cell.u), hn::Sub(one, cell.u), cell.u}};
    }

    static HWY_INLINE Floats interpolant(Floats entry) { return entry; }
    static HWY_INLINE Floats distance_of(Floats interpolated, const Coordinates&) { return interpolated; }

    HWY_INLINE Vectors surface_gradient(const Vectors& e_r, const Cell&, Floats distance, Floats,
                                        Floats slope_u, Floats slope_v) const {
        const Floats zero = hn::Zero(kFloat);
        const Floats sine = hn::Sqrt(hn::Add(hn::Mul(e_r.x, e_r.x), hn::Mul(e_r.y, e_r.y)));
        const Mask has_angles = hn::And(hn::Gt(sine, zero), hn::Gt(distance, zero));
        const Vectors e_phi{hn::Div(hn::Neg(e_r.y), sine), hn::Div(e_r.x, sine), zero};
        const Vectors e_theta{hn::Sub(hn::Mul(e_phi.y, e_r.z), hn::Mul(e_phi.z, e_r.y)),
                              hn::Sub(hn::Mul(e_phi.z, e_r.x), hn::Mul(e_phi.x, e_r.z)),
                              hn::Sub(hn::Mul(e_phi.x, e_r.y), hn::Mul(e_phi.y, e_r.x))};
        const Floats along_theta = hn::Div(hn::Mul(slope_v, splat(per_theta_)), distance);
        const Floats along_phi = hn::Div(hn::Mul(slope_u, splat(per_phi_)), hn::Mul(distance, sine));
        const Vectors theta_part = scaled(e_theta, along_theta);
        const Vectors phi_part = scaled(e_phi, along_phi);
        const Vectors gradient{hn::Sub(hn::Sub(e_r.x, theta_part.x), phi_part.x),
                               hn::Sub(hn::Sub(e_r.y, theta_part.y), phi_part.y),
                               hn::Sub(hn::Sub(e_r.z, theta_part.z), phi_part.z)};
        return choose(has_angles, gradient, e_r);
    }

  private:
    HWY_INLINE Ints corner(Ints i, Ints j) const {
        const std::int32_t half = columns_ / 2;
        const Mask below = as_mask(hn::Lt(j, hn::Zero(kInt)));
        const Mask beyond = as_mask(hn::Gt(j, splat_int(rows_ - 1)));
        const Mask near_half = as_mask(hn::Lt(i, splat_int(half)));
        Ints opposite = choose(near_half, hn::Add(i, splat_int(half)), hn::Sub(i, splat_int(half)));
        opposite = hn::IfThenElseZero(hn::Lt(opposite, splat_int(columns_)), opposite);
        const Ints column = choose(hn::Or(below, beyond), opposite, i);
        const Ints row = choose(below, hn::Zero(kInt), choose(beyond, splat_int(rows_ - 1), j));
        return hn::Add(hn::Mul(row, splat_int(columns_)), column);
    }

    PoleAxis pole_axis_;
    std::int32_t columns_, rows_;
    float per_phi_, per_theta_;
};

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
