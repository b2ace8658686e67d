#include "rivals/fcl.hpp"

#include "systems/ways.hpp"

Ways contacts_ways(const FclRival& fcl, std::size_t point_count) {
    return {way_one_by_one<DepthNormal>("nearest face and its side", point_count,
                                        [&](const auto& point) { return fcl.contact(point); })};
}
