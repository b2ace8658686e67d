#pragma once

#include "simulation/state/state_archive.hpp"
#include "simulation/sticks.hpp"

#include <cstdint>

namespace echinus {

/// Opens knots. A stick that is stretched far pulls its ends through several layers of the deformable at
/// once, farther than contacts push back: truncation then holds the ends, in every frame again. So for some
/// time after truncation has held anything, sticks that are stretched far lose a tenth of their length in a
/// frame, and the layers between them have time to give way.
class GentleSticks {
  public:
    /// After each frame, or part of one.
    void note(bool was_anything_held);
    /// Sets the goal lengths for the frame that begins, while they are not the rest lengths or must not be.
    /// @pre no goal gives way
    void set_goals(StickArrays& sticks, const PointArrays& positions);

    void archive(StateArchive& state);

  private:
    std::uint32_t frames_left_ = 0;
    bool goals_are_rest_lengths_ = true;
};

} // namespace echinus
