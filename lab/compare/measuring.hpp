#pragma once

#include "compare/systems.hpp"
#include "compare/turns.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

/// Shared by `echinus-compare` and the benchmarks: systems answer for a set of particles in turns, and a
/// judge measures the errors of the answers.
namespace echinus::comparison {

// How far the answers of a system are from the truth.

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

/// A set of particles and the truth about them; where the truth is empty, no errors are computed.
struct JudgedSet {
    std::string name;
    std::vector<Vec3f> points;
    Truth truth;
};

/// A system that was built, and the processor time of all threads that it took, in milliseconds: the median
/// of several builds where they are quick.
struct TimedBuild {
    Built system;
    double ms;
};

/// @throws Error as the builder does
TimedBuild build_timed(const Builder& builder);

/// The effort and the kinds of query.
struct Effort {
    int passes = 5;
    double enough_seconds = 1; ///< a system that took this long in all passes stops
    /// Seconds. A system that seems to need longer for a set answers for parts of it; judged by a trial in
    /// small calls, in which systems that gain by the size of a call look slower than they are.
    double patience_seconds = 30;
    std::size_t call_size =
        0;                   ///< particles in a call, of which a turn makes several; 0: one call for the set
    bool one_by_one = false; ///< a call for each particle instead of one for the set
    bool sides = true, contacts = true;
    double undecided = 0; ///< as in errors_of()
};

/// The measurements of a system on one set of particles.
struct SetFigures {
    std::string set{}; ///< its name
    Pace contains{};   ///< empty where sides were not queried
    Pace contacts{};   ///< empty where contacts were not queried
    /// Sides of contains_batch(), depths and normals of contacts_batch(); of a system that would take long
    /// for the whole set, of the particles that it was timed with.
    ErrorSummary errors{};
};

/// Lets all systems answer for a set on the calling thread, in turns.
/// @param radius  R of the mesh's bounding sphere
/// @return  figures for each system, in their order
/// @throws what report_progress throws
std::vector<SetFigures> measure(std::span<const rivals::System* const> systems, const JudgedSet& set,
                                double radius, const Effort& effort,
                                const std::function<void(double fraction)>& report_progress);

} // namespace echinus::comparison
