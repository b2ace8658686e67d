#include "stopwatch.hpp"

#include "rivals/compare/clock.hpp"

#include <algorithm>
#include <limits>

using echinus::comparison::thread_seconds;

double shortest_seconds(int repetitions, const std::function<void()>& body) {
    double shortest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < repetitions; ++i) {
        const double start = thread_seconds();
        body();
        shortest = std::min(shortest, thread_seconds() - start);
    }
    return shortest;
}

std::vector<double> race(std::size_t item_count, int repetitions, std::span<const Contestant> contestants) {
    // Long enough to read the clock beside it, short enough to be left alone now and then.
    constexpr std::size_t kBlockSize = 5000;
    std::vector<double> seconds(contestants.size());
    for (std::size_t begin = 0; begin < item_count; begin += kBlockSize) {
        const std::size_t end = std::min(begin + kBlockSize, item_count);
        std::vector<double> shortest(contestants.size(), std::numeric_limits<double>::infinity());
        for (int i = 0; i < repetitions; ++i)
            for (std::size_t turn = 0; turn < contestants.size(); ++turn) {
                const std::size_t k = i % 2 == 0 ? turn : contestants.size() - 1 - turn;
                shortest[k] = std::min(shortest[k], shortest_seconds(1, [&] { contestants[k](begin, end); }));
            }
        for (std::size_t k = 0; k < contestants.size(); ++k) seconds[k] += shortest[k];
    }
    for (double& s : seconds) s *= 1e9 / static_cast<double>(std::max<std::size_t>(item_count, 1));
    return seconds;
}
