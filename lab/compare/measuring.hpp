#pragma once

#include "compare/errors.hpp"
#include "compare/systems.hpp"
#include "compare/turns.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

/// Shared by `echinus compare` and the benchmarks: systems answer for a set of particles in turns, and a
/// judge measures the errors of the answers.
namespace echinus::comparison {

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
