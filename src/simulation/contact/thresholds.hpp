#pragma once

#include <cstdint>

/// All numbers by which the newton solver decides about contact, each with its unit, its source and its
/// effect. Numbers without a source were chosen by trial on the scenes of this repository.
namespace echinus::threshold {

// ---- The energy of contact ----

/// The force of a barrier over the weight that the contact carries. A contact at rest under one layer is 0.77
/// of the thickness wide, and under ten layers 0.4. A larger value makes contacts wider and stiffer.
inline constexpr double kBarrierWeights = 5;
/// The force of a barrier over the force with which its contact pushed in the step before, and over the
/// weight of the heaviest free body that rests on it, if these are more; so a contact that carries much is
/// 0.4 of the thickness wide, too. The second number is the factor by which the first of these may grow in a
/// step: a larger value lifts suddenly loaded layers too abruptly.
inline constexpr double kBarrierOfPush = 0.5, kMostBarrierGrowth = 1.5;
/// The largest strain that the force of such a barrier may cause in the material. Without it, push and
/// barrier would increase each other without bound between two plates that leave too little room. The part
/// for free bodies is bounded by their weight.
inline constexpr double kMostBarrierStrain = 0.1;
/// The share of the thickness below which the barrier continues as a parabola. A smaller value withstands
/// harder impacts within a Newton step, but makes its linear systems worse conditioned.
inline constexpr double kLeastBarrierShare = 1.0 / 16;
/// The stiffness of a bristle over mass / h^2, the resistance of inertia in a step. A larger value lets it
/// yield less before it holds (by mu g h^2 / this value), but slows Newton's method down: with 100 it does
/// not converge in four steps.
inline constexpr double kBristleStiffness = 10;
/// The distance, in thicknesses, by which a bristle can bend under the load of the step before until it
/// slips. A larger value lets a heavy body move before friction holds it.
inline constexpr double kMostBend = 0.1;
/// The least cosine between the normals of two contacts that may continue each other's bristles.
inline constexpr double kSamePlane = 0.5;

// ---- Which pairs are contacts ----

/// The gap, in thicknesses, below which a pair becomes a contact, which begins to push when a trial brings it
/// within one thickness.
inline constexpr float kReady = 1.5F;
/// The share of the thickness that the edges and faces of a deformable keep from a model; only its vertices
/// keep all of it.
inline constexpr float kSurfaceShare = 0.75F;
/// The largest thickness between layers of one surface, in mean edge lengths and in the least heights of the
/// faces and tetrahedra around. With more, neighbouring parts, or the two sides of a thin body, would push
/// each other.
inline constexpr float kMostSelfThickness = 0.25F, kMostOfHeight = 0.4F;
/// The least thickness, in mean edge lengths and in metres: a contact has to push within it.
inline constexpr double kLeastThickness = 0.02, kLeastThicknessOfAll = 1e-6;
/// How far, in thicknesses, maps look for particles; a distance map measures this along its ray. Where the
/// surface is inclined by more than 60 degrees, a contact begins to push later.
inline constexpr double kParticleReach = 4;
/// The number of rounds in which particles are moved out of colliders; leaving one may lead into another.
inline constexpr int kMostRoundsOutside = 4;

// ---- Safe displacements ----

/// The distance from its displacement, in mean edge lengths, within which a vertex looks for pairs; near
/// models the thickness is added. A larger value lists more pairs, but less often.
inline constexpr float kReach = 0.1F;
/// How far from its expected position a vertex may end, as a share of the distance within which pairs are
/// listed, before they are listed anew: two parts that approach each other leave half of it then. A larger
/// value lists pairs less often; 0.5 would leave nothing.
inline constexpr float kCoveredShare = 0.25F;
/// The share of a gap, or of the thickness if that is less, that always remains open, so that rounding has no
/// influence.
inline constexpr float kLeastOfGap = 1.0F / 16, kLeastOfThickness = 1.0F / 4;
/// The least gap of any pair, as a share of the largest coordinates: a smaller one would be lost in rounding.
inline constexpr float kLeastGap = 1.0F / (1 << 19);
/// The share of its room to which a pair closes after it has been pushed apart, so that the next pairs need
/// not push it again; and the largest number of rounds through the pairs.
inline constexpr float kPushedTo = 0.9F;
inline constexpr int kMostPushingRounds = 64;
/// How much farther than required, in least gaps, a pair is pushed, and how much earlier it is examined again
/// while its particles are pushed. It exceeds the rounding of a push, which would otherwise leave pairs too
/// near by a last digit. A larger value pushes particles farther than necessary.
inline constexpr float kPushMargin = 0.25F;
/// The least share of a displacement for which each of the planes must hold by which two elements are shown
/// to pass each other. A smaller share proves this for more pairs, and takes more time.
inline constexpr float kLeastShareOfPlane = 1.0F / 256;
/// The largest number of rounds in which pairs are listed again because particles end at unexpected
/// positions; and of times that displacements are halved if those rounds do not suffice, first relative to
/// those of whole bodies, then with them. After that, only held particles of the stopped bodies move.
inline constexpr int kMostListingRounds = 8, kMostHalvings = 4, kMostHalvingsOfAll = 6;
/// How far from its goal a particle may end, in mean edge lengths, before planes are measured again on the
/// way there; and the largest number of such passes. Planes turn with the particles that pass along them.
inline constexpr float kMostMissed = 0.1F;
inline constexpr int kMostPasses = 4;

// ---- Colliders that move, and parts of a frame ----

/// The share of a pair's gap that carrying may close; the rest remains for the particles' own motion.
inline constexpr float kMostClosedByCarrying = 0.5F;
/// The distance from a collider, in thicknesses, within which its displacement carries particles fully; and
/// the distance, in longest displacements, over which the field fades beyond it, so that it closes at most a
/// quarter of a gap.
inline constexpr double kTouch = 2, kFade = 4;
/// The limits for a part of a frame: the distance, in thicknesses, by which colliders carry particles beyond
/// the motion that these have, so that loads follow what yields; and the distance, in mean edge lengths, by
/// which displacements would overlap, so that impacts are solved where they happen: with 4, a sheet that hits
/// at 40 m/s bounces off within one part. The last number is the most parts of a frame. More parts take more
/// time.
inline constexpr double kMostCarried = 4, kMostOverlap = 2;
inline constexpr std::uint32_t kMostPartsOfFrame = 32;
/// The least part of a frame, as a share of it, to which a part is halved if colliders cannot carry particles
/// near them, so that these can give way meanwhile. A smaller value withstands harder squeezing, but then
/// takes more time.
inline constexpr float kLeastPartOfFrame = 1.0F / 64;
/// The least part of a frame, as a share of it, to which a part is halved if stops let nothing move. A
/// smaller value takes more time if there is no room.
inline constexpr float kLeastPartToMove = 1.0F / 16;
/// How far from the deformable, in the largest displacement of a particle in a frame, vertices of a deforming
/// collider are considered when the frame is divided.
inline constexpr double kDecidingRoom = 2;

} // namespace echinus::threshold
