#pragma once

#include "rivals/embree.hpp"
#include "stopwatch.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

#include <cstdint>
#include <span>

// Races over one set of points. Answers go to the caller, so that they can be compared and no compiler drops
// the work.

/// Scalar contains() of either kind of map, or Embree's answer.
template <typename Map>
Contestant asks_inside(const Map& map, const std::vector<echinus::Vec3f>& points,
                       std::vector<std::uint8_t>& answers) {
    answers.assign(points.size(), 0);
    return [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) answers[i] = contains(map, points[i]);
    };
}

inline bool contains(const EmbreeRival& rival, const echinus::Vec3f& point) {
    return rival.inside(point);
}

/// Scalar contact() of either kind of map without a margin; keeps the depth.
template <typename Map>
Contestant asks_contact(const Map& map, const std::vector<echinus::Vec3f>& points,
                        std::vector<float>& depths) {
    depths.assign(points.size(), 0);
    return [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) depths[i] = contact(map, points[i]).depth;
    };
}

/// The same of Embree: the sign, and the distance of what is inside.
inline Contestant asks_contact(const EmbreeRival& rival, const std::vector<echinus::Vec3f>& points,
                               std::vector<float>& depths) {
    depths.assign(points.size(), 0);
    return [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            depths[i] = rival.inside(points[i]) ? rival.distance(points[i]) : 0;
    };
}
