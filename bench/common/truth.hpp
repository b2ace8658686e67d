#pragma once

#include "common/subjects.hpp"
#include "rivals/compare/errors.hpp"

#include <filesystem>

/// The truth of a set: signs by CGAL's exact predicates, for the coordinates as they are, and distances found
/// in double. From the cache if it was asked for before. All cores judge.
/// @param cache  a folder, made when it does not exist; files are named for the bits of mesh and points
echinus::comparison::Truth truth_of(const Subject& subject, const ParticleSet& set,
                                    const std::filesystem::path& cache);
