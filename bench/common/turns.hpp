#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// One of those that take turns: does its work for items [begin, end).
struct Racer {
    std::function<void(std::size_t begin, std::size_t end)> run;
    /// Of each block, how many items it does: all, or for what is slow only the first.
    std::size_t block_share = static_cast<std::size_t>(-1);
};

struct TurnOptions {
    std::size_t block_size = 100'000;
    std::size_t warm_up = 20'000; ///< items done before a block without being timed
    int passes = 5;
    std::function<void(double fraction)> report_progress;
};

/// What a racer took.
struct Pace {
    double ns = 0;     ///< per item: mean over blocks of the median over passes
    double spread = 0; ///< half the distance between the quartiles of a block's times, by their median; the
                       ///< mean over blocks
    std::vector<double> pass_ns; ///< [passes] per item: mean over blocks
};

/// Races on the calling thread, by its processor time. For each block of items all racers take their turn,
/// there and back, `passes` times over, so that a machine that changes its pace hits all alike. Before it is
/// timed, each runs for a while on the items before the block: its tables, not another's, are then in the
/// caches, as they would be in a program that uses one of them.
std::vector<Pace> take_turns(std::size_t item_count, const std::vector<Racer>& racers,
                             const TurnOptions& options);

/// How much of a block a racer should do, by a short trial: all of it if that takes no longer than
/// `patience`, and otherwise what it does in a quarter of that time.
std::size_t share_for(const Racer& racer, std::size_t item_count, std::size_t block_size,
                      double patience_seconds);

double median_of(std::vector<double> values);
