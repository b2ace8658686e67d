#include "build/system.hpp"
#include "rivals/cgal.hpp"
#include "rivals/embree.hpp"

using namespace echinus;

void list_build_rivals(BuildList& list, const TriangleMesh& mesh) {
    constexpr std::size_t kMostForCgal = 300'000; // faces; beyond, it takes minutes
    list.push_back({"Embree", "build", 1, [&mesh] { EmbreeRival{mesh}; }});
    if (mesh.faces.size() <= kMostForCgal) list.push_back({"CGAL", "build", 1, [&mesh] { CgalRival{mesh}; }});
}
