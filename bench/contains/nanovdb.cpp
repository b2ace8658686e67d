#include "rivals/vdb.hpp"
#include "systems/ways.hpp"

Ways contains_ways(const NanoVdbRival& grid, std::size_t point_count) {
    return {way_of<std::uint8_t>("trilinear", point_count,
                                 [&](auto points, auto inside) { grid.contains(points, inside); })};
}
