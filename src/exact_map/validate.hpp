#pragma once

#include "directions/checker.hpp"

#include <echinus/exact_map.hpp>

namespace echinus {

/// Checks everything that keeps queries harmless, and what else one pass can check: bands, faces and tree
/// agree in their numbers, no integer of a query overflows, the tree is a tree and no deeper than a query's
/// stack, its boxes contain their faces. It does not check that the bands match the faces; where they do not,
/// answers are wrong. Takes at most some 2 % of the instructions of a build.
/// @throws Error Damaged
void validate(const Checker& checker, const ExactMapView& map, const ExactMapStatistics& statistics);

/// The last step of a build.
/// @throws Error Damaged where the map contradicts itself, through a fault of this library
ExactMap proven(const ExactMapView& map, const ExactMapStatistics& statistics, std::uint64_t source_hash,
                std::shared_ptr<const void> storage);

} // namespace echinus
