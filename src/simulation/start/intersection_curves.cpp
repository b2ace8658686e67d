#include "simulation/start/intersection_curves.hpp"

#include "geometry/union_find.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace echinus {

namespace {

std::span<const std::uint32_t> edges_of(const Element& element) {
    return std::span(element.edges).first(element.is_face() ? 3 : element.vertex_count - 1U);
}

void add_crossings(const Elements& elements, std::span<const Vec3f> positions, std::uint32_t of,
                   std::uint32_t face, std::vector<Crossing>& crossings) {
    const Element& other = elements.all[face];
    if (!other.is_face()) return;
    const auto& [a, b, c] = other.vertices;
    for (const std::uint32_t edge : edges_of(elements.all[of])) {
        const auto& [p, q] = elements.edges[edge];
        if (other.has(p) || other.has(q)) continue;
        if (triangles_intersect({positions[p], positions[q], positions[q]},
                                {positions[a], positions[b], positions[c]}))
            crossings.push_back({edge, face});
    }
}

std::vector<Crossing> all_crossings(const Elements& elements, std::span<const Vec3f> positions,
                                    std::span<const FacePair> pairs) {
    std::vector<Crossing> crossings;
    for (const auto& [a, b] : pairs) {
        add_crossings(elements, positions, a, b, crossings);
        add_crossings(elements, positions, b, a, crossings);
    }
    std::sort(crossings.begin(), crossings.end());
    crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
    return crossings;
}

} // namespace

/// Two faces that intersect share a segment of a curve, so the crossings of their edges lie on the same one.
std::vector<std::vector<Crossing>> intersection_curves(const Elements& elements,
                                                       std::span<const Vec3f> positions,
                                                       std::span<const FacePair> pairs) {
    const std::vector<Crossing> crossings = all_crossings(elements, positions, pairs);
    UnionFind groups(crossings.size());
    for (const auto& [a, b] : pairs) {
        std::uint32_t first = kNoIndex;
        for (const auto& [of, face] : {std::pair{a, b}, std::pair{b, a}})
            for (const std::uint32_t edge : edges_of(elements.all[of])) {
                const Crossing crossing{edge, face};
                const auto at = std::lower_bound(crossings.begin(), crossings.end(), crossing);
                if (at == crossings.end() || *at != crossing) continue;
                const auto index = static_cast<std::uint32_t>(at - crossings.begin());
                first = first == kNoIndex ? index : first;
                groups.join(first, index);
            }
    }
    std::vector<std::uint32_t> curve_of(crossings.size(), kNoIndex);
    std::vector<std::vector<Crossing>> curves;
    for (std::uint32_t i = 0; i < crossings.size(); ++i) {
        std::uint32_t& curve = curve_of[groups.find(i)];
        if (curve == kNoIndex) {
            curve = static_cast<std::uint32_t>(curves.size());
            curves.emplace_back();
        }
        curves[curve].push_back(crossings[i]);
    }
    return curves;
}

CutPieces::CutPieces(const Elements& elements)
    : elements_(elements), reached_by_(elements.vertex_count()), cut_by_(elements.edges.size()),
      parents_(elements.vertex_count()), sizes_(elements.vertex_count()), active_(elements.vertex_count()) {}

/// Grows pieces from all ends of cut edges at the same rate until all but one are complete or have met.
void CutPieces::cut(std::span<const Crossing> curve) {
    ++curve_;
    queue_.clear();
    growing_count_ = 0;
    for (const Crossing& crossing : curve) cut_by_[crossing.edge] = curve_;
    for (const Crossing& crossing : curve)
        for (const std::uint32_t vertex : elements_.edges[crossing.edge])
            if (reached_by_[vertex] != curve_) start(vertex);
    for (std::size_t next = 0; next < queue_.size() && growing_count_ > 1; ++next) grow(queue_[next]);
}

std::size_t CutPieces::size_at(std::uint32_t vertex) {
    const std::uint32_t root = find(vertex);
    return active_[root] == 0 ? sizes_[root] : elements_.vertex_count();
}

std::uint32_t CutPieces::find(std::uint32_t vertex) {
    while (parents_[vertex] != vertex) vertex = parents_[vertex] = parents_[parents_[vertex]];
    return vertex;
}

void CutPieces::start(std::uint32_t vertex) {
    reached_by_[vertex] = curve_;
    parents_[vertex] = vertex;
    sizes_[vertex] = active_[vertex] = 1;
    queue_.push_back(vertex);
    ++growing_count_;
}

void CutPieces::grow(std::uint32_t vertex) {
    for (const std::uint32_t number : elements_.at(vertex))
        for (const std::uint32_t edge : edges_of(elements_.all[number])) {
            const auto& [a, b] = elements_.edges[edge];
            if ((a == vertex || b == vertex) && cut_by_[edge] != curve_)
                reach(find(vertex), a == vertex ? b : a);
        }
    if (--active_[find(vertex)] == 0) --growing_count_;
}

void CutPieces::reach(std::uint32_t root, std::uint32_t vertex) {
    if (reached_by_[vertex] != curve_) {
        reached_by_[vertex] = curve_;
        parents_[vertex] = root;
        ++sizes_[root];
        ++active_[root];
        queue_.push_back(vertex);
        return;
    }
    const std::uint32_t other = find(vertex);
    if (other == root) return;
    parents_[other] = root;
    if (active_[other] > 0) --growing_count_;
    sizes_[root] += sizes_[other];
    active_[root] += active_[other];
}

} // namespace echinus
