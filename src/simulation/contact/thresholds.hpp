#pragma once

#include <cstdint>

/// All numbers by which the newton solver decides about contact: each with its unit, its source and its
/// effect. Those without a source were chosen by trial on the scenes of this repository.
namespace echinus::threshold {

// ---- The energy of contact ----

/// Force of a barrier over the weight that the contact carries. With one layer on it a contact at rest is
/// 0.77 of the thickness wide, under ten 0.4. More makes contacts wider and stiffer.
inline constexpr double kBarrierWeights = 5;
/// Force of a barrier over what its contact pushed with in the step before, where that is more, and over the
/// weight of the heaviest free body that lies on it; so a contact that carries much is 0.4 of the thickness
/// wide, too. And by what it may grow in a step: more lifts what is suddenly loaded faster than is quiet.
inline constexpr double kBarrierOfPush = 0.5, kMostBarrierGrowth = 1.5;
/// Strain of the material that the scale of such a barrier would cause, at most: between two plates that
/// leave too little room push and barrier would otherwise raise each other without bound. The share
/// of free bodies is bounded by their weight.
inline constexpr double kMostBarrierStrain = 0.1;
/// Share of the thickness from which on the barrier goes on as a parabola. Less holds harder impacts within
/// Newton's step, and makes its linear systems worse conditioned.
inline constexpr double kLeastBarrierShare = 1.0 / 16;
/// Stiffness of a bristle over mass / h^2, the resistance of inertia in a step. More gives way less before it
/// holds (mu g h^2 / this), and slows Newton's method down: with 100 it does not converge in four steps.
inline constexpr double kBristleStiffness = 10;
/// Thicknesses: so far a bristle bends, at most, before it slips under the load of the step before. More
/// lets a heavy body move before friction holds it.
inline constexpr double kMostBend = 0.1;
/// Cosine between the normals of two contacts that may go on with each other's bristles.
inline constexpr double kSamePlane = 0.5;

// ---- Which pairs are contacts ----

/// Thicknesses: a pair this near is a contact, which begins to push as soon as a trial comes within one.
inline constexpr float kReady = 1.5F;
/// Share of the thickness that edges and faces of a model keep: they lie between vertices, and need less.
inline constexpr float kSurfaceShare = 0.75F;
/// Mean edges, and least heights of the faces and tetrahedra around: layers of one surface keep no farther
/// apart, or its own neighbours, and both sides of a thin body, would push each other.
inline constexpr float kMostSelfThickness = 0.25F, kMostOfHeight = 0.4F;
/// Mean edges, and metres: no thickness is less, since a contact has to push within it.
inline constexpr double kLeastThickness = 0.02, kLeastThicknessOfAll = 1e-6;
/// Thicknesses: how far along its ray a particle is looked for, which a distance map measures by. Steeper
/// than 60 degrees a contact begins to push later.
inline constexpr double kParticleReach = 4;
/// Rounds in which particles are put outside of colliders; one may put them into another.
inline constexpr int kMostRoundsOutside = 4;

// ---- Safe displacements ----

/// Mean edges around its displacement in which a vertex looks for pairs, beside the thickness. More lists
/// more pairs, less often.
inline constexpr float kReach = 0.1F;
/// Share of a gap, or of the thickness where that is less, that always remains of it: rounding then has no
/// say.
inline constexpr float kLeastOfGap = 1.0F / 16, kLeastOfThickness = 1.0F / 4;
/// Share of coordinates: no pair comes nearer, since its gap would be lost in rounding.
inline constexpr float kLeastGap = 1.0F / (1 << 19);
/// Share of the room of a pair that is pushed apart to which it then closes, so that the next pairs need not
/// push it again; and rounds through the pairs.
inline constexpr float kPushedTo = 0.9F;
inline constexpr int kMostPushingRounds = 64;
/// Rounds in which ends that were not expected are looked at anew, and times that displacements are halved
/// where those do not suffice: within bodies, and then of whole bodies. Then nothing moves that is not held.
inline constexpr int kMostListingRounds = 8, kMostHalvings = 4, kMostHalvingsOfAll = 6;
/// Mean edges: so far a particle may end from its goal before planes are measured anew on the way there; and
/// how often that is done. They turn with what passes along them.
inline constexpr float kMostMissed = 0.1F;
inline constexpr int kMostPasses = 4;

// ---- Colliders that move, and parts of a frame ----

/// Share of a pair's gap that carrying may close: what particles do by themselves comes after it.
inline constexpr float kMostClosedByCarrying = 0.5F;
/// Thicknesses: what is no farther from a collider is carried along with it whole; and longest displacements
/// over which the field fades beyond, which then closes at most a quarter of a gap.
inline constexpr double kTouch = 2, kFade = 4;
/// In a part of a frame, at most: thicknesses by which colliders carry particles beyond the motion that these
/// have, so that loads follow what gives way, and mean edges by which displacements would overlap, so that
/// impacts are solved where they happen: with 4 a sheet that hits at 40 m/s bounces off within one. And parts
/// of a frame. More parts take more time.
inline constexpr double kMostCarried = 4, kMostOverlap = 2;
inline constexpr std::uint32_t kMostPartsOfFrame = 32;
/// Of a frame: a part in which colliders cannot carry what is near them is halved, so that it can give way
/// meanwhile, down to this. Less holds harder squeezes, and takes more time in them.
inline constexpr float kLeastPartOfFrame = 1.0F / 64;
/// Of a frame: a part in which what is stopped leaves nothing that can move is halved down to this. Less
/// takes more time where there is no room.
inline constexpr float kLeastPartToMove = 1.0F / 16;
/// Displacements of the fastest particle in a frame: how far off vertices of a collider that deforms may be
/// to decide about the division.
inline constexpr double kDecidingRoom = 2;

} // namespace echinus::threshold
