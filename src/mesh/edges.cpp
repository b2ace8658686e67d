#include "mesh/edges.hpp"

#include "geometry/whole_numbers.hpp"
#include "mesh/faces.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace echinus {

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

} // namespace echinus
