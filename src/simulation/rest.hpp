#pragma once

#include "simulation/state/state_archive.hpp"

#include <echinus/simulation.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace echinus {

/// Watches whether the particles have come to rest.
class RestWatch {
  public:
    RestWatch(const RestCondition& condition, const std::vector<Vec3f>& positions)
        : condition_(condition), places_(positions) {}

    /// To be called after each frame. @param is_stopped  particles were stopped in it, which does not count
    /// as rest
    void watch(const std::vector<Vec3f>& positions, double largest_speed, bool is_stopped = false) {
        const bool all_near = all_stay(positions);
        if (!all_near) places_ = positions;
        quiet_frame_count_ =
            all_near && !is_stopped && largest_speed <= condition_.speed ? quiet_frame_count_ + 1 : 0;
    }
    bool at_rest() const { return quiet_frame_count_ >= condition_.frame_count; }

    void archive(StateArchive& state) {
        state.array(places_);
        state.value(quiet_frame_count_);
    }

  private:
    bool all_stay(const std::vector<Vec3f>& positions) const {
        const auto distance_sq = static_cast<float>(condition_.distance * condition_.distance);
        return std::equal(positions.begin(), positions.end(), places_.begin(),
                          [=](const Vec3f& position, const Vec3f& place) {
                              const Vec3f away = position - place;
                              return dot(away, away) <= distance_sq;
                          });
    }

    RestCondition condition_;
    /// Positions near which all particles have stayed for at least quiet_frame_count_ frames.
    std::vector<Vec3f> places_;
    std::uint32_t quiet_frame_count_ = 0;
};

} // namespace echinus
