#pragma once

#include <cstdint>

/// All numbers that decide how an initial state that intersects is separated, each with its unit and effect.
/// They were chosen by trial on garments, tangled sheets and the tests of untangling.
namespace echinus::threshold {

// ---- Rounds ----

/// The largest number of rounds, each of which finds what intersects and moves it apart by a step of the
/// material.
inline constexpr int kMostRounds = 300;
/// The number of rounds without progress after which the shape at rest yields, and after which an attempt
/// ends. A shape at rest that intersects itself pulls the surface back into itself.
inline constexpr int kYieldAfter = 12, kPatience = 36;
/// The share to which the sum of all depths has to fall to count as progress.
inline constexpr double kNearer = 0.98;
/// The factor by which the number of intersections may exceed the least one found, in addition to a number
/// of pairs, before an attempt ends: it then makes everything worse.
inline constexpr std::size_t kFarWorse = 4, kFewPairs = 256;
/// The factor by which openings become stiffer in a round without progress, and the largest stiffness, in
/// stiffnesses of the material. A larger factor crumples the surface.
inline constexpr double kStiffening = 1.03, kMostStiffness = 10;
/// The resistance of inertia as a share of the material's stiffness. A smaller value lets whole parts move
/// farther in a round, but makes the linear systems worse conditioned.
inline constexpr double kInertiaShare = 0.003;
/// The number of steps of Newton's method in each round.
inline constexpr std::uint32_t kStepsPerRound = 2;

// ---- Displacements in a round ----

/// The largest displacement that is asked of parts that intersect, and of particles inside a model, in mean
/// edge lengths. Larger ones crumple the surface; smaller ones take more rounds.
inline constexpr float kStride = 0.25F, kDepthStride = 0.5F;
/// The distance from a model, in mean edge lengths, within which particles outside are kept outside.
inline constexpr float kGuarded = 1;
/// The gap to which layers are separated, as a share of their thickness, and its limits in mean edge lengths.
/// Contact does the rest.
inline constexpr float kGapInThicknesses = 0.5F, kLeastLayerGap = 1.0F / 32, kMostLayerGap = 1.0F / 8;

// ---- Directions ----

/// The least mean cosine between the normals of the surface and those of the nearest points of a model for
/// which the surface is a garment around the model, whose particles all leave to the same side.
inline constexpr double kAgreement = 0.5;
/// The cosine between the preferred direction and that to the nearest point below which a particle takes the
/// preferred one.
inline constexpr float kOpposed = -0.5F;
/// The least sum of the normals around a part that comes through a face, over the sum of their lengths, that
/// gives the axis of the part.
inline constexpr double kLeastAxis = 0.1;
/// The number of times that normals are averaged with those of neighbours for the preferred directions, and
/// that the directions are averaged in which faces are lifted: a part of a model that comes through several
/// faces has a common axis.
inline constexpr int kSmoothingsOfNormals = 4, kSmoothingsOfLifts = 3;
/// The largest number of surfaces that a particle may cross on its path out of nested parts.
inline constexpr int kMostSurfacesCrossed = 64;
/// The least cosine between an edge and the normal of the face that it passes through, in the gradient of a
/// curve's length, which is infinite for an edge in the plane of the face; and the least length of this
/// gradient, whose terms are of length 1: along a straight curve they cancel out, up to rounding.
inline constexpr double kLeastCosine = 0.1, kLeastGradient = 0.05;

} // namespace echinus::threshold
