#pragma once

#include "simulation/surfaces/edge_lengths.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace echinus {

/// Of several states of particles, all made from one start, the first of those in which the fewest pairs
/// intersect and among them edges are stretched least.
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
    /// @pre a state was considered
    const std::vector<Vec3f>& get() const { return positions_; }
    std::size_t pair_count() const { return cost_.first; }

  private:
    const Elements& elements_;
    const std::vector<Vec3f>& start_;
    std::vector<Vec3f> positions_;
    std::pair<std::size_t, float> cost_{std::numeric_limits<std::size_t>::max(), 0.0F};
};

} // namespace echinus
