#include "build/threads.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

#include <memory>

using namespace echinus;

namespace {

template <typename Map>
void list_batches_of(const char* name, const Map& map, const std::vector<Vec3f>& points,
                     std::vector<BuildWay>& ways) {
    const auto shared_points = std::make_shared<std::vector<Vec3f>>(points);
    const auto inside = std::make_shared<std::vector<std::uint8_t>>(points.size());
    const auto contacts = std::make_shared<std::vector<Contact>>(points.size());
    // Batches take a number of threads as their last argument, where this version of the library has that.
    for (const unsigned thread_count : {1U, 2U}) {
        if constexpr (requires { contains_batch(map.view(), points, *inside, thread_count); })
            ways.push_back({name, "contains_batch on S", thread_count,
                            [=] { contains_batch(map.view(), *shared_points, *inside, thread_count); }});
        if constexpr (requires { contacts_batch(map.view(), points, 0.0F, *contacts, thread_count); })
            ways.push_back({name, "contacts_batch on S", thread_count,
                            [=] { contacts_batch(map.view(), *shared_points, 0, *contacts, thread_count); }});
        else if constexpr (requires {
                               contacts_batch(map.view(), points, 0.0F, *contacts, Vec3d{}, thread_count);
                           })
            ways.push_back(
                {name, "contacts_batch on S", thread_count, [=] {
                     contacts_batch(map.view(), *shared_points, 0, *contacts, {1, 1, 1}, thread_count);
                 }});
    }
}

} // namespace

void list_batches(std::vector<BuildWay>& ways, const Subject& subject, std::size_t point_count) {
    const std::vector<Vec3f> points = subject.sets(point_count)[1].points;
    list_batches_of("exact map", ExactMap::build(subject.mesh), points, ways);
    list_batches_of("distance map", DistanceMap::build(subject.mesh), points, ways);
}
