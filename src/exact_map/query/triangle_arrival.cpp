#include "exact_map/query/triangle_arrival.hpp"

#include "exact_map/query/triangle_distance.hpp"

#include <algorithm>
#include <limits>

namespace echinus {

namespace {

struct Edge {
    std::size_t start, end; ///< corners
    double difference;      ///< of their ways
};

/// The edge whose ends move the most differently.
Edge widest_apart(const TriangleCorners& way) {
    Edge widest{0, 1, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const Edge edge{k, (k + 1) % 3, length(way[(k + 1) % 3] - way[k])};
        if (edge.difference > widest.difference) widest = edge;
    }
    return widest;
}

MovingTriangle half_of(const MovingTriangle& whole, std::size_t kept, std::size_t other) {
    MovingTriangle half = whole;
    half.from[other] = (whole.from[kept] + whole.from[other]) * 0.5;
    half.way[other] = (whole.way[kept] + whole.way[other]) * 0.5;
    return half;
}

/// How long no corner comes to the plane that bounds a gap on the side of the standing triangle.
double time_to_plane(const TriangleCorners& moving, const TriangleCorners& way,
                     const TriangleCorners& standing, const Vec3d& direction, double rounding) {
    const Vec3d unit = direction * (1 / length(direction));
    const Vec3d& origin = standing[0];
    const double plane =
        std::max({0.0, dot(unit, standing[1] - origin), dot(unit, standing[2] - origin)}) + rounding;
    double time = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        const double speed = -dot(unit, way[k]);
        if (speed > 0) time = std::min(time, (dot(unit, moving[k] - origin) - plane) / speed);
    }
    return time * (1 - 0x1p-40);
}

} // namespace

std::optional<double> arrival(const MovingTriangle& moving, const TriangleCorners& standing, double start,
                              double last, const ArrivalTolerance& tolerance) noexcept {
    constexpr int kMovesOfWhole = 8;
    double time = start;
    for (int move = 1; time <= last; ++move) {
        const TriangleCorners now = moving.at(time);
        const double rounding = rounding_of(now, tolerance.rounded_extent);
        const TriangleGap gap = gap_between(now, standing);
        if (gap.width - rounding <= tolerance.reach) return time;
        time += time_to_plane(now, moving.way, standing, gap.direction, rounding);
        if (move < kMovesOfWhole || time > last) continue;
        const Edge edge = widest_apart(moving.way);
        if (edge.difference * (last - time) <= tolerance.reach / 2) continue;
        const auto first = arrival(half_of(moving, edge.start, edge.end), standing, time, last, tolerance);
        const auto second =
            arrival(half_of(moving, edge.end, edge.start), standing, time, first.value_or(last), tolerance);
        return second ? second : first;
    }
    return std::nullopt;
}

} // namespace echinus
