#include "common/turns.hpp"

#include "common/stopwatch.hpp"

#include <algorithm>
#include <cmath>

namespace {

double quantile(const std::vector<double>& sorted, double q) {
    const double place = q * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (sorted[above] - sorted[below]) * (place - static_cast<double>(below));
}

/// Seconds for one racer's part of a block.
double timed(const Racer& racer, std::size_t begin, std::size_t end, std::size_t warm_up) {
    const std::size_t warm_begin = begin - std::min(begin, warm_up);
    if (warm_begin < begin)
        racer.run(warm_begin, begin);
    else
        racer.run(begin, std::min(begin + warm_up, end)); // the first block has none before it
    const double start = thread_seconds();
    racer.run(begin, end);
    return thread_seconds() - start;
}

} // namespace

double median_of(std::vector<double> values) {
    std::ranges::sort(values);
    return values.empty() ? std::nan("") : quantile(values, 0.5);
}

std::size_t share_for(const Racer& racer, std::size_t item_count, std::size_t block_size,
                      double patience_seconds) {
    const std::size_t trial = std::min<std::size_t>(item_count, 1000);
    racer.run(0, trial);
    const double start = thread_seconds();
    racer.run(0, trial);
    const double seconds = (thread_seconds() - start) / static_cast<double>(trial);
    if (seconds * static_cast<double>(block_size) <= patience_seconds) return block_size;
    return std::max<std::size_t>(trial, static_cast<std::size_t>(patience_seconds / 4 / seconds));
}

std::vector<Pace> take_turns(std::size_t item_count, const std::vector<Racer>& racers,
                             const TurnOptions& options) {
    const auto passes = static_cast<std::size_t>(options.passes);
    const std::size_t block_count = (item_count + options.block_size - 1) / options.block_size;
    std::vector<Pace> paces(racers.size());
    for (Pace& pace : paces) pace.pass_ns.assign(passes, 0);
    std::vector<std::vector<double>> times(racers.size(), std::vector<double>(passes));
    std::size_t turns_done = 0;
    for (std::size_t begin = 0; begin < item_count; begin += options.block_size) {
        const std::size_t block_end = std::min(begin + options.block_size, item_count);
        for (std::size_t pass = 0; pass < passes; ++pass)
            for (std::size_t turn = 0; turn < racers.size(); ++turn) {
                const std::size_t k = pass % 2 == 0 ? turn : racers.size() - 1 - turn;
                const std::size_t end = begin + std::min(racers[k].block_share, block_end - begin);
                times[k][pass] = timed(racers[k], begin, end, std::min(options.warm_up, end - begin)) * 1e9 /
                                 static_cast<double>(end - begin);
                ++turns_done;
                if (options.report_progress)
                    options.report_progress(static_cast<double>(turns_done) /
                                            static_cast<double>(block_count * passes * racers.size()));
            }
        for (std::size_t k = 0; k < racers.size(); ++k) {
            for (std::size_t pass = 0; pass < passes; ++pass)
                paces[k].pass_ns[pass] += times[k][pass] / static_cast<double>(block_count);
            std::vector<double> sorted = times[k];
            std::ranges::sort(sorted);
            const double median = quantile(sorted, 0.5);
            paces[k].ns += median / static_cast<double>(block_count);
            paces[k].spread += (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / 2 / median /
                               static_cast<double>(block_count);
        }
    }
    return paces;
}
