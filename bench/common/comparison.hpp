#pragma once

#include "common/records.hpp"
#include "common/subjects.hpp"
#include "common/system.hpp"
#include "common/truth.hpp"
#include "common/turns.hpp"
#include "rivals/depth_normal.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

/// One way of one system, ready to be asked.
struct Competitor {
    std::string system, way;
    Role role;
    std::size_t bytes;
    double build_ms;
    bool as_whole; ///< gains by the number of particles in a call: never asked for parts of a set
    /// Answers for particles [first, first + points.size()) of the set, and keeps what it answered.
    std::function<void(std::span<const echinus::Vec3f> points, std::size_t first)> answer;
    /// What was answered for particle i; of a task that asks for the sign alone the depth is 1 or 0.
    std::function<DepthNormal(std::size_t i)> answered;
};

/// How thoroughly is measured.
struct Effort {
    std::size_t point_count = 1'000'000;     ///< per set
    std::size_t large_point_count = 200'000; ///< per set, of large meshes; 0 leaves these out
    int passes = 5;
    double patience_seconds = 0.5; ///< who would take longer for a set is asked for parts spread over it
    double enough_seconds = 3;     ///< who took so long in all passes is asked no more
};

/// What a comparison is about.
struct Comparison {
    std::string task; ///< "contains" or "contacts"
    bool has_depth;
    std::filesystem::path truth_cache;
    Effort effort;
    std::function<void(const std::string& what, double fraction)> report_progress;
};

/// The columns of a comparison's records.
Records comparison_records();

/// All of them, asked for a set: whole, in one call, or who is too slow for that, in parts.
std::vector<Racer> racers_for(const std::vector<Competitor>& competitors, const ParticleSet& set,
                              double patience_seconds);

/// Lets all answer for all particles of a set, judges what they said, and adds a record for each.
void compare(const Comparison& comparison, const Subject& subject, const ParticleSet& set,
             const std::vector<Competitor>& competitors, Records& records);

/// Builds a structure, several times over when that is quick. @returns milliseconds of processor time, the
/// median; the last that was built is left in `built`
template <typename System>
double time_build(const Listed<System>& listed, const echinus::TriangleMesh& mesh,
                  std::unique_ptr<System>& built);

/// Processor time of all threads of the process.
double process_seconds();

template <typename System>
double time_build(const Listed<System>& listed, const echinus::TriangleMesh& mesh,
                  std::unique_ptr<System>& built) {
    constexpr double kEnough = 0.1; // seconds
    constexpr std::size_t kMost = 9;
    std::vector<double> times;
    for (double sum = 0; times.empty() || (sum < kEnough && times.size() < kMost); sum += times.back()) {
        built = listed.make();
        built->plan(mesh);
        const double start = process_seconds();
        built->build(mesh);
        times.push_back(process_seconds() - start);
    }
    return 1e3 * median_of(times);
}
