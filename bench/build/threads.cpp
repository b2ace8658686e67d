#include "build/threads.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

#include <cstddef>
#include <memory>
#include <thread>
#include <vector>

using namespace echinus;

namespace {

template <typename Map>
void list_batches_of(const char* name, const Map& map, const std::vector<Vec3f>& points,
                     std::vector<BuildWay>& ways) {
    const auto shared_points = std::make_shared<std::vector<Vec3f>>(points);
    const auto inside = std::make_shared<std::vector<std::uint8_t>>(points.size());
    const auto contacts = std::make_shared<std::vector<Contact>>(points.size());
    for (const unsigned thread_count : {1U, 2U}) {
        ways.push_back({name, "contains_batch on S", thread_count,
                        [=] { contains_batch(map.view(), *shared_points, *inside, thread_count); }});
        ways.push_back({name, "contacts_batch on S", thread_count,
                        [=] { contacts_batch(map.view(), *shared_points, 0, *contacts, thread_count); }});
    }
}

/// Arithmetic without memory, divided between threads: what the machine has to offer a second one just now.
void compute(unsigned thread_count) {
    const auto work = [=] {
        volatile double result = 1; // so that nothing is left out
        for (std::size_t i = 0; i < 20'000'000 / thread_count; ++i) result = result * 1.0000001;
    };
    std::vector<std::jthread> others;
    for (unsigned n = 1; n < thread_count; ++n) others.emplace_back(work);
    work();
}

} // namespace

void list_batches(std::vector<BuildWay>& ways, const Subject& subject, std::size_t point_count) {
    const std::vector<Vec3f> points = subject.sets(point_count)[1].points;
    list_batches_of("exact map", ExactMap::build(subject.mesh), points, ways);
    list_batches_of("distance map", DistanceMap::build(subject.mesh), points, ways);
    for (const unsigned thread_count : {1U, 2U})
        ways.push_back({"the machine", "arithmetic alone", thread_count, [=] { compute(thread_count); }});
}
