#include "repair/edge_balance.hpp"

#include "geometry/whole_numbers.hpp"
#include "mesh/faces.hpp"

#include <algorithm>
#include <utility>

namespace echinus {

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

/// The edges of some faces, each once.
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
        std::size_t set, before; ///< and the imbalance with all faces
    };
    std::vector<EdgeOfSet> uses;
    for (std::size_t set = 0; set < sets.size(); ++set)
        for (const std::uint32_t edge : edges_at(sets[set])) uses.push_back({edge, set, imbalance(edge)});
    std::stable_sort(uses.begin(), uses.end(),
                     [](const EdgeOfSet& a, const EdgeOfSet& b) { return a.edge < b.edge; });
    for (const Faces& set : sets) add(set, -1);

    // A face that is put back changes the balance of its edges, which may spoil other sets there.
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

} // namespace echinus
