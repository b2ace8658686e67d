#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Which meshes intersect each other or themselves, where, and how deep: for instance a garment and its body
/// before a simulation.
namespace echinus {

/// How far the vertices of one mesh are inside another. The depth of a vertex is the length of the shortest
/// translation that moves it out: its distance from the other's surface. Surfaces may also cross where no
/// vertex is inside; the length of the curves measures that.
struct Penetration {
    /// The other mesh is closed, so that it has an inside, and an exact map can hold it. Otherwise the other
    /// members keep their defaults.
    bool known = false;
    std::uint32_t vertex_count = 0;          ///< inside; vertices that no face uses do not count
    std::uint32_t deepest_vertex = kNoIndex; ///< the first of equally deep ones
    float depth = 0;                         ///< of the deepest vertex
};

/// A pair of the given meshes, or one mesh and itself.
struct CheckedMeshes {
    std::uint32_t a = 0, b = 0; ///< a <= b; equal for a mesh and itself
    Intersections found;
    Penetration a_in_b, b_in_a; ///< not known for a mesh and itself

    bool intersect() const { return !found.pairs.empty(); }
};

struct CheckOptions {
    unsigned thread_count = 0; ///< for the depths; 0: all cores. The results do not depend on it
    /// Called with the share of the work that is done, 0 to 1, in the thread that called check().
    std::function<void(double share)> progress = nullptr;
};

/// Checks every mesh and every two of the meshes. The meshes must lie in one frame. Which faces intersect is
/// decided exactly (intersections.hpp), inside and depth by an exact map of each closed mesh (exact_map.hpp),
/// as accurately as its queries. A mesh may lie inside another without intersecting it.
/// @returns the meshes that intersect, and those of which one has a vertex inside the other, in ascending
/// order
/// @throws Error InvalidMesh as intersections() and self_intersections() do; the sentence begins with the
/// numbers of the meshes, counted from 0
std::vector<CheckedMeshes> check(std::span<const TriangleMesh> meshes, const CheckOptions& options = {});

} // namespace echinus

ECHINUS_EXPORT_END
