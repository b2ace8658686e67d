#include "mesh/weld.hpp"

#include "geometry/whole_numbers.hpp"
#include "mesh/require_valid.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace echinus {

namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// The bits of a position, with -0 as 0: equal for equal positions, and ordered even for NaN.
std::array<std::uint32_t, 3> position_key(const Vec3f& p) {
    // x + 0 is x, except that -0 + 0 is 0.
    return {bit_cast<std::uint32_t>(p.x + 0.0F), bit_cast<std::uint32_t>(p.y + 0.0F),
            bit_cast<std::uint32_t>(p.z + 0.0F)};
}

/// For each vertex the first vertex at the same position.
std::vector<std::uint32_t> first_at_same_position(const std::vector<Vec3f>& vertices) {
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto key_a = position_key(vertices[a]);
        const auto key_b = position_key(vertices[b]);
        return key_a != key_b ? key_a < key_b : a < b;
    });
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && position_key(vertices[order[i]]) == position_key(vertices[order[i - 1]]);
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

} // namespace

WeldedMesh weld_with_sources(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> first = first_at_same_position(mesh.vertices);
    std::vector<std::uint32_t> new_index(mesh.vertices.size(), kUnused);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        require_vertices_exist(mesh, face);
        for (std::uint32_t vertex : mesh.faces[face]) new_index[first[vertex]] = 0;
    }

    WeldedMesh welded;
    welded.mesh.origin = mesh.origin;
    for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex)
        if (new_index[vertex] != kUnused) {
            new_index[vertex] = kept_as<std::uint32_t>(welded.sources.size());
            welded.sources.push_back(kept_as<std::uint32_t>(vertex));
            welded.mesh.vertices.push_back(mesh.vertices[vertex]);
        }
    welded.mesh.faces.reserve(mesh.faces.size());
    for (const Triangle& face : mesh.faces)
        welded.mesh.faces.push_back(
            {new_index[first[face[0]]], new_index[first[face[1]]], new_index[first[face[2]]]});
    return welded;
}

TriangleMesh weld(const TriangleMesh& mesh) {
    return weld_with_sources(mesh).mesh;
}

} // namespace echinus
