// BilinearGrid for a vector of particles: the same members with the same bits.

#include "distance_map/query/lanes-inl.hpp"

#if defined(ECHINUS_DISTANCE_MAP_BILINEAR_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_BILINEAR_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_BILINEAR_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_BILINEAR_LANES_INL_HPP
#endif

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

class BilinearLanes {
  public:
    struct Place {
        FloatLanes u, v;
    };

    /// Where both corners of each row are neighbours in the arrays.
    struct CornerRows {
        IntLanes lower, upper; ///< the directions (0, 0) and (0, 1)
        FloatMask exist;
    };
    /// Values of the corners of the rows as corners(cell) of a grid orders them.
    static HWY_INLINE std::array<IntLanes, 4> corners_of_cell(const Place&,
                                                              const std::array<IntLanes, 4>& values) {
        return values;
    }

    static HWY_INLINE std::array<FloatLanes, 4> weights(const Place& at) {
        const FloatLanes left = hn::Sub(splat(1), at.u);
        const FloatLanes low = hn::Sub(splat(1), at.v);
        return {hn::Mul(left, low), hn::Mul(at.u, low), hn::Mul(left, at.v), hn::Mul(at.u, at.v)};
    }
    static HWY_INLINE IntLanes of_reference(const Place& at, const std::array<IntLanes, 4>& values) {
        const FloatMask right = hn::Gt(at.u, splat(0.5F));
        const FloatMask high = hn::Gt(at.v, splat(0.5F));
        return choose(high, choose(right, values[3], values[2]), choose(right, values[1], values[0]));
    }

    struct Derivatives {
        std::array<FloatLanes, 4> along_u, along_v;
    };
    static HWY_INLINE Derivatives weight_derivatives(const Place& at) {
        const FloatLanes one = splat(1);
        return {{hn::Sub(at.v, one), hn::Sub(one, at.v), hn::Neg(at.v), at.v},
                {hn::Sub(at.u, one), hn::Neg(at.u), hn::Sub(one, at.u), at.u}};
    }

    static HWY_INLINE FloatLanes interpolant(FloatLanes entry) { return entry; }
    template <typename Coordinates>
    static HWY_INLINE FloatLanes distance_of(FloatLanes interpolated, const Coordinates&) {
        return interpolated;
    }
};

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
