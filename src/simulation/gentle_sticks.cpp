#include "simulation/gentle_sticks.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// In which a stick of twenty times its length comes down to its length.
constexpr std::uint32_t kFrames = 30;
constexpr float kMostGentleStretch = 1.3F; ///< in rest lengths
constexpr float kKept = 0.9F;              ///< of the length of a stretched stick, in a frame

} // namespace

void GentleSticks::note(bool was_anything_held) {
    frames_left_ = was_anything_held ? kFrames : frames_left_ - std::min(frames_left_, 1U);
}

void GentleSticks::set_goals(StickArrays& sticks, const PointArrays& positions) {
    const bool is_gentle = frames_left_ > 0;
    if (!is_gentle && goals_are_rest_lengths_) return;
    goals_are_rest_lengths_ = !is_gentle;
    std::copy(sticks.rest_lengths.begin(), sticks.rest_lengths.end(), sticks.goal_lengths.begin());
    if (!is_gentle) return;
    for (std::size_t i = 0; i < sticks.count(); ++i) {
        const Vec3f across = positions[sticks.b[i]] - positions[sticks.a[i]];
        const float length_sq = dot(across, across);
        const float most = kMostGentleStretch * sticks.rest_lengths[i];
        if (length_sq > most * most)
            sticks.goal_lengths[i] = std::max(sticks.rest_lengths[i], kKept * std::sqrt(length_sq));
    }
}

/// The goals themselves are made anew in each frame.
void GentleSticks::archive(StateArchive& state) {
    state.value(frames_left_);
    if (state.reads()) goals_are_rest_lengths_ = false;
}

} // namespace echinus
