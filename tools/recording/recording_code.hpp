#pragma once

#include "encoding.hpp"
#include "recording/recording.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// How a page holds the positions of a recording (docs/command_line.md has the whole format). Positions are
/// rounded to a lattice; a coordinate is a whole number of its steps, of which the page keeps 16 bits; the
/// rest follows from the frame's origin, since no frame is larger than 2^16 - 1 steps.
struct Lattice {
    double step; ///< units; a coordinate is wrong by half of it at most, and the rounding to float

    std::int64_t index_of(float coordinate) const;
};

/// The finest lattice on which each frame has room: the step is 1 / 65534 of the largest extent of any frame
/// along any axis.
Lattice lattice_of(std::span<const RecordedFrame> frames);

/// The smallest coordinates of a frame's particles, in steps.
std::array<std::int64_t, 3> origin_of(const RecordedFrame& frame, const Lattice& lattice);

/// Adds each frame's coordinates as their second differences in time, modulo 2^16: the deviation from uniform
/// motion. Axis by axis; small differences of either sign become small numbers (0, -1, 1, -2 ... as 0, 1, 2,
/// 3 ...), of which first all low bytes are written and then all high ones, mostly zero.
void add_motion(Deflater& deflater, std::span<const RecordedFrame> frames, const Lattice& lattice);
