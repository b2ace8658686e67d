#include "simulation/surfaces/turning_plane.hpp"

#include <algorithm>
#include <limits>

namespace echinus {

namespace {

/// A face that turns by a degree moves at its far end by hundreds of gaps, where layers all but touch: the
/// plane has to turn in as many pieces.
constexpr int kMostHalvings = 10;

using Points = std::array<Vec3f, 4>;

float gap_along(const Vec3f& normal, PairKind kind, const Points& points) {
    float least = std::numeric_limits<float>::infinity(), most = -least;
    for (std::size_t k = 0; k < 4; ++k) {
        const float height = dot(normal, points[k] - points[0]);
        if (k < own_count(kind))
            least = std::min(least, height);
        else
            most = std::max(most, height);
    }
    return least - most;
}

/// @param at_start, at_end  the planes there, which leave the gap
bool stay_apart_between(PairKind kind, const Points& from, const Separation& at_start, const Points& to,
                        const Separation& at_end, float least_gap, int halvings) {
    if (gap_along(at_start.normal, kind, to) >= least_gap) return true;
    if (gap_along(at_end.normal, kind, from) >= least_gap) return true;
    if (halvings == kMostHalvings) return false;
    Points middle;
    for (std::size_t k = 0; k < 4; ++k) middle[k] = from[k] + (to[k] - from[k]) * 0.5F;
    const Separation in_middle = separation(kind, middle);
    return in_middle.gap >= least_gap &&
           stay_apart_between(kind, from, at_start, middle, in_middle, least_gap, halvings + 1) &&
           stay_apart_between(kind, middle, in_middle, to, at_end, least_gap, halvings + 1);
}

} // namespace

bool stay_apart(PairKind kind, const Points& from, const Points& to, float least_gap) {
    const Separation at_start = separation(kind, from), at_end = separation(kind, to);
    return at_start.gap >= least_gap && at_end.gap >= least_gap &&
           stay_apart_between(kind, from, at_start, to, at_end, least_gap, 0);
}

} // namespace echinus
