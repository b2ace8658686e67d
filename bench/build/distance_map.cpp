#include "build/system.hpp"

#include <echinus/distance_map.hpp>

using namespace echinus;

void list_distance_map(BuildList& list, const TriangleMesh& mesh) {
    for (const unsigned thread_count : {1U, 2U}) {
        DistanceMapOptions options;
        options.thread_count = thread_count;
        list.push_back(
            {"distance map", "build", thread_count, [=, &mesh] { (void)DistanceMap::build(mesh, options); }});
    }
}
