#pragma once

#include "geometry/workers.hpp"
#include "simulation/constraint_schedule.hpp"
#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// How the particles of consecutive sticks lie in their arrays.
///
///     SideBySide   a, a+1, a+2 ... and b, b+1, b+2 ...            two rows of a cloth
///     Neighbours   (a, a+1), (a+2, a+3) ...                       every second stick along a row
///     EverySecond  (a, a+2), (a+1, a+3), (a+4, a+6), (a+5, a+7)   every second bending stick along a row
///     Disjoint     in any order, but no two sticks share a particle
///     Scattered    in any order
enum class RunShape : std::uint8_t { SideBySide, Neighbours, EverySecond, Disjoint, Scattered };

/// Consecutive sticks of one shape. Except in a scattered run no two share a particle, so that relaxing many
/// at once gives the same bits as one after the other. In runs of the first three shapes all sticks share
/// their corrections alike.
struct StickRun {
    RunShape shape = RunShape::Scattered;
    std::uint32_t a = 0, b = 0; ///< particles of the first stick
    std::size_t first = 0, count = 0;
    float share_a = 0, share_b = 0, yield = 0; ///< of the first stick
};

/// That are worth handing to another thread.
inline constexpr std::size_t kSticksPerSlab = 2048;

/// All sticks with what their relaxation needs, in the order in which they are relaxed.
///
/// A spring is relaxed like a stick whose length gives way. XPBD (Macklin et al. 2016, equation 18) changes
/// the multiplier m of a spring of compliance c, length error e and inverse masses w_a, w_b, which are moved
/// by w_a m and w_b m along it, by
///
///     dm = -(e + c' m) / (w_a + w_b + c')      with c' = c / substep^2
///
/// With the goal length g = rest length - c' m, for which e + c' m = distance - g, this reads: the ends take
/// the shares w / (w_a + w_b + c') of the way to the goal, and the goal gives way by the share that is left,
/// c' / (w_a + w_b + c').
struct StickArrays {
    std::vector<std::uint32_t> a, b; ///< [count]
    /// [count] Parts of a stick's error that its two ends take: by their masses, and by the stiffness or the
    /// compliance.
    std::vector<float> share_a, share_b;
    std::vector<float> yield;        ///< [count] The part by which its goal gives way; 0 for a stick
    std::vector<float> rest_lengths; ///< [count + PointArrays::kPadding]
    std::vector<float> goal_lengths; ///< the same
    ConstraintSchedule<StickRun> schedule;

    std::size_t count() const { return a.size(); }
    bool gives_way() const;
};

/// By the solver that the options choose, in the deformable's order.
StickArrays weighted_sticks(const Deformable& deformable, const SimulationOptions& options);

/// One relaxation of all sticks, in order. The same bits under every instruction set, and for any number of
/// threads: they share the slabs of a mesh. The rows of a rectangle need one another.
/// @param remainders  what rounding took off the positions, taken along; null: it is lost
void relax(StickArrays& sticks, PointArrays& positions, PointArrays* remainders = nullptr,
           const Workers& workers = Workers()) noexcept;

/// The same of some sticks, by their numbers.
void relax(StickArrays& sticks, std::span<const std::uint32_t> chosen, PointArrays& positions,
           PointArrays* remainders) noexcept;

} // namespace echinus
