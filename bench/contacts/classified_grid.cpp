#include "rivals/systems/classified_grid/classified_grid.hpp"

#include "systems/ways.hpp"

using namespace echinus;

Ways contacts_ways(const rivals::ClassifiedGrid& grid, std::size_t point_count) {
    Way batch = way_of<Contact>(
        "batch", point_count, [&](auto points, auto contacts) { grid.contacts_batch(points, 0, contacts); });
    batch.as_whole = true;
    return {std::move(batch)};
}
