// OctahedralGrid for a vector of particles: the same members with the same bits.

#include "distance_map/lanes-inl.hpp"

#include <echinus/distance_map.hpp>

#if defined(ECHINUS_DISTANCE_MAP_OCTAHEDRAL_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_OCTAHEDRAL_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_OCTAHEDRAL_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_OCTAHEDRAL_LANES_INL_HPP
#endif

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

class OctahedralLanes {
  public:
    explicit OctahedralLanes(const DistanceMapView& map)
        : n_(static_cast<std::int32_t>(map.divisions)), width_(2 * n_ + 1),
          n_float_(static_cast<float>(map.divisions)), least_(map.radius * 0x1p-20F) {}

    HWY_INLINE Vectors to_grid(const Vectors& v) const { return v; }
    HWY_INLINE Vectors from_grid(const Vectors& v) const { return v; }

    struct Coordinates {
        Floats along_u, along_v, stretch;
    };

    HWY_INLINE Coordinates coordinates_of(const Vectors& d) const {
        const Floats zero = hn::Zero(kFloat);
        const Floats n = splat(n_float_);
        const Floats ax = hn::Abs(d.x);
        const Floats ay = hn::Abs(d.y);
        const Floats l1 = hn::Add(hn::Add(ax, ay), hn::Abs(d.z));
        const Mask off_centre = hn::Gt(l1, zero);
        const Floats scale = hn::IfThenElseZero(off_centre, hn::Div(n, l1));
        const Floats x = hn::Min(hn::Mul(ax, scale), n);
        const Floats y = hn::Min(hn::Mul(ay, scale), n);
        const Mask below = hn::Lt(d.z, zero);
        const Floats u = choose(below, hn::Sub(n, y), x);
        const Floats v = choose(below, hn::Sub(n, x), y);
        return {hn::Add(n, hn::CopySign(u, d.x)), hn::Add(n, hn::CopySign(v, d.y)),
                choose(off_centre, hn::Div(length(d), l1), splat(1))};
    }

    struct Cell {
        Ints i, j;
        Floats u, v, rest;
        Mask mirrored, beyond;
    };

    /// @param wanted  other lanes get some cell
    HWY_INLINE Cell cell_at(const Coordinates& at, Mask wanted) const {
        const Floats along_u = hn::IfThenElseZero(wanted, at.along_u);
        const Floats along_v = hn::IfThenElseZero(wanted, at.along_v);
        const Ints last = splat_int(2 * n_ - 1);
        const Ints i = hn::Min(hn::ConvertTo(kInt, along_u), last);
        const Ints j = hn::Min(hn::ConvertTo(kInt, along_v), last);
        Cell cell{i,
                  j,
                  hn::Sub(along_u, hn::ConvertTo(kFloat, i)),
                  hn::Sub(along_v, hn::ConvertTo(kFloat, j)),
                  splat(0),
                  wanted,
                  wanted};
        cell.mirrored = hn::Xor(is_right(cell), is_upper(cell));
        cell.rest = hn::Sub(choose(cell.mirrored, cell.u, hn::Sub(splat(1), cell.u)), cell.v);
        cell.beyond = hn::Lt(cell.rest, hn::Zero(kFloat));
        return cell;
    }

    HWY_INLINE std::array<Ints, 4> corners(const Cell& cell) const {
        const Ints first = hn::Add(hn::Mul(cell.j, splat_int(width_)), cell.i);
        const Ints second = hn::Add(first, splat_int(1));
        const Ints third = hn::Add(first, splat_int(width_));
        const Ints fourth = hn::Add(third, splat_int(1));
        return corners_of_cell(cell, {first, second, third, fourth});
    }

    /// Replaces that of the corner which is none of the triangle's: see OctahedralGrid::Cell::doubled().
    static HWY_INLINE std::array<Ints, 4> corners_of_cell(const Cell& cell,
                                                          const std::array<Ints, 4>& values) {
        const Ints other = choose(cell.mirrored, values[0], values[1]);
        const Mask near = hn::Not(cell.beyond);
        return {choose(hn::AndNot(cell.mirrored, cell.beyond), other, values[0]),
                choose(hn::And(cell.mirrored, cell.beyond), other, values[1]),
                choose(hn::And(cell.mirrored, near), other, values[2]),
                choose(hn::AndNot(cell.mirrored, near), other, values[3])};
    }

    struct CornerRows {
        Ints lower, upper;
        Mask exist;
    };
    HWY_INLINE CornerRows corner_rows(const Cell& cell) const {
        const Ints lower = hn::Add(hn::Mul(cell.j, splat_int(width_)), cell.i);
        return {lower, hn::Add(lower, splat_int(width_)), splat_mask(true)};
    }

    HWY_INLINE std::array<Floats, 4> weights(const Cell& cell) const {
        const Floats one = splat(1);
        const Floats u = choose(cell.mirrored, hn::Sub(one, cell.u), cell.u);
        const Floats w0 = hn::IfThenElseZero(hn::Not(cell.beyond), cell.rest);
        const Floats w1 = choose(cell.beyond, hn::Sub(one, cell.v), u);
        const Floats w2 = choose(cell.beyond, hn::Sub(one, u), cell.v);
        const Floats w3 = hn::IfThenElseZero(cell.beyond, hn::Neg(cell.rest));
        return unmirrored(cell, {w0, w1, w2, w3});
    }

    HWY_INLINE Ints of_reference(const Cell& cell, const std::array<Ints, 4>& values) const {
        const std::array<Floats, 4> w = weights(cell);
        Floats best = w[0];
        Ints chosen = values[0];
        for (std::size_t corner = 1; corner < 4; ++corner) {
            const Mask heavier = hn::Gt(w[corner], best);
            best = choose(heavier, w[corner], best);
            chosen = choose(heavier, values[corner], chosen);
        }
        return chosen;
    }

    struct Derivatives {
        std::array<Floats, 4> along_u, along_v;
    };
    HWY_INLINE Derivatives weight_derivatives(const Cell& cell) const {
        const Floats near = hn::IfThenElseZero(hn::Not(cell.beyond), splat(1));
        const Floats far = hn::Sub(splat(1), near);
        const Floats minus_near = hn::Neg(near);
        const Floats minus_far = hn::Neg(far);
        const std::array<Floats, 4> v = unmirrored(cell, {minus_near, minus_far, near, far});
        const std::array<Floats, 4> u = unmirrored(cell, {minus_near, near, minus_far, far});
        return {{sign_of_mirror(cell, u[0]), sign_of_mirror(cell, u[1]), sign_of_mirror(cell, u[2]),
                 sign_of_mirror(cell, u[3])},
                v};
    }

    HWY_INLINE Floats interpolant(Floats entry) const {
        return hn::Div(splat(1), hn::Max(entry, splat(least_)));
    }
    static HWY_INLINE Floats distance_of(Floats interpolated, const Coordinates& at) {
        return hn::Div(at.stretch, interpolated);
    }

    HWY_INLINE Vectors surface_gradient(const Vectors&, const Cell& cell, Floats distance, Floats value,
                                        Floats slope_u, Floats slope_v) const {
        const Floats n = splat(n_float_);
        const Ints from_middle_i = hn::Sub(cell.i, splat_int(n_));
        const Ints from_middle_j = hn::Sub(cell.j, splat_int(n_));
        const Floats x = hn::Add(hn::ConvertTo(kFloat, from_middle_i), cell.u);
        const Floats y = hn::Add(hn::ConvertTo(kFloat, from_middle_j), cell.v);
        const Mask right = is_right(cell);
        const Mask upper = is_upper(cell);
        const Floats sign_x = choose(right, splat(1), splat(-1));
        const Floats sign_y = choose(upper, splat(1), splat(-1));
        const Ints minus_one = splat_int(-1);
        const Ints across = hn::Add(choose(right, from_middle_i, hn::Sub(minus_one, from_middle_i)),
                                    choose(upper, from_middle_j, hn::Sub(minus_one, from_middle_j)));
        const Mask towards_middle = hn::Xor(upper, cell.beyond);
        const Ints far_corner = choose(towards_middle, across, hn::Add(across, splat_int(1)));
        const Mask below = as_mask(hn::Gt(far_corner, splat_int(n_ - 1)));
        const Floats at_middle = hn::Sub(hn::Sub(value, hn::Mul(slope_u, x)), hn::Mul(slope_v, y));
        const Floats slopes = hn::Add(hn::Mul(sign_x, slope_u), hn::Mul(sign_y, slope_v));
        const Vectors m{hn::Add(hn::Mul(sign_x, at_middle), hn::Mul(n, slope_u)),
                        hn::Add(hn::Mul(sign_y, at_middle), hn::Mul(n, slope_v)),
                        choose(below, hn::Neg(hn::Add(at_middle, hn::Mul(n, slopes))), at_middle)};
        return scaled(m, distance);
    }

  private:
    HWY_INLINE Mask is_right(const Cell& cell) const { return as_mask(hn::Gt(cell.i, splat_int(n_ - 1))); }
    HWY_INLINE Mask is_upper(const Cell& cell) const { return as_mask(hn::Gt(cell.j, splat_int(n_ - 1))); }

    static HWY_INLINE std::array<Floats, 4> unmirrored(const Cell& cell, const std::array<Floats, 4>& w) {
        return {choose(cell.mirrored, w[1], w[0]), choose(cell.mirrored, w[0], w[1]),
                choose(cell.mirrored, w[3], w[2]), choose(cell.mirrored, w[2], w[3])};
    }
    static HWY_INLINE Floats sign_of_mirror(const Cell& cell, Floats value) {
        return choose(cell.mirrored, hn::Neg(value), value);
    }

    std::int32_t n_, width_;
    float n_float_, least_;
};

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
