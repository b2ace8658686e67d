#include "systems/our_ways.hpp"
#include "systems/ways.hpp"

#include <echinus/exact_map.hpp>

using namespace echinus;

Ways contains_ways(const ExactMap& map, std::size_t point_count) {
    return our_ways<std::uint8_t>(
        point_count, [&](auto points, auto inside) { contains_batch(map.view(), points, inside); },
        [&](const Vec3f& point) { return contains(map.view(), point); });
}
