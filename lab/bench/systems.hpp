#pragma once

#include "compare/systems.hpp"
#include "rivals/unshipped/triangle_rivals.hpp"
#include "subjects.hpp"

#include <string>
#include <vector>

/// A system as it takes part in a task, in a settled size.
struct BenchSystem {
    std::string name; ///< as tables show it
    bool is_ours;
    echinus::comparison::Builder builder; ///< @pre the subject outlives it
};

/// The systems that take part on a mesh, ours first, in the order of the tables. The slow ones are left out
/// on large meshes.
std::vector<BenchSystem> systems_on(const Subject& subject);

/// Those of them that are other people's libraries, compiled for this very machine as their users would.
[[gnu::visibility("default")]] std::vector<BenchSystem> libraries_on(const Subject& subject);

/// Embree in two ways and, around a closed mesh, CGAL: libraries that label points. The mesh may be open.
[[gnu::visibility("default")]] std::vector<BenchSystem>
labelling_libraries(const echinus::TriangleMesh& mesh);

/// A library that is asked about triangles.
struct NamedTriangleRival {
    std::string name;
    std::unique_ptr<const echinus::rivals::TriangleRival> system;
};

[[gnu::visibility("default")]] std::vector<NamedTriangleRival>
triangle_rivals(const echinus::TriangleMesh& model);

/// A function that builds and returns its system by value, or as a pointer.
template <typename Build>
BenchSystem bench_system(std::string name, bool is_ours, Build build) {
    return {std::move(name), is_ours, {[build]() -> echinus::comparison::Built {
                using Result = decltype(build());
                if constexpr (std::is_convertible_v<Result, echinus::comparison::Built>)
                    return build();
                else
                    return std::make_unique<const Result>(build());
            }}};
}
