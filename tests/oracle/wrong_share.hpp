#pragma once

#include "judges/exact_judge.hpp"

#include <echinus/distance_map.hpp>

namespace echinus::test {

/// The percentage of the points that a map puts on the wrong side.
inline double wrong_share(const DistanceMapView& map, const ExactJudge& judge,
                          const std::vector<Vec3f>& points) {
    std::size_t wrong_count = 0;
    for (const Vec3f& p : points) wrong_count += contains(map, p) != judge.inside(p);
    return 100 * static_cast<double>(wrong_count) / static_cast<double>(points.size());
}

} // namespace echinus::test
