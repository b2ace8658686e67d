#pragma once

#include <time.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace echinus::comparison {

/// Items [begin, end).
struct Part {
    std::size_t begin, end;

    std::size_t size() const { return end - begin; }
};

/// A participant that takes turns.
struct Racer {
    /// Does its work for a part, in one call.
    std::function<void(Part)> run;
    /// Its work in a turn: all items in one part, or a sample of them.
    std::vector<Part> parts;
};

struct TurnOptions {
    std::size_t warm_up = 20'000; ///< items done before a part without being timed, as many as it has at most
    int passes = 5;
    double enough_seconds =
        std::numeric_limits<double>::infinity(); ///< a racer that was timed this long drops out
    bool all_threads = false;                    ///< time those that a racer starts, too
    std::function<void(double fraction)> report_progress;
};

/// The times of a racer.
struct Pace {
    double ns;                   ///< per item: the median over passes
    double spread;               ///< half the distance between their quartiles, by it; NaN after one pass
    std::vector<double> pass_ns; ///< [passes, or fewer for one that dropped out] per item
};

/// Races on the calling thread, by its processor time unless all threads count. All racers take their turn,
/// there and back, `passes` times over, so that a machine that changes its pace hits all alike. Before each
/// part each runs for a while on the items before it, or on its first where there are none: its tables, not
/// another's, are then in the caches, as they would be in a program that uses one of them.
std::vector<Pace> take_turns(const std::vector<Racer>& racers, const TurnOptions& options);

/// The work of a racer in a turn: all items in one part if this takes at most `patience_seconds` according to
/// a short trial; otherwise as many parts of a thousand items as it can do in that time, at least ten, spread
/// evenly over all items.
std::vector<Part> parts_for(const std::function<void(Part)>& run, std::size_t item_count,
                            double patience_seconds);

double median_of(std::vector<double> values);

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

/// Keeps the calling thread, and threads that it starts from now on, on one core: the last of those it may
/// use, which the system uses least.
void pin_to_one_core();

/// Lets the calling thread run on every core again.
void unpin();

} // namespace echinus::comparison
