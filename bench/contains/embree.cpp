#include "rivals/embree.hpp"

#include "systems/ways.hpp"

Ways contains_ways(const EmbreeRival& embree, std::size_t point_count) {
    const auto way = [&](const char* name, auto fill) {
        return way_of<std::uint8_t>(
            name, point_count, [=, &embree](auto points, auto inside) { (embree.*fill)(points, inside); });
    };
    return {way("first hit", &EmbreeRival::first_hits),
            way("first hit packets of 16", &EmbreeRival::first_hits_by_packets),
            way("parity", &EmbreeRival::parities),
            way("parity packets of 16", &EmbreeRival::parities_by_packets)};
}
