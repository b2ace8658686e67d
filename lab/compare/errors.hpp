#pragma once

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// How far the answers of a system are from the truth.
namespace echinus::comparison {

/// The true answers for a set of particles.
struct Truth {
    std::vector<std::uint8_t> inside; ///< [n]
    std::vector<float> distance;      ///< [n] to the nearest point of the surface, in the mesh's unit
    std::vector<Vec3f> way_out;       ///< [n] unit, from a particle inside to that point; empty if not known
};

/// A system's answers about some of them. All arrays have the length of `asked`.
struct Answers {
    std::vector<std::uint32_t> asked; ///< the numbers of the particles
    std::vector<std::uint8_t> inside;
    std::vector<float> depth;  ///< positive inside; empty when only signs were queried
    std::vector<Vec3f> normal; ///< unit, or 0 where the system has no way out; empty as above
};

/// Mean, ninety-ninth percentile and worst of an error; all 0 without particles to judge.
struct Spread {
    std::size_t count = 0;                ///< of errors
    double mean = 0, most = 0, worst = 0; ///< 99 % of errors are at most `most`
};

struct ErrorSummary {
    std::size_t asked_count = 0;
    double wrong_share = 0;    ///< of signs
    double farthest_wrong = 0; ///< distance of a wrong particle from the surface, R
    /// Of the depth, R: over particles that are inside, one that was missed counting as depth 0.
    Spread depth;
    /// Angle between normal and way out, degrees: over particles that are inside and known to be. No normal
    /// counts as 90. Where two ways out are equally short, one of them is called true. Not judged are
    /// particles nearer to the surface than 1e-5 R, whose way out the rounding of its end turns.
    Spread normal;
};

/// @param radius     R of the mesh's bounding sphere: the unit of lengths
/// @param undecided  particles nearer to the surface than this, in R, never count as wrong, since the truth
/// itself is uncertain there
ErrorSummary errors_of(const Truth& truth, double radius, const Answers& answers, double undecided = 0);

} // namespace echinus::comparison
