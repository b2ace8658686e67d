#include "build/system.hpp"

#include <echinus/exact_map.hpp>

using namespace echinus;

void list_exact_map(BuildList& list, const TriangleMesh& mesh) {
    for (const unsigned thread_count : {1U, 2U}) {
        ExactMapOptions options;
        options.thread_count = thread_count;
        list.push_back(
            {"exact map", "build", thread_count, [=, &mesh] { (void)ExactMap::build(mesh, options); }});
        const auto builder = std::make_shared<ExactMapBuilder>(mesh.faces, options);
        list.push_back(
            {"exact map", "rebuild", thread_count, [=, &mesh] { (void)builder->rebuild(mesh.vertices); }});
    }
}
