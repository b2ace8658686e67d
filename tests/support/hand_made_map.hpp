#pragma once

#include <echinus/distance_map.hpp>

#include <cstdint>
#include <vector>

namespace echinus::test {

/// A map with given entries rather than ones built from a mesh: centre 0, R = 1, pole axis z.
class HandMadeMap {
  public:
    HandMadeMap(std::uint32_t longitude_count, std::uint32_t colatitude_count, bool centre_inside)
        : longitude_count_(longitude_count), colatitude_count_(colatitude_count),
          centre_inside_(centre_inside), lists_(std::size_t{longitude_count} * colatitude_count) {}

    std::vector<float>& entries(std::uint32_t longitude, std::uint32_t colatitude) {
        return lists_[std::size_t{colatitude} * longitude_count_ + longitude];
    }
    void fill(const std::vector<float>& entries) {
        for (auto& list : lists_) list = entries;
    }

    /// Valid as long as this object lives and is not changed.
    DistanceMapView view() {
        offsets_.assign(1, 0);
        entries_.clear();
        for (const auto& list : lists_) {
            entries_.insert(entries_.end(), list.begin(), list.end());
            offsets_.push_back(static_cast<std::uint32_t>(entries_.size()));
        }
        DistanceMapView map;
        map.radius = 1;
        map.longitude_count = longitude_count_;
        map.colatitude_count = colatitude_count_;
        map.centre_inside = centre_inside_;
        map.entry_offsets = offsets_;
        map.entries_float32 = entries_;
        return map;
    }

  private:
    std::uint32_t longitude_count_, colatitude_count_;
    bool centre_inside_;
    std::vector<std::vector<float>> lists_;
    std::vector<std::uint32_t> offsets_;
    std::vector<float> entries_;
};

} // namespace echinus::test
