#include "compare/turns.hpp"

#include <sched.h>

#include <algorithm>
#include <cmath>

namespace echinus::comparison {

namespace {

double quantile(const std::vector<double>& sorted, double q) {
    const double place = q * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (sorted[above] - sorted[below]) * (place - static_cast<double>(below));
}

double seconds_of(const std::function<void(Part)>& run, Part part, bool all_threads) {
    const auto now = all_threads ? process_seconds : thread_seconds;
    const double start = now();
    run(part);
    return now() - start;
}

Part before(Part part, std::size_t item_count) {
    const std::size_t count = std::min(item_count, part.size());
    if (part.begin < count) return {part.begin, part.begin + count};
    return {part.begin - count, part.begin};
}

/// Seconds that a racer takes for its parts.
double turn_seconds(const Racer& racer, const TurnOptions& options) {
    double seconds = 0;
    for (const Part& part : racer.parts) {
        racer.run(before(part, options.warm_up));
        seconds += seconds_of(racer.run, part, options.all_threads);
    }
    return seconds;
}

std::size_t item_count_of(const std::vector<Part>& parts) {
    std::size_t count = 0;
    for (const Part& part : parts) count += part.size();
    return count;
}

Pace pace_of(std::vector<double> pass_ns) {
    std::vector<double> sorted = pass_ns;
    std::ranges::sort(sorted);
    const double median = quantile(sorted, 0.5);
    const double spread = (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / 2 / median;
    return {median, sorted.size() > 1 ? spread : std::nan(""), std::move(pass_ns)};
}

/// In the middle of each of `part_count` equal stretches.
std::vector<Part> spread_parts(std::size_t item_count, std::size_t part_count, std::size_t part_size) {
    std::vector<Part> parts;
    for (std::size_t k = 0; k < part_count; ++k) {
        const std::size_t begin = (2 * k + 1) * item_count / (2 * part_count) - part_size / 2;
        parts.push_back({begin, begin + part_size});
    }
    return parts;
}

} // namespace

double median_of(std::vector<double> values) {
    std::ranges::sort(values);
    return values.empty() ? std::nan("") : quantile(values, 0.5);
}

std::vector<Part> parts_for(const std::function<void(Part)>& run, std::size_t item_count,
                            double patience_seconds) {
    constexpr std::size_t kPart = 1000, kMinParts = 10;
    const std::vector<Part> whole{{0, item_count}};
    if (item_count <= kMinParts * kPart) return whole;
    double seconds = 0; // for a part
    for (const Part& part : spread_parts(item_count, kMinParts, kPart))
        seconds += seconds_of(run, part, false) / kMinParts;
    const double affordable = patience_seconds / seconds;
    if (affordable * kPart >= static_cast<double>(item_count)) return whole;
    return spread_parts(item_count, std::max(static_cast<std::size_t>(affordable), kMinParts), kPart);
}

std::vector<Pace> take_turns(const std::vector<Racer>& racers, const TurnOptions& options) {
    std::vector<std::vector<double>> pass_ns(racers.size());
    std::vector<double> seconds(racers.size());
    for (int pass = 0; pass < options.passes; ++pass)
        for (std::size_t turn = 0; turn < racers.size(); ++turn) {
            const std::size_t k = pass % 2 == 0 ? turn : racers.size() - 1 - turn;
            if (seconds[k] > options.enough_seconds) continue;
            const double turn_took = turn_seconds(racers[k], options);
            seconds[k] += turn_took;
            pass_ns[k].push_back(1e9 * turn_took / static_cast<double>(item_count_of(racers[k].parts)));
            if (options.report_progress)
                options.report_progress(
                    (pass + static_cast<double>(turn + 1) / static_cast<double>(racers.size())) /
                    options.passes);
        }
    std::vector<Pace> paces;
    for (std::vector<double>& of_racer : pass_ns) paces.push_back(pace_of(std::move(of_racer)));
    return paces;
}

namespace {

/// The cores that the process may use, before anything was pinned.
const cpu_set_t& all_cores() {
    static const cpu_set_t cores = [] {
        cpu_set_t set;
        CPU_ZERO(&set);
        sched_getaffinity(0, sizeof(set), &set);
        return set;
    }();
    return cores;
}

} // namespace

void pin_to_one_core() {
    int last = 0;
    for (int core = 0; core < CPU_SETSIZE; ++core)
        if (CPU_ISSET(core, &all_cores())) last = core;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(last, &one);
    sched_setaffinity(0, sizeof(one), &one);
}

void unpin() {
    sched_setaffinity(0, sizeof(cpu_set_t), &all_cores());
}

} // namespace echinus::comparison
