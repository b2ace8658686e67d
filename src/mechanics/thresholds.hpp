#pragma once

#include <cstddef>
#include <cstdint>

/// All numbers that decide where a step ends and how its linear systems are solved, each with its unit and
/// its effect. Those of contact are in simulation/contact/thresholds.hpp. Numbers without a source were
/// chosen by trial on the scenes of this repository.
namespace echinus::threshold {

// ---- The step ----

/// The share of the decrease predicted by the slope that a Newton step has to achieve (Armijo's condition). A
/// larger value takes shorter steps.
inline constexpr double kSufficientDecrease = 1e-4;
/// The number of shortened trials after which a Newton step is accepted as it is.
inline constexpr std::uint32_t kMostShorterTrials = 12;
/// The share of the energy below which a difference between two energies is rounding.
inline constexpr double kEnergyRounding = 1e-11;
/// The largest number of times that a guess is halved; nothing is then left of its displacement.
inline constexpr std::uint32_t kMostHalvingsOfGuess = 24;
/// How many times as many Newton steps a frame without contact may take as one with contact. Without contact,
/// the method converges quadratically, and a stiff sheet that swings needs up to eight; in folds it converges
/// linearly, and more steps gain little.
inline constexpr std::uint32_t kStepsWithoutContact = 2;
/// The tolerance for displacements of whole bodies, as a share of that for particles. A larger value leaves
/// more of the forces on a body as momentum.
inline constexpr double kBodyTolerance = 0.1;
/// The number of Newton steps in the translations of whole bodies after each solve for all particles. A
/// smaller value leaves momentum.
inline constexpr std::uint32_t kMostBalancingSteps = 8;

/// The stiffness of a free body's tetrahedron over mass size^2 / h^2, the resistance of its inertia in a
/// frame. At an impact the control points deviate from their rigid positions by the inverse of this value
/// times their displacement in a frame. A larger value makes the linear systems worse conditioned.
inline constexpr double kBodyStiffness = 1e3;
/// The largest angle in radians by which a free body turns in one round of rotations about its principal
/// axes, whose error grows with the square of it; and the largest number of rounds in a step: a body that
/// spins faster turns farther in each.
inline constexpr double kLongestTurn = 0.1, kMostTurns = 64;
/// The largest number of turns for finding the pose nearest to control points, and the angle in radians at
/// which they end. They converge quadratically, so a few suffice.
inline constexpr int kMostFittingTurns = 64;
inline constexpr double kFittingPrecision = 1e-15;

// ---- The materials ----

/// The angle at rest, in radians, below which a hinge counts as flat, since only rounding to floats bends it;
/// its energy is then quadratic.
inline constexpr float kFlatHinge = 1e-4F;
/// The least stretch of a direction of a triangle, as a share of its length at rest: if it is compressed
/// further, it cannot be normalised.
inline constexpr double kLeastExtension = 1e-9;

// ---- Multigrid ----

/// The number of edges between coarse nodes. A larger value gives fewer nodes, which represent smooth
/// displacements less well.
inline constexpr std::uint32_t kCoarseSpacing = 2;
/// The largest number of coarse nodes that a node follows, and the least weight of one. More parents give
/// better and denser coarse matrices.
inline constexpr std::size_t kMostParents = 4;
inline constexpr double kLeastParentWeight = 0.02;
/// The regularisation of the least squares for those weights, relative to the squared distance to the
/// farthest parent: in a direction in which the parents do not extend (out of a sheet), the linear term is
/// dropped.
inline constexpr double kFlatness = 1e-3;
/// The share of the trace that is added to the diagonal blocks of coarse matrices, which may be singular in
/// float if nothing holds a body.
inline constexpr float kRegularisation = 1e-6F;
/// The largest number of nodes of a level that is solved directly.
inline constexpr std::size_t kMostLastNodes = 64;

} // namespace echinus::threshold
