#pragma once

#include "simulation/surfaces/edge_lengths.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace echinus {

/// Of several attempts to part what intersects, all from the same start, the first of those that leave the
/// fewest pairs and among them stretch edges least.
class BestPlaces {
  public:
    BestPlaces(const Elements& elements, const std::vector<Vec3f>& start)
        : elements_(elements), start_(start) {}

    /// @param left  the pairs that still intersect
    void consider(const std::vector<Vec3f>& positions, std::size_t left) {
        const std::pair cost{left, largest_stretch(elements_, start_, positions)};
        if (cost >= cost_) return;
        cost_ = cost;
        positions_ = positions;
    }
    const std::vector<Vec3f>& get() const { return positions_; }
    bool moved() const { return positions_ != start_; }

  private:
    const Elements& elements_;
    const std::vector<Vec3f>& start_;
    std::vector<Vec3f> positions_;
    std::pair<std::size_t, float> cost_{std::numeric_limits<std::size_t>::max(), 0.0F};
};

} // namespace echinus
