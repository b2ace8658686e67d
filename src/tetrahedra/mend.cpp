#include "tetrahedra/mend.hpp"

#include "geometry/orientation.hpp"
#include "geometry/union_find.hpp"
#include "mesh/faces.hpp"
#include "mesh/local_frame.hpp"
#include "tetrahedra/tetrahedron_faces.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace echinus {

std::size_t turn_negative(TetrahedralMesh& mesh) {
    std::size_t count = 0;
    for (Tetrahedron& corners : mesh.tetrahedra) {
        const auto corner = [&](std::size_t i) -> const Vec3f& { return mesh.vertices[corners[i]]; };
        // orientation() is 1 if the first three turn clockwise seen from the last.
        if (orientation(corner(0), corner(1), corner(2), corner(3)) <= 0) continue;
        std::swap(corners[2], corners[3]);
        ++count;
    }
    return count;
}

std::size_t drop_unused_vertices(TetrahedralMesh& mesh) {
    std::vector<std::uint32_t> numbers(mesh.vertices.size());
    for (const Tetrahedron& corners : mesh.tetrahedra)
        for (const std::uint32_t vertex : corners) numbers[vertex] = 1;
    std::uint32_t count = 0;
    for (std::size_t vertex = 0; vertex < numbers.size(); ++vertex) {
        if (numbers[vertex] == 0) continue;
        mesh.vertices[count] = mesh.vertices[vertex];
        numbers[vertex] = count++;
    }
    const std::size_t dropped = mesh.vertices.size() - count;
    mesh.vertices.resize(count);
    for (Tetrahedron& corners : mesh.tetrahedra)
        for (std::uint32_t& vertex : corners) vertex = numbers[vertex];
    return dropped;
}

TetrahedralMesh local_body(std::span<const Vec3d> positions, std::vector<Tetrahedron> tetrahedra) {
    const std::span<const std::uint32_t> corners(tetrahedra.empty() ? nullptr : tetrahedra[0].data(),
                                                 4 * tetrahedra.size());
    LocalPositions local = to_local_frame(positions, corners);
    return {std::move(local.positions), std::move(tetrahedra), local.origin};
}

namespace {

/// The two vertices of an edge, ascending, or one vertex twice.
using Pinch = std::pair<std::uint32_t, std::uint32_t>;

/// The edges with more than two faces, and the other vertices whose faces form more than one fan.
std::vector<Pinch> find_pinches(const TriangleMesh& surface) {
    std::vector<Pinch> pinches;
    std::vector<std::uint8_t> on_pinched_edge(surface.vertices.size());
    UnionFind fans(3 * surface.faces.size()); // of the corners of all faces
    const auto join_at = [&](bool low, const EdgeUse& a, const EdgeUse& b) {
        const auto corner = [&](const EdgeUse& use) {
            return 3 * use.face + (use.ascending == low ? use.corner : (use.corner + 1U) % 3);
        };
        fans.join(corner(a), corner(b));
    };
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() == 2) {
            join_at(true, edge[0], edge[1]);
            join_at(false, edge[0], edge[1]);
        } else {
            pinches.emplace_back(edge[0].low, edge[0].high);
            on_pinched_edge[edge[0].low] = on_pinched_edge[edge[0].high] = 1;
        }
    });
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> fan_of(surface.vertices.size(), kNone);
    for (std::uint32_t corner = 0; corner < 3 * surface.faces.size(); ++corner) {
        const std::uint32_t vertex = surface.faces[corner / 3][corner % 3];
        if (fan_of[vertex] == kNone)
            fan_of[vertex] = fans.find(corner);
        else if (fan_of[vertex] != fans.find(corner) && on_pinched_edge[vertex] == 0)
            pinches.emplace_back(vertex, vertex);
    }
    std::sort(pinches.begin(), pinches.end());
    pinches.erase(std::unique(pinches.begin(), pinches.end()), pinches.end());
    return pinches;
}

bool has(const Tetrahedron& corners, std::uint32_t vertex) {
    return std::find(corners.begin(), corners.end(), vertex) != corners.end();
}

/// Of the tetrahedra around a vertex or an edge, those outside the largest part that is connected by faces at
/// that vertex or edge; all of them if there is only one part.
std::vector<std::uint32_t> to_remove(const TetrahedralMesh& mesh, const Pinch& place,
                                     const std::vector<std::uint32_t>& around) {
    UnionFind parts(around.size());
    std::map<Triangle, std::uint32_t> seen; // faces at the place
    for (std::uint32_t i = 0; i < around.size(); ++i)
        for (int corner = 0; corner < 4; ++corner) {
            Triangle face = face_opposite(mesh.tetrahedra[around[i]], corner);
            const auto holds = [&](std::uint32_t v) {
                return std::find(face.begin(), face.end(), v) != face.end();
            };
            if (!holds(place.first) || !holds(place.second)) continue;
            std::sort(face.begin(), face.end());
            const auto [other, is_new] = seen.emplace(face, i);
            if (!is_new) parts.join(other->second, i);
        }
    std::vector<double> volumes(around.size()); // the volume of each part, at its smallest member
    for (std::uint32_t i = 0; i < around.size(); ++i)
        volumes[parts.find(i)] += tetrahedron_volume(mesh, around[i]);
    const auto largest =
        static_cast<std::uint32_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
    std::vector<std::uint32_t> others;
    for (std::uint32_t i = 0; i < around.size(); ++i)
        if (parts.find(i) != largest) others.push_back(around[i]);
    return others.empty() ? around : others;
}

/// Performs one round; every pinch is treated in the state at the beginning of the round.
std::size_t remove_at(TetrahedralMesh& mesh, const std::vector<Pinch>& pinches) {
    std::vector<std::uint8_t> at_pinch(mesh.vertices.size()), removed(mesh.tetrahedra.size());
    for (const Pinch& place : pinches) at_pinch[place.first] = 1;
    std::map<std::uint32_t, std::vector<std::uint32_t>> around; // the tetrahedra around each vertex
    for (std::uint32_t number = 0; number < mesh.tetrahedra.size(); ++number)
        for (const std::uint32_t vertex : mesh.tetrahedra[number])
            if (at_pinch[vertex] != 0) around[vertex].push_back(number);
    for (const Pinch& place : pinches) {
        std::vector<std::uint32_t> here;
        for (const std::uint32_t number : around[place.first])
            if (has(mesh.tetrahedra[number], place.second)) here.push_back(number);
        for (const std::uint32_t number : to_remove(mesh, place, here)) removed[number] = 1;
    }
    const std::size_t before = mesh.tetrahedra.size();
    std::size_t count = 0;
    for (std::size_t number = 0; number < before; ++number)
        if (removed[number] == 0) mesh.tetrahedra[count++] = mesh.tetrahedra[number];
    mesh.tetrahedra.resize(count);
    return before - count;
}

} // namespace

std::size_t remove_pinches(TetrahedralMesh& mesh) {
    std::size_t count = 0;
    while (!mesh.tetrahedra.empty()) {
        const std::vector<Pinch> pinches = find_pinches(boundary(mesh));
        if (pinches.empty()) break;
        count += remove_at(mesh, pinches);
    }
    return count;
}

} // namespace echinus
