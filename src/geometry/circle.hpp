#pragma once

#include <cstdint>

namespace echinus {

/// A point of the unit circle.
struct CirclePoint {
    double cosine = 1;
    double sine = 0;
};

/// The point at 2 pi * index / count, within 1e-15 of the true one. Unlike std::sin and std::cos it gives the
/// same bits on every machine, and the points are exactly symmetric: index and count - index differ only in
/// the sign of the sine, and multiples of a quarter turn have no rounding error.
/// @pre count > 0 and both are at most 2^60
CirclePoint circle_point(std::uint64_t index, std::uint64_t count);

} // namespace echinus
