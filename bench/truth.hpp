#pragma once

#include "subjects.hpp"

#include <filesystem>

/// The true answers for a set: sides by CGAL's exact predicates, for the given coordinates, and distances in
/// double. From the cache if the set was judged before. Uses all cores.
/// @param cache  a folder, made when it does not exist; files are named for the bits of mesh and points
void judge(const Subject& subject, const std::filesystem::path& cache, echinus::comparison::JudgedSet& set);
