#pragma once

#include <cstddef>
#include <cstdint>

/// All numbers by which a step decides where it ends and how its linear systems are solved: each with its
/// unit and its effect. Those about contact are in simulation/contact/thresholds.hpp. Those without a source
/// were chosen by trial on the scenes of this repository.
namespace echinus::threshold {

// ---- The step ----

/// Armijo's condition: the share of the slope's promise that Newton's step has to keep. More takes shorter
/// steps.
inline constexpr double kSufficientDecrease = 1e-4;
/// Shorter trials after which Newton's step is taken as it is.
inline constexpr std::uint32_t kMostShorterTrials = 12;
/// Share of the energy below which differences of it are rounding.
inline constexpr double kEnergyRounding = 1e-11;
/// Times that a guess is halved, at most: then nothing is left of its displacement.
inline constexpr std::uint32_t kMostHalvingsOfGuess = 24;
/// Newton's steps of a frame without contact, at most, over those with: without, the method converges
/// quadratically, and a stiff sheet that swings needs up to eight; in folds it converges linearly, and more
/// steps gain little.
inline constexpr std::uint32_t kStepsWithoutContact = 2;
/// Share of the tolerance of particles that the displacements of whole bodies have. More leaves more of the
/// forces on a body as momentum.
inline constexpr double kBodyTolerance = 0.1;
/// Newton's steps in the translations of whole bodies, after each of all particles. Fewer leave momentum.
inline constexpr std::uint32_t kMostBalancingSteps = 8;

/// Stiffness of a free body's tetrahedron over mass size^2 / h^2, the resistance of its inertia in a frame.
/// At an impact its control points stray from their rigid places by the inverse of this share of what they go
/// in a frame. More makes the linear systems worse conditioned.
inline constexpr double kBodyStiffness = 1e3;
/// Radians by which a free body turns in one round of turns about its principal axes, at most; the error
/// grows with the square. And rounds in a step: what spins faster turns farther in each.
inline constexpr double kLongestTurn = 0.1, kMostTurns = 64;
/// Turns in which the pose nearest to control points is found, at most, and radians that end them. They
/// converge quadratically: a few do.
inline constexpr int kMostFittingTurns = 64;
inline constexpr double kFittingPrecision = 1e-15;

// ---- The materials ----

/// Radians: a hinge that is flatter at rest is flat, but for rounding in floats, and bends by a quadratic
/// form.
inline constexpr float kFlatHinge = 1e-4F;
/// Share of the length at rest: a direction of a triangle compressed below it has no normal.
inline constexpr double kLeastExtension = 1e-9;

// ---- Multigrid ----

/// Edges between coarse nodes: more make fewer of them, which represent less of what is smooth.
inline constexpr std::uint32_t kCoarseSpacing = 2;
/// Coarse nodes that a node follows, and the least weight of one: more make better and denser coarse
/// matrices.
inline constexpr std::size_t kMostParents = 4;
inline constexpr double kLeastParentWeight = 0.02;
/// Of the least squares of those weights, relative to the square of the distance to the farthest parent: in a
/// direction in which the parents do not extend (out of a sheet), what is linear is left out.
inline constexpr double kFlatness = 1e-3;
/// Share of the trace that is added to the diagonal of coarse matrices, which may be singular in float: of a
/// body that nothing holds.
inline constexpr float kRegularisation = 1e-6F;
/// Nodes: a level of no more is solved directly.
inline constexpr std::size_t kMostLastNodes = 64;

} // namespace echinus::threshold
