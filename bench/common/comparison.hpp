#pragma once

#include "common/records.hpp"
#include "common/subjects.hpp"
#include "common/system.hpp"
#include "common/truth.hpp"
#include "rivals/compare/turns.hpp"

#include <functional>
#include <string>
#include <vector>

/// One way of one system, ready to be asked.
struct Competitor {
    std::string system;
    Role role;
    double build_ms;     ///< processor time, the median of several when it is quick
    Structure structure; ///< that the way asks
    Way way;
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
    Task task;
    std::filesystem::path truth_cache;
    Effort effort;
    std::function<void(const std::string& what, double fraction)> report_progress;
};

/// "contains" or "contacts"
const char* name_of(Task task);

/// Builds all systems.
/// @param point_count  of the largest set that they will be asked for
/// @param one_way      only the first way of each system, which is its best
std::vector<Competitor> build_all(const std::vector<System>& systems, std::size_t point_count,
                                  bool one_way = false);

/// The columns of a comparison's records.
Records comparison_records();

/// All of them, asked for a set: whole, in one call, or who is too slow for that, in parts.
std::vector<echinus::comparison::Racer> racers_for(const std::vector<Competitor>& competitors,
                                                   const ParticleSet& set, double patience_seconds);

/// Lets all answer for all particles of a set, judges what they said, and adds a record for each.
void compare(const Comparison& comparison, const Subject& subject, const ParticleSet& set,
             const std::vector<Competitor>& competitors, Records& records);
