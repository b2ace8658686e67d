#pragma once

namespace echinus {

/// Times of frames are multiples of a rounded step: a frame that begins so little before something is due has
/// it, in seconds.
inline constexpr double kRoundingOfTimes = 1e-9;

/// @param now  when a frame begins
inline bool is_due(double due, double now) {
    return now + kRoundingOfTimes >= due;
}

} // namespace echinus
