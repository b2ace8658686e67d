#pragma once

#include "geometry/workers.hpp"
#include "simulation/constraint_schedule.hpp"
#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// That are worth handing to another thread.
inline constexpr std::size_t kTetrahedraPerSlab = 512;

/// All tetrahedra with what their relaxation needs, in the order in which they are relaxed.
///
/// The energy is the stable Neo-Hookean one of Macklin and Mueller 2021 ("A Constraint-based Formulation of
/// Stable Neo-Hookean Materials", section 3): with F the deformation gradient, J its determinant and
/// l = lambda + mu, so that small strains obey Hooke's law with the Lame parameters mu and lambda,
///
///     mu / 2 (|F|^2 - 3) + l / 2 (J - 1 - mu / l)^2
///
/// They make it of the constraints |F|, which never vanishes, and J - 1 - mu / l. At rest these two pull with
/// all their force against each other, and small steps that relax one after the other leave some of it. The
/// same energy, but for a constant, is that of two constraints which both vanish at rest:
///
///     shape   sqrt(|F|^2 + J^2 - 4 J)   with the compliance 1 / (mu volume)
///     volume  J - 1                     with the compliance 1 / (lambda volume)
///
/// What is under the root is 2 (J - 1)^2 - II - III, with the second and third invariants of F^T F - 1: so
/// it is computed, since near rest it is as small as the square of the strain.
///
/// An element that is pressed together from all sides, to |F|^2 < 1.2, has push (1.2 - |F|^2)^2 more under
/// the root: as it is, the energy has a second minimum where an element is but a point, which Smith, de Goes
/// and Kim ("Stable Neo-Hookean Flesh Simulation", 2018) remove by a logarithm.
///
/// Corrections are directed as the gradients turned back to where the substep began: with S = F^-1 times the
/// gradient, which is symmetric, along (F then) S. No force then has a moment about the positions by which
/// the momentum of a step is measured, and free bodies keep theirs to rounding, as in SHAKE (Ryckaert,
/// Ciccotti and Berendsen 1977). Where an element turns or bends too far in one substep, is flat or is blown
/// up, they follow the gradient less its moment about those positions.
struct TetrahedronArrays {
    std::array<std::vector<std::uint32_t>, 4> particles; ///< [count] each
    std::array<std::vector<float>, 4> inverse_masses;    ///< the same
    /// The gradients of the second to fourth particle's barycentric coordinates at rest, as x, y, z each.
    std::array<std::vector<float>, 9> gradients;
    std::vector<float> spreads; ///< sum of inverse masses times squared gradients, of all four
    /// By compliance, times substep^2.
    std::vector<float> shape_stiffnesses, volume_stiffnesses;
    std::vector<float> viscosities;                           ///< shape stiffness times damping / substep
    std::vector<float> shape_multipliers, volume_multipliers; ///< as in XPBD
    ConstraintSchedule<ConstraintRun> schedule;
    bool is_viscous = false;
    bool keeps_multipliers = false; ///< over more than one relaxation

    std::size_t count() const { return spreads.size(); }
    /// Multipliers begin at 0 in each substep (Macklin et al. 2016, algorithm 1).
    void begin_substep();
};

/// In the deformable's order. @pre the options choose Xpbd, or there are no tetrahedra
TetrahedronArrays weighted_tetrahedra(const Deformable& deformable, const SimulationOptions& options);

/// Takes off a share of the strain that each tetrahedron gains in this substep, as viscosity does; once in a
/// substep, before relaxations. @pre the particles keep remainders
/// @param workers  share the pieces of a phase, as those of relax() do
void damp(const TetrahedronArrays& tetrahedra, Particles& particles,
          const Workers& workers = Workers()) noexcept;

/// One relaxation of all tetrahedra, in order. The same bits under every instruction set and number of
/// threads. @pre the particles keep remainders
void relax(TetrahedronArrays& tetrahedra, Particles& particles, const Workers& workers = Workers()) noexcept;

} // namespace echinus
