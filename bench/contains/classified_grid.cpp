#include "rivals/systems/classified_grid/classified_grid.hpp"

#include "systems/ways.hpp"

using namespace echinus;

Ways contains_ways(const rivals::ClassifiedGrid& grid, std::size_t point_count) {
    Way batch = way_of<std::uint8_t>("batch", point_count,
                                     [&](auto points, auto inside) { grid.contains_batch(points, inside); });
    batch.as_whole = true;
    return {std::move(batch)};
}
