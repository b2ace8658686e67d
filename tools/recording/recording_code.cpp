#include "recording/recording_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace echinus;

namespace {

std::array<float, 3> coordinates(const Vec3f& point) {
    return {point.x, point.y, point.z};
}

struct Range {
    float least = std::numeric_limits<float>::infinity();
    float greatest = -least;
};

/// The range of a frame's coordinates along one axis.
Range range_of(const RecordedFrame& frame, std::size_t axis) {
    Range range;
    for (const Vec3f& position : frame.positions) {
        const float coordinate = coordinates(position)[axis];
        range.least = std::min(range.least, coordinate);
        range.greatest = std::max(range.greatest, coordinate);
    }
    return range;
}

using Coordinates = std::vector<std::uint16_t>;

/// Axis by axis, modulo 2^16.
Coordinates coordinates_of(const RecordedFrame& frame, const Lattice& lattice) {
    Coordinates result;
    result.reserve(3 * frame.positions.size());
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const Vec3f& position : frame.positions)
            result.push_back(static_cast<std::uint16_t>(lattice.index_of(coordinates(position)[axis])));
    return result;
}

/// 0, -1, 1, -2 ... to 0, 1, 2, 3 ...
std::uint16_t folded(std::uint16_t difference) {
    const bool negative = (difference & 0x8000U) != 0;
    return static_cast<std::uint16_t>(difference << 1U ^ (negative ? 0xffffU : 0U));
}

} // namespace

std::int64_t Lattice::index_of(float coordinate) const {
    return std::llround(coordinate / step);
}

Lattice lattice_of(std::span<const RecordedFrame> frames) {
    constexpr double kSteps = 65534; // and one more by rounding at both ends
    constexpr double kMostIndex = 1LL << 50U;
    double extent = 0, farthest = 0;
    for (const RecordedFrame& frame : frames) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Range range = range_of(frame, axis);
            extent = std::max(extent, double{range.greatest} - double{range.least});
            farthest = std::max({farthest, std::abs(double{range.least}), std::abs(double{range.greatest})});
        }
    }
    // A cloth that is a dot far away must not count in steps beyond what a browser's numbers hold.
    const double step = std::max(extent / kSteps, farthest / kMostIndex);
    return {step > 0 ? step : 1};
}

std::array<std::int64_t, 3> origin_of(const RecordedFrame& frame, const Lattice& lattice) {
    std::array<std::int64_t, 3> origin;
    for (std::size_t axis = 0; axis < 3; ++axis) origin[axis] = lattice.index_of(range_of(frame, axis).least);
    return origin;
}

void add_motion(Deflater& deflater, std::span<const RecordedFrame> frames, const Lattice& lattice) {
    if (frames.empty()) return;
    const std::size_t count = 3 * frames.front().positions.size();
    Coordinates before(count, 0), last(count, 0);
    std::vector<std::uint8_t> bytes(2 * count);
    for (const RecordedFrame& frame : frames) {
        Coordinates now = coordinates_of(frame, lattice);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint16_t code = folded(static_cast<std::uint16_t>(now[i] - 2U * last[i] + before[i]));
            bytes[i] = static_cast<std::uint8_t>(code);
            bytes[count + i] = static_cast<std::uint8_t>(code >> 8U);
        }
        deflater.add(bytes);
        before = std::move(last);
        last = std::move(now);
    }
}
