#pragma once

#include "subjects.hpp"

#include <functional>
#include <string>
#include <vector>

/// A structure to build over and over, on one thread.
struct TimedStructure {
    std::string system; ///< as tables show it
    bool is_ours;
    std::function<void()> build;
};

/// The exact map, built and rebuilt, the distance map, Embree and, up to 300 000 faces, CGAL.
/// @pre the subject outlives the result
std::vector<TimedStructure> builds_on(const Subject& subject);

/// Milliseconds of processor time of each, a number for each pass, from turns that they take.
/// @param report_progress  as in take_turns()
std::vector<echinus::comparison::Pace> time_builds(const std::vector<TimedStructure>& builds, int passes,
                                                   const std::function<void(double)>& report_progress);
