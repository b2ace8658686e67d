#pragma once

#include <echinus/mesh.hpp>

#include <functional>
#include <string>
#include <vector>

/// One way to build a structure.
struct BuildWay {
    std::string system, way;
    unsigned thread_count;
    std::function<void()> build;
};

using BuildList = std::vector<BuildWay>;

// A function for each file beside this one. The mesh outlives the ways.
void list_exact_map(BuildList& list, const echinus::TriangleMesh& mesh);
void list_distance_map(BuildList& list, const echinus::TriangleMesh& mesh);

/// Embree and, up to 300 000 faces, CGAL.
[[gnu::visibility("default")]] void list_build_rivals(BuildList& list, const echinus::TriangleMesh& mesh);
