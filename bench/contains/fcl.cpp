#include "rivals/fcl.hpp"

#include "systems/ways.hpp"

Ways contains_ways(const FclRival& fcl, std::size_t point_count) {
    return {way_one_by_one<std::uint8_t>("side of the nearest face", point_count,
                                         [&](const auto& point) { return fcl.contact(point).depth > 0; })};
}
