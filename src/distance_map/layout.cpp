#include "distance_map/layout.hpp"

#include <utility>

namespace echinus {

DistanceMap::DistanceMap(const DistanceMapView& view, const DistanceMapStatistics& statistics,
                         std::uint64_t source_hash, std::shared_ptr<const void> storage)
    : view_(view), statistics_(statistics), source_hash_(source_hash), storage_(std::move(storage)) {}

std::size_t DistanceMapView::direction_count() const {
    return with_grid(*this, [](const auto& one) { return one.direction_count(); });
}

float DistanceMapView::largest_entry() const {
    return with_grid(*this, [this](const auto& one) { return one.largest_entry(radius); });
}

std::vector<std::size_t> entry_histogram(const DistanceMapView& map) {
    std::vector<std::size_t> histogram;
    const std::size_t direction_count = map.direction_count();
    for (std::uint32_t direction = 0; direction < direction_count; ++direction) {
        const std::uint32_t count = entry_count_of(map, direction);
        if (histogram.size() <= count) histogram.resize(count + 1);
        ++histogram[count];
    }
    return histogram;
}

} // namespace echinus
