#include "geometry/union_find.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh/faces.hpp"
#include "repair/repairs.hpp"

#include <echinus/mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// Maintains, for each edge of a mesh, how many more faces run along it in one direction than in the other:
/// its *imbalance*, which is 0 at every edge of a closed mesh. repair() drops faces only if that leaves no
/// edge with a larger imbalance, so it never opens a closed mesh.
class EdgeBalance {
  public:
    using Faces = std::vector<std::uint32_t>;
    static constexpr std::uint32_t kNoEdge = std::numeric_limits<std::uint32_t>::max();

    /// @pre indices are in range
    explicit EdgeBalance(const TriangleMesh& mesh);

    std::size_t edge_count() const { return sums_.size(); }
    /// The three edges of a face, numbered from 0, or kNoEdge three times if two of its corners are equal.
    std::span<const std::uint32_t, 3> edges_of(std::uint32_t face) const {
        return std::span(edges_of_face_).subspan(3 * std::size_t{face}).first<3>();
    }

    /// The decrease of the sum of all imbalances if these faces, each named once, are dropped.
    std::ptrdiff_t gain_without(const Faces& faces);

    /// The faces of the sets that can be dropped together without increasing an imbalance. First all sets are
    /// dropped; then, at each edge whose imbalance is larger than before, the sets there are restored, which
    /// is repeated for the edges that this changes. Time O(n log n) in the number of faces in the sets.
    /// @param sets  disjoint
    Faces droppable(std::vector<Faces> sets);

    void drop(const Faces& faces) { add(faces, -1); }

  private:
    std::size_t imbalance(std::uint32_t edge) const {
        return static_cast<std::size_t>(sums_[edge] < 0 ? -sums_[edge] : sums_[edge]);
    }
    Faces edges_at(const Faces& faces) const;
    void add(const Faces& faces, std::int32_t count);

    std::vector<std::uint32_t> edges_of_face_; ///< [3 * face_count]
    std::vector<std::int8_t> directions_;      ///< [3 * face_count] 1 or -1
    std::vector<std::int32_t> sums_;           ///< [edge_count]
};

EdgeBalance::EdgeBalance(const TriangleMesh& mesh)
    : edges_of_face_(3 * mesh.faces.size(), kNoEdge), directions_(3 * mesh.faces.size()) {
    for_each_edge(sorted_edge_uses(mesh), [&](std::span<const EdgeUse> uses) {
        const auto edge = kept_as<std::uint32_t>(sums_.size());
        sums_.push_back(0);
        for (const EdgeUse& use : uses) {
            const std::size_t place = 3 * std::size_t{use.face} + use.corner;
            edges_of_face_[place] = edge;
            directions_[place] = use.ascending ? 1 : -1;
            sums_[edge] += directions_[place];
        }
    });
}

void EdgeBalance::add(const Faces& faces, std::int32_t count) {
    for (const std::uint32_t face : faces)
        for (std::size_t place = 3 * std::size_t{face}; place < 3 * std::size_t{face} + 3; ++place)
            if (edges_of_face_[place] != kNoEdge) sums_[edges_of_face_[place]] += count * directions_[place];
}

/// The edges of some faces, without repetition.
EdgeBalance::Faces EdgeBalance::edges_at(const Faces& faces) const {
    Faces edges;
    for (const std::uint32_t face : faces)
        for (const std::uint32_t edge : edges_of(face))
            if (edge != kNoEdge) edges.push_back(edge);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

std::ptrdiff_t EdgeBalance::gain_without(const Faces& faces) {
    const std::vector<std::uint32_t> edges = edges_at(faces);
    const auto total = [&] {
        std::ptrdiff_t sum = 0;
        for (const std::uint32_t edge : edges) sum += static_cast<std::ptrdiff_t>(imbalance(edge));
        return sum;
    };
    const std::ptrdiff_t before = total();
    add(faces, -1);
    const std::ptrdiff_t after = total();
    add(faces, 1);
    return before - after;
}

EdgeBalance::Faces EdgeBalance::droppable(std::vector<Faces> sets) {
    struct EdgeOfSet {
        std::uint32_t edge;
        std::size_t set, before; ///< the set, and the imbalance with all faces
    };
    std::vector<EdgeOfSet> uses;
    for (std::size_t set = 0; set < sets.size(); ++set)
        for (const std::uint32_t edge : edges_at(sets[set])) uses.push_back({edge, set, imbalance(edge)});
    std::stable_sort(uses.begin(), uses.end(),
                     [](const EdgeOfSet& a, const EdgeOfSet& b) { return a.edge < b.edge; });
    for (const Faces& set : sets) add(set, -1);

    // Restoring a face changes the balance of its edges, which may invalidate other sets there.
    std::vector<std::uint32_t> changed;
    for (const EdgeOfSet& use : uses) changed.push_back(use.edge);
    while (!changed.empty()) {
        const std::uint32_t edge = changed.back();
        changed.pop_back();
        auto use = std::partition_point(uses.begin(), uses.end(),
                                        [&](const EdgeOfSet& other) { return other.edge < edge; });
        if (imbalance(edge) <= use->before) continue;
        for (; use != uses.end() && use->edge == edge; ++use) {
            const Faces given_up = std::exchange(sets[use->set], {});
            add(given_up, 1);
            for (const std::uint32_t other : edges_at(given_up)) changed.push_back(other);
        }
    }
    Faces result;
    for (const Faces& set : sets) {
        add(set, 1);
        result.insert(result.end(), set.begin(), set.end());
    }
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace

// The faces that repair() drops from a surface before anything else: equal faces, doubled patches and loose
// slivers, each only if that leaves no edge less balanced.

namespace {

using Faces = std::vector<std::uint32_t>;

} // namespace

// Faces on the same three vertices form a group. Which of them are surplus depends on the faces around them,
// so groups that share an edge are decided together, and others separately.

namespace {

/// Distinguishes the two orientations of a face on three vertices. Faces with two equal corners, which bound
/// nothing, all count as having the same orientation.
bool is_ascending(const Triangle& face) {
    return int{face[0] < face[1]} + int{face[1] < face[2]} + int{face[2] < face[0]} == 2;
}

/// Patches of groups that are connected by common edges.
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

/// Drops opposite faces in pairs, which changes no balance, and all but the first of the remaining faces,
/// which have the same orientation, if that leaves no edge less balanced.
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

/// Drops all but the first face of each group, if that leaves no edge less balanced.
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

// A quadrilateral a b c d that a modeller filled twice, once along the diagonal a c and once along b d,
// leaves the four faces of a flat tetrahedron on the surface:
//
//      d ------ c        d ------ c
//      |      / |        | \      |
//      |    /   |   and  |   \    |      with the rest of the surface along a b, b c, c d, d a
//      |  /     |        |     \  |
//      a ------ b        a ------ b
//
// Its edges identify it: each diagonal has exactly the two faces of its own patch, and each side has a face
// of each patch and at least one face of the surrounding surface. (A separate tetrahedron has two faces at
// every edge and is left unchanged.) A face is part of at most one such patch, and a quadrilateral has at
// most two. Dropping one patch restores the intended surface: the patch without which the edges are balanced
// better is dropped. If the common side of two solids is divided along different diagonals, all edges are
// balanced, and both patches stay.

namespace {

struct Patch {
    std::array<std::uint32_t, 4> corners{}; // ascending
    Faces faces;                            // two, ascending
};

std::uint32_t corner_opposite(const TriangleMesh& mesh, const EdgeUse& use) {
    return mesh.faces[use.face][(use.corner + 2U) % 3];
}

/// The patch of the two faces at an edge, if the edge may be the diagonal of a doubled patch.
std::optional<Patch> patch_along(const TriangleMesh& mesh, std::span<const EdgeUse> all,
                                 std::span<const EdgeUse> diagonal) {
    if (diagonal.size() != 2) return std::nullopt;
    const std::array<std::uint32_t, 2> ends{diagonal[0].low, diagonal[0].high};
    const std::array<std::uint32_t, 2> tips{corner_opposite(mesh, diagonal[0]),
                                            corner_opposite(mesh, diagonal[1])};
    if (tips[0] == tips[1]) return std::nullopt;
    for (const std::uint32_t end : ends)
        for (const std::uint32_t tip : tips)
            if (uses_of_edge(all, end, tip).size() < 3) return std::nullopt;

    Patch patch{{ends[0], ends[1], tips[0], tips[1]}, {diagonal[0].face, diagonal[1].face}};
    std::sort(patch.corners.begin(), patch.corners.end());
    return patch;
}

} // namespace

std::vector<std::uint32_t> find_doubled_patch_faces(const TriangleMesh& mesh) {
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    std::vector<Patch> patches;
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (auto patch = patch_along(mesh, edge_uses, uses)) patches.push_back(std::move(*patch));
    });
    if (patches.empty()) return {};
    std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
        return std::tie(a.corners, a.faces) < std::tie(b.corners, b.faces);
    });
    EdgeBalance balance(mesh);
    std::vector<Faces> doubled; // the later one of two equally good patches
    for (std::size_t i = 1; i < patches.size(); ++i) {
        if (patches[i].corners != patches[i - 1].corners) continue;
        const bool first_is_better =
            balance.gain_without(patches[i].faces) >= balance.gain_without(patches[i - 1].faces);
        doubled.push_back(patches[first_is_better ? i : i - 1].faces);
    }
    return balance.droppable(std::move(doubled));
}

namespace {

/// Are the corners collinear within the resolution of float? The height over the longest side is then at most
/// the rounding error of the corners.
bool has_no_area(const TriangleMesh& mesh, const Triangle& face) {
    constexpr double kRounding = 0x1p-23;
    double longest = 0, farthest = 0;
    std::array<Vec3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = Vec3d(mesh.vertices[face[k]]);
        const Vec3d& p = corners[k];
        farthest = std::max({farthest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, length(corners[(k + 1) % 3] - corners[k]));
    return length(cross(corners[1] - corners[0], corners[2] - corners[0])) <= kRounding * farthest * longest;
}

} // namespace

std::vector<std::uint32_t> find_loose_slivers(const TriangleMesh& mesh) {
    std::vector<bool> is_listed(mesh.faces.size());
    std::vector<std::vector<std::uint32_t>> slivers;
    for_each_edge(sorted_edge_uses(mesh), [&](std::span<const EdgeUse> uses) {
        if (is_balanced(uses)) return;
        for (const EdgeUse& use : uses) {
            if (is_listed[use.face] || !has_no_area(mesh, mesh.faces[use.face])) continue;
            is_listed[use.face] = true;
            slivers.push_back({use.face});
        }
    });
    if (slivers.empty()) return {};
    std::vector<std::uint32_t> loose = EdgeBalance(mesh).droppable(std::move(slivers));
    return loose.size() < mesh.faces.size() ? loose : std::vector<std::uint32_t>{};
}

} // namespace echinus
