#pragma once

#include "subjects.hpp"

#include <cstdint>
#include <filesystem>

/// The reference for inside or outside.
enum class SideJudge : std::uint8_t {
    Parity,        ///< CGAL's exact predicates, for the given coordinates; of a closed mesh without overlaps
    WindingNumber, ///< the generalised winding number is above 1/2: the sum over all faces, in double
};

/// The true answers for a set: sides, and distances in double. From the cache if the set was judged before.
/// Uses all cores.
/// @param cache  a folder, made when it does not exist; files are named for the bits of mesh and points
void judge(const Subject& subject, const std::filesystem::path& cache, echinus::comparison::JudgedSet& set,
           SideJudge side_judge = SideJudge::Parity);
