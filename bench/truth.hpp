#pragma once

#include "subjects.hpp"

#include <filesystem>

/// Finds what is true of a set: sides by CGAL's exact predicates, for the coordinates as they are, and
/// distances in double. From the cache if the set was judged before. All cores judge.
/// @param cache  a folder, made when it does not exist; files are named for the bits of mesh and points
void judge(const Subject& subject, const std::filesystem::path& cache, echinus::comparison::JudgedSet& set);
