#include "rivals/embree.hpp"

#include "systems/ways.hpp"

using namespace echinus;

namespace {

void find_nearest(const EmbreeRival& embree, std::span<const Vec3f> points,
                  std::span<const std::uint8_t> inside, std::span<DepthNormal> contacts) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        contacts[i] = {};
        if (inside[i] == 0) continue;
        const auto [point, distance] = embree.nearest(points[i]);
        contacts[i] = {distance, (point - points[i]) * (1 / distance)};
    }
}

} // namespace

Ways contacts_ways(const EmbreeRival& embree, std::size_t point_count) {
    const auto inside = std::make_shared<std::vector<std::uint8_t>>(point_count);
    const auto way = [&](const char* name, auto find_signs) {
        return way_of<DepthNormal>(name, point_count, [=, &embree](auto points, auto contacts) {
            (embree.*find_signs)(points, *inside);
            find_nearest(embree, points, *inside, contacts);
        });
    };
    return {way("first hit then point query", &EmbreeRival::first_hits),
            way("first hit packets of 16 then point query", &EmbreeRival::first_hits_by_packets)};
}
