#include "geometry/union_find.hpp"
#include "mesh/faces.hpp"
#include "repair/edge_balance.hpp"
#include "repair/repairs.hpp"

#include <algorithm>
#include <array>
#include <utility>

// Faces on the same three vertices are a group. Which of them are surplus depends on the faces around them,
// so groups that share an edge are decided together, and those that do not, apart.

namespace echinus {

namespace {

using Faces = std::vector<std::uint32_t>;

/// Distinguishes the two orientations of a face on three vertices. Faces with two equal corners, which bound
/// nothing, all count as the same orientation.
bool is_ascending(const Triangle& face) {
    return int{face[0] < face[1]} + int{face[1] < face[2]} + int{face[2] < face[0]} == 2;
}

/// Groups that are connected by common edges.
std::vector<std::vector<Faces>> patches_of(const std::vector<Faces>& groups, const EdgeBalance& balance) {
    UnionFind sets(groups.size());
    std::vector<std::uint32_t> group_at(balance.edge_count(), EdgeBalance::kNoEdge);
    for (std::uint32_t group = 0; group < groups.size(); ++group)
        for (const std::uint32_t edge : balance.edges_of(groups[group][0])) {
            if (edge == EdgeBalance::kNoEdge) continue;
            if (group_at[edge] == EdgeBalance::kNoEdge) group_at[edge] = group;
            sets.join(group, group_at[edge]);
        }
    std::vector<std::vector<Faces>> patches(groups.size());
    for (std::uint32_t group = 0; group < groups.size(); ++group)
        patches[sets.find(group)].push_back(groups[group]);
    std::erase_if(patches, [](const auto& patch) { return patch.empty(); });
    return patches;
}

/// Drops opposite faces in pairs, which changes no balance, and of the remaining ones, which run the same
/// way, all but the first, where that leaves no edge less balanced.
Faces without_opposites(const TriangleMesh& mesh, const std::vector<Faces>& patch, EdgeBalance& balance) {
    Faces surplus;
    std::vector<Faces> repeated;
    for (const Faces& group : patch) {
        std::array<Faces, 2> ways;
        for (const std::uint32_t face : group) ways[is_ascending(mesh.faces[face])].push_back(face);
        if (ways[0].size() > ways[1].size()) std::swap(ways[0], ways[1]);
        const auto& [fewer, more] = ways;
        const auto pair_count = static_cast<std::ptrdiff_t>(fewer.size());
        surplus.insert(surplus.end(), fewer.begin(), fewer.end());
        surplus.insert(surplus.end(), more.end() - pair_count, more.end());
        if (more.size() > fewer.size() + 1) repeated.emplace_back(more.begin() + 1, more.end() - pair_count);
    }
    const Faces dropped = balance.droppable(std::move(repeated));
    surplus.insert(surplus.end(), dropped.begin(), dropped.end());
    return surplus;
}

/// Drops all but the first face of each group, where that leaves no edge less balanced.
Faces without_later_ones(const std::vector<Faces>& patch, EdgeBalance& balance) {
    std::vector<Faces> later;
    for (const Faces& group : patch) later.emplace_back(group.begin() + 1, group.end());
    return balance.droppable(std::move(later));
}

} // namespace

std::vector<std::uint32_t> find_surplus_faces(const TriangleMesh& mesh) {
    const std::vector<Faces> groups = find_equal_faces(mesh);
    if (groups.empty()) return {};
    EdgeBalance balance(mesh);
    Faces all;
    for (const std::vector<Faces>& patch : patches_of(groups, balance)) {
        Faces surplus = without_opposites(mesh, patch, balance);
        Faces other = without_later_ones(patch, balance);
        if (balance.gain_without(other) > balance.gain_without(surplus)) surplus = std::move(other);
        all.insert(all.end(), surplus.begin(), surplus.end());
    }
    std::sort(all.begin(), all.end());
    return all.size() < mesh.faces.size() ? all : Faces{};
}

} // namespace echinus
