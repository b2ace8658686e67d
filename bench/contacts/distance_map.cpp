#include "systems/our_ways.hpp"
#include "systems/ways.hpp"

#include <echinus/distance_map.hpp>

using namespace echinus;

Ways contacts_ways(const DistanceMap& map, std::size_t point_count) {
    return our_ways<Contact>(
        point_count, [&](auto points, auto contacts) { contacts_batch(map.view(), points, 0, contacts); },
        [&](const Vec3f& point) { return contact(map.view(), point); });
}
