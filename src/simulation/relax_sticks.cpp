// The relaxation of sticks: the plain loop, which is the specification, and a kernel that takes as many
// sticks at once as the instruction set has lanes.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/relax_sticks.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/dispatch.hpp"
#include "simd/lanes-inl.hpp"
#include "simulation/places-inl.hpp"
#include "simulation/sticks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// How sticks of a run share their corrections.
class LaneStick {
  public:
    explicit LaneStick(const StickRun& run)
        : share_a_(hn::Set(Floats(), run.share_a)), share_b_(hn::Set(Floats(), run.share_b)),
          yield_(hn::Set(Floats(), run.yield)), gives_way_(run.yield != 0) {}
    LaneStick(FloatLanes share_a, FloatLanes share_b, FloatLanes yield)
        : share_a_(share_a), share_b_(share_b), yield_(yield),
          gives_way_(!hn::AllTrue(Floats(), yield == hn::Zero(Floats()))) {}

    /// The same operations as relax_one(). @param left  sticks from the first lane on
    template <typename Place>
    HWY_INLINE void operator()(Place& a, Place& b, float* goal_lengths, std::size_t left) const {
        const Floats d;
        const PointLanes across = b.from(a);
        const FloatLanes least = hn::Set(d, std::numeric_limits<float>::min());
        const FloatLanes distance = hn::Sqrt(dot(across, across) + least);
        const FloatLanes goal = hn::LoadU(d, goal_lengths);
        const FloatLanes factor = hn::Set(d, 1.0F) - goal / distance;
        const PointLanes correction = across * factor;
        a.move(correction * share_a_);
        b.move(-(correction * share_b_));
        if (!gives_way_) return;
        const FloatMask in_run = hn::FirstN(d, std::min(left, hn::Lanes(d)));
        hn::BlendedStore(goal + (distance - goal) * yield_, in_run, d, goal_lengths);
    }

  private:
    FloatLanes share_a_, share_b_, yield_;
    bool gives_way_;
};

/// Particles that follow each other.
struct Row {
    using Point = PointLanes;
    std::size_t i;

    HWY_INLINE PointLanes load(const PointArrays& p) const {
        const Floats d;
        return {hn::LoadU(d, &p.x[i]), hn::LoadU(d, &p.y[i]), hn::LoadU(d, &p.z[i])};
    }
    HWY_INLINE void store(const PointLanes& points, PointArrays& p) const {
        const Floats d;
        hn::StoreU(points.x, d, &p.x[i]);
        hn::StoreU(points.y, d, &p.y[i]);
        hn::StoreU(points.z, d, &p.z[i]);
    }
};

/// Of which only some are stored.
struct PartOfRow {
    using Point = PointLanes;
    std::size_t i;
    FloatMask mask;

    HWY_INLINE PointLanes load(const PointArrays& p) const { return Row{i}.load(p); }
    HWY_INLINE void store(const PointLanes& points, PointArrays& p) const {
        const Floats d;
        hn::BlendedStore(points.x, mask, d, &p.x[i]);
        hn::BlendedStore(points.y, mask, d, &p.y[i]);
        hn::BlendedStore(points.z, mask, d, &p.z[i]);
    }
};

/// @param a, b  the particles of the sticks whose goals these are
template <typename Places, typename Where>
HWY_INLINE void relax_at(const Where& a, const Where& b, const LaneStick& stick, float* goal_lengths,
                         std::size_t left, const Places& places) {
    auto place_a = places.load(a), place_b = places.load(b);
    stick(place_a, place_b, goal_lengths, left);
    places.store(place_a, a);
    places.store(place_b, b);
}

template <typename Places>
void relax_side_by_side(const StickRun& run, float* goal_lengths, const Places& places) {
    const Floats d;
    const LaneStick stick(run);
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= run.count; i += lanes)
        relax_at(Row{run.a + i}, Row{run.b + i}, stick, goal_lengths + i, run.count - i, places);
    if (i == run.count) return;
    const FloatMask rest = hn::FirstN(d, run.count - i);
    relax_at(PartOfRow{run.a + i, rest}, PartOfRow{run.b + i, rest}, stick, goal_lengths + i, run.count - i,
             places);
}

/// Both ends of sticks, in turn those of ends a and ends b.
/// @tparam Element  kWidth floats
template <typename Element>
struct Alternating {
    struct Point {
        PointLanes a, b;
    };
    using ElementTag = hn::Repartition<Element, Floats>;
    std::size_t i;

    HWY_INLINE Point load(const PointArrays& p) const {
        FloatLanes ax, ay, az, bx, by, bz;
        load(&p.x[i], ax, bx);
        load(&p.y[i], ay, by);
        load(&p.z[i], az, bz);
        return {{ax, ay, az}, {bx, by, bz}};
    }
    HWY_INLINE void store(const Point& ends, PointArrays& p) const {
        store(ends.a.x, ends.b.x, &p.x[i]);
        store(ends.a.y, ends.b.y, &p.y[i]);
        store(ends.a.z, ends.b.z, &p.z[i]);
    }

  private:
    static HWY_INLINE void load(const float* from, FloatLanes& a, FloatLanes& b) {
        const ElementTag d;
        hn::Vec<ElementTag> elements_a, elements_b;
        hn::LoadInterleaved2(d, reinterpret_cast<const Element*>(from), elements_a, elements_b);
        a = hn::BitCast(Floats(), elements_a);
        b = hn::BitCast(Floats(), elements_b);
    }
    static HWY_INLINE void store(const FloatLanes& a, const FloatLanes& b, float* to) {
        const ElementTag d;
        hn::StoreInterleaved2(hn::BitCast(d, a), hn::BitCast(d, b), d, reinterpret_cast<Element*>(to));
    }
};

/// Of which only some are stored.
template <typename Element>
struct PartOfAlternating {
    using Point = typename Alternating<Element>::Point;
    Alternating<Element> all;
    FloatMask mask;

    HWY_INLINE Point load(const PointArrays& p) const { return all.load(p); }
    HWY_INLINE void store(const Point& ends, PointArrays& p) const {
        const Point before = all.load(p);
        all.store({choose(mask, ends.a, before.a), choose(mask, ends.b, before.b)}, p);
    }
};

template <typename Ends>
HWY_INLINE RoundedPlace<PointLanes> one_end(const RoundedPlace<Ends>& both, PointLanes Ends::*end) {
    return {both.position.*end};
}
template <typename Ends>
HWY_INLINE CompensatedPlace<PointLanes> one_end(const CompensatedPlace<Ends>& both, PointLanes Ends::*end) {
    return {both.position.*end, both.remainder.*end};
}
template <typename Ends>
HWY_INLINE void join(const RoundedPlace<PointLanes>& a, const RoundedPlace<PointLanes>& b,
                     RoundedPlace<Ends>& both) {
    both.position = {a.position, b.position};
}
template <typename Ends>
HWY_INLINE void join(const CompensatedPlace<PointLanes>& a, const CompensatedPlace<PointLanes>& b,
                     CompensatedPlace<Ends>& both) {
    both.position = {a.position, b.position};
    both.remainder = {a.remainder, b.remainder};
}

template <typename Where, typename Places>
HWY_INLINE void relax_ends_at(const Where& where, const LaneStick& stick, float* goal_lengths,
                              std::size_t left, const Places& places) {
    using Ends = typename Where::Point;
    auto both = places.load(where);
    auto a = one_end(both, &Ends::a), b = one_end(both, &Ends::b);
    stick(a, b, goal_lengths, left);
    join(a, b, both);
    places.store(both, where);
}

template <typename Element, typename Places>
void relax_alternating(const StickRun& run, float* goal_lengths, const Places& places) {
    const Floats d;
    const LaneStick stick(run);
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= run.count; i += lanes)
        relax_ends_at(Alternating<Element>{run.a + 2 * i}, stick, goal_lengths + i, run.count - i, places);
    if (i == run.count) return;
    const FloatMask rest = hn::FirstN(d, run.count - i);
    relax_ends_at(PartOfAlternating<Element>{{run.a + 2 * i}, rest}, stick, goal_lengths + i, run.count - i,
                  places);
}

/// Relaxes as many sticks as fill whole vectors. @return how many
template <typename Places>
std::size_t relax_disjoint_sticks(const StickRun& run, StickArrays& sticks, const Places& places) {
    const Floats d;
    const std::size_t lanes = hn::Lanes(d);
    std::size_t done = 0;
    for (; done + lanes <= run.count; done += lanes) {
        const std::size_t i = run.first + done;
        const LaneStick stick(hn::LoadU(d, &sticks.share_a[i]), hn::LoadU(d, &sticks.share_b[i]),
                              hn::LoadU(d, &sticks.yield[i]));
        relax_at(GatheredParticles{load_indices(&sticks.a[i])}, GatheredParticles{load_indices(&sticks.b[i])},
                 stick, &sticks.goal_lengths[i], lanes, places);
    }
    return done;
}

template <typename Places>
std::size_t relax_lanes(const StickRun& run, StickArrays& sticks, const Places& places) {
    float* goal_lengths = &sticks.goal_lengths[run.first];
    switch (run.shape) {
    case RunShape::SideBySide:
        relax_side_by_side(run, goal_lengths, places);
        return run.count;
    case RunShape::Neighbours:
        relax_alternating<float>(run, goal_lengths, places);
        return run.count;
    case RunShape::EverySecond:
#if HWY_TARGET != HWY_SCALAR // compiled by Highway, never chosen by dispatch.hpp, and too narrow for a pair
        relax_alternating<double>(run, goal_lengths, places);
        return run.count;
#endif
    case RunShape::Disjoint:
        return relax_disjoint_sticks(run, sticks, places);
    case RunShape::Scattered:
        break;
    }
    return 0;
}

/// Relaxes the sticks of a run, from the first on. @return how many
std::size_t relax_lanes_of_run(const StickRun& run, StickArrays& sticks, PointArrays& positions,
                               PointArrays* remainders) {
    return remainders != nullptr ? relax_lanes(run, sticks, CompensatedPlaces{positions, *remainders})
                                 : relax_lanes(run, sticks, RoundedPlaces{positions});
}

template <typename Places>
HWY_INLINE void relax_one(StickArrays& sticks, std::size_t i, const Places& places) {
    const OneParticle at_a{sticks.a[i]}, at_b{sticks.b[i]};
    auto a = places.load(at_a), b = places.load(at_b);
    const Vec3f across = b.from(a);
    // The smallest float keeps particles at one place from dividing by zero and is lost in all else.
    const float distance = std::sqrt(dot(across, across) + std::numeric_limits<float>::min());
    float& goal = sticks.goal_lengths[i];
    const Vec3f correction = across * (1 - goal / distance);
    a.move(correction * sticks.share_a[i]);
    b.move(-(correction * sticks.share_b[i]));
    places.store(a, at_a);
    places.store(b, at_b);
    if (sticks.yield[i] != 0) goal = goal + (distance - goal) * sticks.yield[i];
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(relax_lanes_of_run);

template <typename Places>
void relax_one_by_one(StickArrays& sticks, std::size_t first, std::size_t count, const Places& places) {
    for (std::size_t i = first; i < first + count; ++i) HWY_NAMESPACE::relax_one(sticks, i, places);
}

void relax_run(const StickRun& run, StickArrays& sticks, PointArrays& positions, PointArrays* remainders) {
    const std::size_t done =
        use_kernels() ? ECHINUS_DISPATCH(relax_lanes_of_run)(run, sticks, positions, remainders) : 0;
    const std::size_t left = run.count - done;
    if (remainders != nullptr)
        relax_one_by_one(sticks, run.first + done, left,
                         HWY_NAMESPACE::CompensatedPlaces{positions, *remainders});
    else
        relax_one_by_one(sticks, run.first + done, left, HWY_NAMESPACE::RoundedPlaces{positions});
}

} // namespace

void relax(StickArrays& sticks, std::span<const std::uint32_t> chosen, PointArrays& positions,
           PointArrays* remainders) noexcept {
    for (const std::uint32_t i : chosen)
        if (remainders != nullptr)
            HWY_NAMESPACE::relax_one(sticks, i, HWY_NAMESPACE::CompensatedPlaces{positions, *remainders});
        else
            HWY_NAMESPACE::relax_one(sticks, i, HWY_NAMESPACE::RoundedPlaces{positions});
}

void relax(StickArrays& sticks, PointArrays& positions, PointArrays* remainders,
           const Workers& workers) noexcept {
    sticks.schedule.for_each_run(workers,
                                 [&](const StickRun& run) { relax_run(run, sticks, positions, remainders); });
}

} // namespace echinus
#endif // HWY_ONCE
