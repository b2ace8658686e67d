#include "rivals/vdb.hpp"
#include "systems/ways.hpp"

Ways contacts_ways(const OpenVdbRival& grid, std::size_t point_count) {
    return {way_of<DepthNormal>("trilinear with gradient", point_count,
                                [&](auto points, auto contacts) { grid.contacts(points, contacts); })};
}
