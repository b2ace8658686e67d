#pragma once

#include "simulation/sticks.hpp"

#include <cstddef>

namespace echinus {

/// Cuts the runs of sticks into tiles for several threads.
///
/// A long run without a common particle is a step of its own, cut by its length. Those of a sheet are short,
/// and each needs the one before, from row to row. But
///
/// - the runs along a row come before all others that touch it, and need nothing;
/// - of those that join rows, what lies far to the left needs nothing that lies far to the right. They are
///   cut as loops over grids are that are swept again and again (wavefronts; Lamport 1974, "The Parallel
///   Execution of DO Loops"): by runs, into groups of some rows, and by places, into columns that lean to the
///   left from row to row, since diagonals reach beyond them there. Group g of column k needs what is above
///   it and to its left, and no more; so all with the same g + k make a step.
///
/// What is right does not depend on rows and columns being found well: a stick stands in the last column of
/// any stick before that has a particle in common with it, or beyond.
/// @param thread_count  that share them, at least 2; so many columns a sheet has. The bits do not depend on
/// it
StickTiles cut_into_tiles(const StickArrays& sticks, std::size_t particle_count, std::size_t thread_count);

} // namespace echinus
