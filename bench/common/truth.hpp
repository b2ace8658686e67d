#pragma once

#include "common/subjects.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

/// What is true of a set of particles.
struct Truth {
    std::vector<std::uint8_t> inside; ///< [n] by CGAL's exact predicates, for the coordinates as they are
    std::vector<float> distance;      ///< [n] to the nearest point of the surface, found in double
};

/// The truth of a set, from the cache if it was asked for before. All cores judge.
/// @param cache  a folder, made when it does not exist; files are named for the bits of mesh and points
Truth truth_of(const Subject& subject, const ParticleSet& set, const std::filesystem::path& cache);

/// How far answers are from the truth, over the particles that were asked.
struct ErrorSummary {
    double wrong_share = 0;    ///< of signs
    double farthest_wrong = 0; ///< distance of a wrong particle from the surface, R
    /// Of the depth, R: over particles that are inside, one that was missed counting as depth 0.
    double depth_mean = 0, depth_99 = 0, depth_worst = 0;
};

/// @param asked   the numbers of the particles that were
/// @param inside  [asked] the answers
/// @param depth   [asked] positive inside, or empty when only the sign was asked
ErrorSummary errors_of(const Truth& truth, double radius, std::span<const std::uint32_t> asked,
                       std::span<const std::uint8_t> inside, std::span<const float> depth);
