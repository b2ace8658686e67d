#pragma once

#include "simulation/surfaces/edge_lengths.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace echinus {

/// From several states of particles that were made from one start, keeps the first with the fewest
/// intersecting pairs and, among these, the least stretch of edges.
class BestPlaces {
  public:
    BestPlaces(const Elements& elements, const std::vector<Vec3f>& start)
        : elements_(elements), start_(start) {}

    void consider(const std::vector<Vec3f>& positions, std::size_t pair_count) {
        if (pair_count > cost_.first) return;
        const std::pair cost{pair_count, largest_stretch(elements_, start_, positions)};
        if (cost >= cost_) return;
        cost_ = cost;
        positions_ = positions;
    }
    /// @pre a state has been considered
    const std::vector<Vec3f>& get() const { return positions_; }
    std::size_t pair_count() const { return cost_.first; }

  private:
    const Elements& elements_;
    const std::vector<Vec3f>& start_;
    std::vector<Vec3f> positions_;
    std::pair<std::size_t, float> cost_{std::numeric_limits<std::size_t>::max(), 0.0F};
};

} // namespace echinus
