#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/geometry.hpp>

#include <algorithm>

namespace echinus {

/// 0 if there are no edges. @param positions  [particle_count] a container of points
template <typename Positions>
float mean_edge_length(const Elements& elements, const Positions& positions) {
    double sum = 0;
    for (const auto& [a, b] : elements.edges) sum += static_cast<double>(length(positions[a] - positions[b]));
    return elements.edges.empty() ? 0 : static_cast<float>(sum / static_cast<double>(elements.edges.size()));
}

/// The largest ratio of an edge's length to its length before, but at least 1.
template <typename Positions>
float largest_stretch(const Elements& elements, const Positions& before, const Positions& after) {
    float largest = 1;
    for (const auto& [a, b] : elements.edges) {
        const float length_before = length(before[a] - before[b]);
        if (length_before > 0) largest = std::max(largest, length(after[a] - after[b]) / length_before);
    }
    return largest;
}

} // namespace echinus
