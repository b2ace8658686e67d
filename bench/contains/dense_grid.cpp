#include "rivals/systems/dense_grid/dense_grid.hpp"

#include "systems/ways.hpp"

using namespace echinus;

Ways contains_ways(const rivals::DenseGrid& grid, std::size_t point_count) {
    return {way_of<std::uint8_t>("vector loop", point_count,
                                 [&](auto points, auto inside) { grid.contains_batch(points, inside); })};
}
