// The relaxation of sticks: the plain loop, which is the specification, and a kernel that takes as many
// sticks at once as the instruction set has lanes.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/relax_sticks.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/dispatch.hpp"
#include "simd/lanes-inl.hpp"
#include "simulation/gathered_points-inl.hpp"
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
    void operator()(PointLanes& a, PointLanes& b, float* goal_lengths, std::size_t left) const {
        const Floats d;
        const PointLanes across = b - a;
        const FloatLanes least = hn::Set(d, std::numeric_limits<float>::min());
        const FloatLanes distance = hn::Sqrt(dot(across, across) + least);
        const FloatLanes goal = hn::LoadU(d, goal_lengths);
        const FloatLanes factor = hn::Set(d, 1.0F) - goal / distance;
        const PointLanes correction = across * factor;
        a = a + correction * share_a_;
        b = b - correction * share_b_;
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
    static PointLanes load(const PointArrays& p, std::size_t i) {
        const Floats d;
        return {hn::LoadU(d, &p.x[i]), hn::LoadU(d, &p.y[i]), hn::LoadU(d, &p.z[i])};
    }
    static void store(const PointLanes& points, PointArrays& p, std::size_t i) {
        const Floats d;
        hn::StoreU(points.x, d, &p.x[i]);
        hn::StoreU(points.y, d, &p.y[i]);
        hn::StoreU(points.z, d, &p.z[i]);
    }
    static void store(const PointLanes& points, const FloatMask& mask, PointArrays& p, std::size_t i) {
        const Floats d;
        hn::BlendedStore(points.x, mask, d, &p.x[i]);
        hn::BlendedStore(points.y, mask, d, &p.y[i]);
        hn::BlendedStore(points.z, mask, d, &p.z[i]);
    }
};

void relax_side_by_side(const StickRun& run, float* goal_lengths, PointArrays& p) {
    const Floats d;
    const LaneStick stick(run);
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= run.count; i += lanes) {
        PointLanes a = Row::load(p, run.a + i), b = Row::load(p, run.b + i);
        stick(a, b, goal_lengths + i, run.count - i);
        Row::store(a, p, run.a + i);
        Row::store(b, p, run.b + i);
    }
    if (i == run.count) return;
    const FloatMask rest = hn::FirstN(d, run.count - i);
    PointLanes a = Row::load(p, run.a + i), b = Row::load(p, run.b + i);
    stick(a, b, goal_lengths + i, run.count - i);
    Row::store(a, rest, p, run.a + i);
    Row::store(b, rest, p, run.b + i);
}

/// Elements of kWidth floats each, in turn those of ends a and ends b.
template <typename Element>
struct Alternating {
    using ElementTag = hn::Repartition<Element, Floats>;

    static void load(const float* from, FloatLanes& a, FloatLanes& b) {
        const ElementTag d;
        hn::Vec<ElementTag> elements_a, elements_b;
        hn::LoadInterleaved2(d, reinterpret_cast<const Element*>(from), elements_a, elements_b);
        a = hn::BitCast(Floats(), elements_a);
        b = hn::BitCast(Floats(), elements_b);
    }
    static void store(const FloatLanes& a, const FloatLanes& b, float* to) {
        const ElementTag d;
        hn::StoreInterleaved2(hn::BitCast(d, a), hn::BitCast(d, b), d, reinterpret_cast<Element*>(to));
    }
    struct Points {
        PointLanes a, b;
    };
    static Points load(const PointArrays& p, std::size_t i) {
        FloatLanes ax, ay, az, bx, by, bz;
        load(&p.x[i], ax, bx);
        load(&p.y[i], ay, by);
        load(&p.z[i], az, bz);
        return {{ax, ay, az}, {bx, by, bz}};
    }
    static void store(const PointLanes& a, const PointLanes& b, PointArrays& p, std::size_t i) {
        store(a.x, b.x, &p.x[i]);
        store(a.y, b.y, &p.y[i]);
        store(a.z, b.z, &p.z[i]);
    }
};

template <typename Element>
void relax_alternating(const StickRun& run, float* goal_lengths, PointArrays& p) {
    using Ends = Alternating<Element>;
    const Floats d;
    const LaneStick stick(run);
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t i = 0; i < run.count; i += lanes) {
        const auto [a, b] = Ends::load(p, run.a + 2 * i);
        PointLanes new_a = a, new_b = b;
        stick(new_a, new_b, goal_lengths + i, run.count - i);
        if (i + lanes > run.count) {
            const FloatMask rest = hn::FirstN(d, run.count - i);
            new_a = choose(rest, new_a, a);
            new_b = choose(rest, new_b, b);
        }
        Ends::store(new_a, new_b, p, run.a + 2 * i);
    }
}

/// Relaxes as many sticks as fill whole vectors. @return how many
std::size_t relax_disjoint(const StickRun& run, StickArrays& sticks, PointArrays& p) {
    const Floats d;
    const std::size_t lanes = hn::Lanes(d);
    std::size_t done = 0;
    for (; done + lanes <= run.count; done += lanes) {
        const std::size_t i = run.first + done;
        const IntLanes at_a = load_indices(&sticks.a[i]), at_b = load_indices(&sticks.b[i]);
        PointLanes a = gather(p, at_a), b = gather(p, at_b);
        const LaneStick stick(hn::LoadU(d, &sticks.share_a[i]), hn::LoadU(d, &sticks.share_b[i]),
                              hn::LoadU(d, &sticks.yield[i]));
        stick(a, b, &sticks.goal_lengths[i], lanes);
        scatter(a, p, at_a);
        scatter(b, p, at_b);
    }
    return done;
}

void relax_run(const StickRun& run, StickArrays& sticks, PointArrays& positions) {
    float* goal_lengths = &sticks.goal_lengths[run.first];
    switch (run.shape) {
    case RunShape::SideBySide:
        return relax_side_by_side(run, goal_lengths, positions);
    case RunShape::Neighbours:
        return relax_alternating<float>(run, goal_lengths, positions);
    case RunShape::EverySecond:
#if HWY_TARGET != HWY_SCALAR // compiled by Highway, never chosen by dispatch.hpp, and too narrow for a pair
        return relax_alternating<double>(run, goal_lengths, positions);
#endif
    case RunShape::Disjoint:
    case RunShape::Scattered:
        break;
    }
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(relax_run);
HWY_EXPORT(relax_disjoint);

void relax_one(StickArrays& sticks, std::size_t i, PointArrays& positions) {
    const Vec3f a = positions[sticks.a[i]];
    const Vec3f b = positions[sticks.b[i]];
    const Vec3f across = b - a;
    // The smallest float keeps particles at one place from dividing by zero and is lost in all else.
    const float distance = std::sqrt(dot(across, across) + std::numeric_limits<float>::min());
    float& goal = sticks.goal_lengths[i];
    const Vec3f correction = across * (1 - goal / distance);
    positions.set(sticks.a[i], a + correction * sticks.share_a[i]);
    positions.set(sticks.b[i], b - correction * sticks.share_b[i]);
    if (sticks.yield[i] != 0) goal = goal + (distance - goal) * sticks.yield[i];
}

void relax_one_by_one(StickArrays& sticks, std::size_t first, std::size_t count, PointArrays& positions) {
    for (std::size_t i = first; i < first + count; ++i) relax_one(sticks, i, positions);
}

} // namespace

void relax(StickArrays& sticks, std::span<const std::uint32_t> chosen, PointArrays& positions) noexcept {
    for (const std::uint32_t i : chosen) relax_one(sticks, i, positions);
}

void relax(StickArrays& sticks, PointArrays& positions, RunOrder order) noexcept {
    const bool in_lanes = use_kernels();
    for (std::size_t r = 0; r < sticks.runs.size(); ++r) {
        const StickRun& run = sticks.runs[order == RunOrder::Forwards ? r : sticks.runs.size() - 1 - r];
        const bool any_order = run.shape == RunShape::Disjoint || run.shape == RunShape::Scattered;
        if (in_lanes && !any_order) {
            ECHINUS_DISPATCH(relax_run)(run, sticks, positions);
            continue;
        }
        const bool gathered = in_lanes && run.shape == RunShape::Disjoint;
        const std::size_t done = gathered ? ECHINUS_DISPATCH(relax_disjoint)(run, sticks, positions) : 0;
        relax_one_by_one(sticks, run.first + done, run.count - done, positions);
    }
}

} // namespace echinus
#endif // HWY_ONCE
