#pragma once

#include "compare/systems.hpp"
#include "rivals/unshipped/unshipped.hpp"
#include "subjects.hpp"

#include <functional>
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

/// A structure to build over and over, on one thread.
struct TimedStructure {
    std::string system; ///< as tables show it
    bool is_ours;
    std::function<void()> build;
};

/// The exact map, built and rebuilt, the distance map, Embree and, up to 300 000 faces, CGAL.
/// @pre the subject outlives the result
std::vector<TimedStructure> builds_on(const Subject& subject);

/// Milliseconds of processor time of each, a number for each pass, from turns that they take.
/// @param report_progress  as in take_turns()
std::vector<echinus::comparison::Pace> time_builds(const std::vector<TimedStructure>& builds, int passes,
                                                   const std::function<void(double)>& report_progress);
