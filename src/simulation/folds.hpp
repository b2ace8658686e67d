#pragma once

#include "geometry/workers.hpp"
#include "simulation/constraint_schedule.hpp"
#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// The angle between the faces (a, b, c) and (b, a, d), as Fold has it; 0 where one of them has no area.
float fold_angle(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d);

/// That are worth handing to another thread.
inline constexpr std::size_t kFoldsPerSlab = 512;

/// All folds with what their relaxation needs, in the order in which they are relaxed.
///
/// The gradient of the angle (Bridson, Marino and Fedkiw 2003, "Simulation of Clothing with Folds and
/// Wrinkles") has no singularity in the flat state, nor in the folded one, as that of its cosine has. With
/// n_c and n_d the unit normals of the faces, h_c and h_d the heights of the corners over the edge, and t_c,
/// t_d their feet on it (0 at a, 1 at b), it is
///
///     at c: n_c / h_c    at b: -(t_c n_c / h_c + t_d n_d / h_d)
///     at d: n_d / h_d    at a: minus the sum of the others
///
/// The corrections conserve linear and angular momentum, since the angle does not change with a motion of the
/// whole. XPBD's multiplier is kept as a goal that gives way, as in StickArrays.
struct FoldArrays {
    std::vector<std::uint32_t> a, b, c, d; ///< [count]
    /// [count] of the particles
    std::vector<float> inverse_mass_a, inverse_mass_b, inverse_mass_c, inverse_mass_d;
    std::vector<float> rest_angles, goal_angles; ///< [count]
    std::vector<float> compliances;              ///< [count] of the angle, over substep^2; 0 with Verlet
    float stiffness = 1;                         ///< with Verlet
    ConstraintSchedule<ConstraintRun> schedule;

    std::size_t count() const { return a.size(); }
    /// Multipliers begin at 0 in each substep (Macklin et al. 2016, algorithm 1).
    void restore_goals() { goal_angles = rest_angles; }
};

/// By the solver that the options choose, in the deformable's order.
FoldArrays weighted_folds(const Deformable& deformable, const SimulationOptions& options);

/// One relaxation of all folds, in order. The same bits under every instruction set and number of threads.
/// @param remainders  what rounding took off the positions, taken along; null: it is lost
/// @param workers     share the pieces of a phase
void relax(FoldArrays& folds, PointArrays& positions, PointArrays* remainders = nullptr,
           const Workers& workers = Workers()) noexcept;

} // namespace echinus
