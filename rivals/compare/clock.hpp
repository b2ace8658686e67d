#pragma once

#include <time.h>

namespace echinus::comparison {

inline double seconds_of(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time of the calling thread: other programs on the machine prolong it little. What they still
/// add, through shared caches and the clock rate, medians of several turns are nearly free of.
inline double thread_seconds() {
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

/// Processor time of all threads of the process.
inline double process_seconds() {
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

} // namespace echinus::comparison
