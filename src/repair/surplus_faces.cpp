#include "mesh/edges.hpp"
#include "mesh/faces.hpp"
#include "repair/repairs.hpp"

#include <algorithm>
#include <array>

namespace echinus {

namespace {

using Faces = std::vector<std::uint32_t>;

/// Distinguishes the two orientations of a face on three vertices. Faces with two equal corners, which bound
/// nothing, all count as the same orientation.
bool is_ascending(const Triangle& face) {
    return int{face[0] < face[1]} + int{face[1] < face[2]} + int{face[2] < face[0]} == 2;
}

/// Opposite faces cancel in pairs; the first of the remaining ones, which run the same way, stay.
Faces without_opposites(const TriangleMesh& mesh, const std::vector<Faces>& groups,
                        std::size_t most_left_of_a_group) {
    Faces surplus;
    for (const Faces& group : groups) {
        std::array<Faces, 2> ways;
        for (const std::uint32_t face : group) ways[is_ascending(mesh.faces[face])].push_back(face);
        if (ways[0].size() > ways[1].size()) std::swap(ways[0], ways[1]);
        const auto& [fewer, more] = ways;
        const std::size_t left = std::min(more.size() - fewer.size(), most_left_of_a_group);
        surplus.insert(surplus.end(), fewer.begin(), fewer.end());
        surplus.insert(surplus.end(), more.begin() + static_cast<std::ptrdiff_t>(left), more.end());
    }
    std::sort(surplus.begin(), surplus.end());
    return surplus;
}

/// Is every edge balanced without these faces?
bool is_closed_without(TriangleMesh mesh, const Faces& surplus) {
    for (const std::uint32_t face : surplus) mesh.faces[face] = {0, 0, 0}; // bounds nothing
    bool closed = true;
    for_each_edge(sorted_edge_uses(mesh), [&](auto uses) { closed = closed && is_balanced(uses); });
    return closed;
}

} // namespace

std::vector<std::uint32_t> find_surplus_faces(const TriangleMesh& mesh) {
    const std::vector<Faces> groups = find_equal_faces(mesh);
    if (groups.empty()) return {};
    const Faces usual = without_opposites(mesh, groups, 1);
    // The second never opens a closed mesh, since the faces it drops are closed themselves.
    for (const Faces& surplus :
         {usual, without_opposites(mesh, groups, mesh.faces.size()), find_duplicate_faces(mesh)})
        if (surplus.size() < mesh.faces.size() && is_closed_without(mesh, surplus)) return surplus;
    return usual.size() < mesh.faces.size() ? usual : Faces{};
}

} // namespace echinus
