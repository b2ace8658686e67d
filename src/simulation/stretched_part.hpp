#pragma once

#include "simulation/state/state_archive.hpp"
#include "simulation/sticks.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The part of a deformable that is stretched far: sticks that are longer than they should be, and what is
/// around them. Where cloth hangs over a tip on both sides, sticks pull their ends into the model and contact
/// pushes them out again, and only what is left of both lifts them. Such places need more relaxations than
/// all the rest, and are small.
class StretchedPart {
  public:
    /// Allocates all that find() needs.
    StretchedPart(const StickArrays& sticks, std::size_t particle_count);

    /// Looks at all sticks, which takes a third of the time of relaxing them; call every kFrames frames.
    /// Finds nothing where much is stretched: then the whole is in motion, and it would take too long.
    void find(const StickArrays& sticks, const PointArrays& positions);
    static constexpr std::uint32_t kFrames = 8;

    bool empty() const { return sticks_.empty(); }
    /// In the order in which they are relaxed.
    std::span<const std::uint32_t> sticks() const { return sticks_; }
    /// [particle_count] 1: takes part.
    std::span<const std::uint8_t> particles() const { return is_part_; }

    void archive(StateArchive& state, std::size_t stick_count);

  private:
    void widen(const StickArrays& sticks);

    std::vector<std::uint32_t> sticks_;
    std::vector<std::uint8_t> is_part_, wider_;
};

} // namespace echinus
