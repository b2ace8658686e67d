#include "rivals/bullet.hpp"

#include "systems/ways.hpp"

Ways contains_ways(const BulletRival& bullet, std::size_t point_count) {
    return {way_one_by_one<std::uint8_t>("first hit", point_count,
                                         [&](const auto& point) { return bullet.inside(point); })};
}
