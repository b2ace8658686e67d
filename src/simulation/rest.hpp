#pragma once

#include <echinus/simulation.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Watches whether the particles have come to rest.
class RestWatch {
  public:
    RestWatch(const RestCondition& condition, const std::vector<Vec3f>& positions)
        : condition_(condition), places_(positions) {}

    /// To be called after each frame.
    void watch(const std::vector<Vec3f>& positions) {
        const bool all_stay =
            std::equal(positions.begin(), positions.end(), places_.begin(),
                       [limit = static_cast<float>(condition_.distance * condition_.distance)](
                           const Vec3f& position, const Vec3f& place) {
                           const Vec3f away = position - place;
                           return dot(away, away) <= limit;
                       });
        quiet_frame_count_ = all_stay ? quiet_frame_count_ + 1 : 0;
        if (!all_stay) places_ = positions;
    }
    bool at_rest() const { return quiet_frame_count_ >= condition_.frame_count; }

  private:
    RestCondition condition_;
    std::vector<Vec3f> places_; ///< where each particle was, quiet_frame_count_ frames ago
    std::uint32_t quiet_frame_count_ = 0;
};

} // namespace echinus
