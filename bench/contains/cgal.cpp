#include "rivals/cgal.hpp"

#include "systems/ways.hpp"

Ways contains_ways(const CgalRival& cgal, std::size_t point_count) {
    return {way_one_by_one<std::uint8_t>("side", point_count,
                                         [&](const auto& point) { return cgal.inside(point); })};
}
