// Places of particles that constraints move, one by one or as lanes. One text for both, hence the same bits.
// Compiled once for each instruction set.

#include "simulation/particles.hpp"

#include <cstdint>

#if defined(ECHINUS_PLACES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_PLACES_INL
#undef ECHINUS_PLACES_INL
#else
#define ECHINUS_PLACES_INL
#endif

#include "simd/lanes-inl.hpp"
#include "simulation/gathered_points-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// @tparam PointType  Vec3f or PointLanes
template <typename PointType>
struct RoundedPlace {
    PointType position;

    HWY_INLINE PointType from(const RoundedPlace& other) const { return position - other.position; }
    HWY_INLINE PointType from(const PointType& point) const { return position - point; }
    HWY_INLINE void move(const PointType& way) { position = position + way; }
};

/// A position and what rounding took off it: the place is the sum of both (Kahan 1965). In small steps a
/// correction is little more than a position's last digit.
template <typename PointType>
struct CompensatedPlace {
    PointType position, remainder;

    HWY_INLINE PointType from(const CompensatedPlace& other) const {
        return (position - other.position) + (remainder - other.remainder);
    }
    HWY_INLINE PointType from(const PointType& point) const { return (position - point) + remainder; }
    HWY_INLINE void move(const PointType& way) {
        const PointType whole = way + remainder;
        const PointType next = position + whole;
        remainder = whole - (next - position);
        position = next;
    }
};

template <typename Mask, typename PointType>
HWY_INLINE RoundedPlace<PointType> choose(const Mask& mask, const RoundedPlace<PointType>& yes,
                                          const RoundedPlace<PointType>& no) {
    return {choose(mask, yes.position, no.position)};
}
template <typename Mask, typename PointType>
HWY_INLINE CompensatedPlace<PointType> choose(const Mask& mask, const CompensatedPlace<PointType>& yes,
                                              const CompensatedPlace<PointType>& no) {
    return {choose(mask, yes.position, no.position), choose(mask, yes.remainder, no.remainder)};
}

// Where particles stand in their arrays.

struct OneParticle {
    using Point = Vec3f;
    std::size_t i;

    HWY_INLINE Vec3f load(const PointArrays& from) const { return from[i]; }
    HWY_INLINE void store(const Vec3f& point, PointArrays& to) const { to.set(i, point); }
};

/// @pre the particles are different ones
struct GatheredParticles {
    using Point = PointLanes;
    IntLanes at;

    HWY_INLINE PointLanes load(const PointArrays& from) const { return gather(from, at); }
    HWY_INLINE void store(const PointLanes& points, PointArrays& to) const { scatter(points, to, at); }
};

// All places of the particles.

struct RoundedPlaces {
    template <typename Point>
    using Place = RoundedPlace<Point>;
    PointArrays& positions;

    template <typename Where>
    HWY_INLINE Place<typename Where::Point> load(const Where& where) const {
        return {where.load(positions)};
    }
    template <typename Where>
    HWY_INLINE void store(const Place<typename Where::Point>& place, const Where& where) const {
        where.store(place.position, positions);
    }
};

struct CompensatedPlaces {
    template <typename Point>
    using Place = CompensatedPlace<Point>;
    PointArrays& positions;
    PointArrays& remainders;

    template <typename Where>
    HWY_INLINE Place<typename Where::Point> load(const Where& where) const {
        return {where.load(positions), where.load(remainders)};
    }
    template <typename Where>
    HWY_INLINE void store(const Place<typename Where::Point>& place, const Where& where) const {
        where.store(place.position, positions);
        where.store(place.remainder, remainders);
    }
};

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#endif
