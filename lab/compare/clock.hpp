#pragma once

#include <time.h>

namespace echinus::comparison {

inline double seconds_of(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time of the calling thread, which other programs on the machine prolong little. Medians of
/// several turns remove most of their remaining influence, through shared caches and the clock rate.
inline double thread_seconds() {
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

/// Processor time of all threads of the process.
inline double process_seconds() {
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

} // namespace echinus::comparison
