#include "mesh/faces.hpp"

#include "geometry/union_find.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace echinus {

namespace {

Triangle sorted(Triangle face) {
    std::sort(face.begin(), face.end());
    return face;
}

bool is_degenerate(const TriangleMesh& mesh, const Triangle& face) {
    const Vec3d a(mesh.vertices[face[0]]);
    return has_equal_corners(face) ||
           cross(Vec3d(mesh.vertices[face[1]]) - a, Vec3d(mesh.vertices[face[2]]) - a) == Vec3d{};
}

} // namespace

bool has_equal_corners(const Triangle& face) {
    return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

double six_volumes(const TriangleMesh& mesh, const Triangle& face, const Vec3d& reference) {
    return dot(Vec3d(mesh.vertices[face[0]]) - reference,
               cross(Vec3d(mesh.vertices[face[1]]) - reference, Vec3d(mesh.vertices[face[2]]) - reference));
}

std::vector<std::vector<std::uint32_t>> find_equal_faces(const TriangleMesh& mesh) {
    std::vector<Triangle> keys;
    keys.reserve(mesh.faces.size());
    for (const Triangle& face : mesh.faces) keys.push_back(sorted(face));
    std::vector<std::uint32_t> order(keys.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
    });
    std::vector<std::vector<std::uint32_t>> groups;
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (keys[order[i]] != keys[order[i - 1]]) continue;
        const bool is_second = i == 1 || keys[order[i]] != keys[order[i - 2]];
        if (is_second) groups.push_back({order[i - 1]});
        groups.back().push_back(order[i]);
    }
    return groups;
}

std::vector<std::uint32_t> find_duplicate_faces(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> duplicates;
    for (const std::vector<std::uint32_t>& group : find_equal_faces(mesh))
        duplicates.insert(duplicates.end(), group.begin() + 1, group.end());
    std::sort(duplicates.begin(), duplicates.end());
    return duplicates;
}

std::vector<std::uint32_t> find_degenerate_faces(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> degenerate;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        if (is_degenerate(mesh, mesh.faces[face])) degenerate.push_back(kept_as<std::uint32_t>(face));
    return degenerate;
}

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(const EdgeUse& use) {
    return {use.low, use.high};
}

} // namespace

std::vector<EdgeUse> sorted_edge_uses(std::span<const Triangle> faces) {
    std::vector<EdgeUse> uses;
    uses.reserve(3 * faces.size());
    for (std::size_t face = 0; face < faces.size(); ++face) {
        const Triangle& corners = faces[face];
        if (has_equal_corners(corners)) continue;
        for (std::uint8_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
            uses.push_back({low, high, kept_as<std::uint32_t>(face), k, corners[k] == low});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    return uses;
}

std::span<const EdgeUse> uses_of_edge(std::span<const EdgeUse> all, std::uint32_t a, std::uint32_t b) {
    const Edge edge = std::minmax(a, b);
    const auto begin =
        std::partition_point(all.begin(), all.end(), [&](const EdgeUse& use) { return edge_of(use) < edge; });
    const auto end =
        std::partition_point(begin, all.end(), [&](const EdgeUse& use) { return edge_of(use) == edge; });
    return {begin, end};
}

bool is_balanced(std::span<const EdgeUse> uses_of_one_edge) {
    const auto ascending = static_cast<std::size_t>(std::count_if(
        uses_of_one_edge.begin(), uses_of_one_edge.end(), [](const EdgeUse& use) { return use.ascending; }));
    return 2 * ascending == uses_of_one_edge.size();
}

Components find_components(const TriangleMesh& mesh) {
    UnionFind sets(mesh.vertices.size());
    for (const Triangle& face : mesh.faces) {
        sets.join(face[0], face[1]);
        sets.join(face[0], face[2]);
    }
    constexpr std::uint32_t kUnnumbered = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number_of_set(mesh.vertices.size(), kUnnumbered);
    Components components;
    components.of_face.reserve(mesh.faces.size());
    for (const Triangle& face : mesh.faces) {
        std::uint32_t& number = number_of_set[sets.find(face[0])];
        if (number == kUnnumbered) number = kept_as<std::uint32_t>(components.count++);
        components.of_face.push_back(number);
    }
    return components;
}

namespace {

constexpr std::uint32_t kNoPatch = UINT32_MAX;

/// The face across an edge, if there is exactly one.
struct Neighbour {
    std::uint32_t face = kNoFace;
    bool runs_alike = false; ///< both run along the edge in the same direction, so one of them is turned
};

std::vector<std::array<Neighbour, 3>> find_neighbours(std::span<const EdgeUse> edge_uses,
                                                      std::size_t face_count) {
    std::vector<std::array<Neighbour, 3>> neighbours(face_count);
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (uses.size() != 2) return;
        const bool runs_alike = uses[0].ascending == uses[1].ascending;
        neighbours[uses[0].face][uses[0].corner] = {uses[1].face, runs_alike};
        neighbours[uses[1].face][uses[1].corner] = {uses[0].face, runs_alike};
    });
    return neighbours;
}

/// Finds the patches, the orientation of their faces, and which of them are orientable.
Orientation find_patches(std::span<const EdgeUse> edge_uses, std::size_t face_count) {
    const auto neighbours = find_neighbours(edge_uses, face_count);
    Orientation result{std::vector(face_count, kNoPatch), std::vector<bool>(face_count), {}, {}};
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t first = 0; first < face_count; ++first) {
        if (result.patch_of_face[first] != kNoPatch) continue;
        const auto patch = kept_as<std::uint32_t>(result.is_orientable.size());
        result.is_orientable.push_back(true);
        result.patch_of_face[first] = patch;
        waiting.push_back(first);
        while (!waiting.empty()) {
            const std::uint32_t face = waiting.back();
            waiting.pop_back();
            for (const Neighbour& neighbour : neighbours[face]) {
                if (neighbour.face == kNoFace) continue;
                const bool is_turned = result.is_turned[face] != neighbour.runs_alike;
                if (result.patch_of_face[neighbour.face] == kNoPatch) {
                    result.patch_of_face[neighbour.face] = patch;
                    result.is_turned[neighbour.face] = is_turned;
                    waiting.push_back(neighbour.face);
                } else if (result.is_turned[neighbour.face] != is_turned) {
                    result.is_orientable[patch] = false;
                }
            }
        }
    }
    return result;
}

} // namespace

Orientation find_orientation(std::span<const EdgeUse> edge_uses, std::size_t face_count) {
    Orientation result = find_patches(edge_uses, face_count);
    result.is_closed =
        find_closed_sets(edge_uses, result.patch_of_face, result.is_orientable.size(), result.is_turned);
    for (std::size_t patch = 0; patch < result.is_closed.size(); ++patch)
        result.is_closed[patch] = result.is_closed[patch] && result.is_orientable[patch];
    return result;
}

std::vector<bool> find_closed_sets(std::span<const EdgeUse> edge_uses,
                                   std::span<const std::uint32_t> set_of_face, std::size_t set_count,
                                   const std::vector<bool>& is_turned) {
    std::vector<bool> is_closed(set_count, true);
    std::vector<std::int64_t> balance(set_count); // of the set's faces along one edge
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        for (const EdgeUse& use : uses) {
            const bool is_ascending = use.ascending != (!is_turned.empty() && is_turned[use.face]);
            balance[set_of_face[use.face]] += is_ascending ? 1 : -1;
        }
        for (const EdgeUse& use : uses) {
            const std::uint32_t set = set_of_face[use.face];
            if (std::exchange(balance[set], 0) != 0) is_closed[set] = false;
        }
    });
    return is_closed;
}

} // namespace echinus
