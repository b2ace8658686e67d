// Particles in any order as lanes. Compiled once for each instruction set.

#include "simulation/particles.hpp"

#include <cstdint>

#if defined(ECHINUS_GATHERED_POINTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_GATHERED_POINTS_INL
#undef ECHINUS_GATHERED_POINTS_INL
#else
#define ECHINUS_GATHERED_POINTS_INL
#endif

#include "simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// @pre there are at most 2^31 particles
HWY_INLINE IntLanes load_indices(const std::uint32_t* from) {
    return hn::BitCast(kInt, hn::LoadU(hn::RebindToUnsigned<Ints>(), from));
}
HWY_INLINE PointLanes gather(const PointArrays& points, IntLanes at) {
    return {hn::GatherIndex(kFloat, points.x.data(), at), hn::GatherIndex(kFloat, points.y.data(), at),
            hn::GatherIndex(kFloat, points.z.data(), at)};
}
/// @pre the particles are different ones
HWY_INLINE void scatter(const PointLanes& points, PointArrays& to, IntLanes at) {
    hn::ScatterIndex(points.x, kFloat, to.x.data(), at);
    hn::ScatterIndex(points.y, kFloat, to.y.data(), at);
    hn::ScatterIndex(points.z, kFloat, to.z.data(), at);
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#endif
