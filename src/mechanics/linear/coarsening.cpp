#include "mechanics/linear/coarsening.hpp"

#include "mechanics/linear/cholesky.hpp"
#include "mechanics/thresholds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

/// The nodes around a node, by breadth-first search.
class Neighbourhood {
  public:
    explicit Neighbourhood(const Rows<Block>& graph)
        : graph_(graph), seen_from_(graph.row_count(), kNobody), distances_(graph.row_count()) {}

    /// The nodes within a number of edges, nearer ones first. The span is valid until the next call.
    std::span<const std::uint32_t> around(std::uint32_t node, std::uint32_t radius) {
        found_.assign(1, node);
        ++search_;
        seen_from_[node] = search_;
        distances_[node] = 0;
        for (std::size_t next = 0; next < found_.size(); ++next) {
            const std::uint32_t at = found_[next];
            if (distances_[at] == radius) break;
            for (std::uint32_t e = graph_.first[at]; e < graph_.first[at + 1]; ++e) {
                const std::uint32_t neighbour = graph_.columns[e];
                if (std::exchange(seen_from_[neighbour], search_) == search_) continue;
                distances_[neighbour] = distances_[at] + 1;
                found_.push_back(neighbour);
            }
        }
        return found_;
    }

  private:
    static constexpr std::uint32_t kNobody = 0;

    const Rows<Block>& graph_;
    std::vector<std::uint32_t> seen_from_, distances_, found_;
    std::uint32_t search_ = kNobody;
};

struct Parent {
    double distance_sq;
    std::uint32_t node; ///< fine
    friend auto operator<=>(const Parent&, const Parent&) = default;
};

/// The weights of moving least squares at a node: they give the value there of the linear function that fits
/// the parents' values.
std::vector<double> weights_at(const Vec3d& place, std::span<const Parent> parents,
                               std::span<const Vec3d> places) {
    constexpr std::size_t kTerms = 4;
    const double scale =
        1 / std::sqrt(std::max(parents.back().distance_sq, std::numeric_limits<double>::min()));
    std::vector<double> normal_matrix(kTerms * kTerms);
    std::vector<std::array<double, kTerms>> rows;
    for (const Parent& parent : parents) {
        const Vec3d d = (places[parent.node] - place) * scale;
        const std::array<double, kTerms> row{1, d.x, d.y, d.z};
        const double distance_sq = dot(d, d) + threshold::kFlatness;
        const double importance = 1 / (distance_sq * distance_sq);
        std::array<double, kTerms> weighted{};
        for (std::size_t i = 0; i < kTerms; ++i) {
            weighted[i] = importance * row[i];
            for (std::size_t j = 0; j < kTerms; ++j) normal_matrix[i * kTerms + j] += weighted[i] * row[j];
        }
        rows.push_back(weighted);
    }
    for (std::size_t i = 1; i < kTerms; ++i) normal_matrix[i * kTerms + i] += threshold::kFlatness;
    Cholesky<double> normal;
    normal.factorise(kTerms, normal_matrix);
    std::array<double, kTerms> at_node{1, 0, 0, 0};
    normal.solve(at_node);
    std::vector<double> weights;
    double sum = 0;
    for (const auto& row : rows) {
        double weight = 0;
        for (std::size_t i = 0; i < kTerms; ++i) weight += row[i] * at_node[i];
        weights.push_back(weight);
        sum += weight;
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

struct CoarseNodes {
    std::vector<std::uint32_t> numbers; ///< [node] its number among the coarse ones, or kNone
    std::uint32_t count = 0;
};

/// @param keeps_small  whether all nodes of a component are coarse if it has no more nodes than are needed to
/// represent its rotations
CoarseNodes choose_coarse(const Rows<Block>& graph, Neighbourhood& neighbourhood, bool keeps_small) {
    constexpr auto kSmall = static_cast<std::uint32_t>(threshold::kMostParents);
    CoarseNodes coarse{std::vector<std::uint32_t>(graph.row_count(), BlockMatrix::kNone)};
    std::vector<bool> is_covered(graph.row_count());
    for (std::uint32_t node = 0; node < graph.row_count(); ++node) {
        if (is_covered[node]) continue;
        coarse.numbers[node] = coarse.count++;
        if (keeps_small && neighbourhood.around(node, kSmall).size() <= kSmall) continue;
        for (const std::uint32_t near : neighbourhood.around(node, threshold::kCoarseSpacing))
            is_covered[near] = true;
    }
    return coarse;
}

} // namespace

Coarsening coarsen(const Rows<Block>& graph, std::span<const Vec3d> places) {
    Neighbourhood neighbourhood(graph);
    CoarseNodes coarse = choose_coarse(graph, neighbourhood, true);
    // If most components are that small, coarsening would never end.
    if (coarse.count > graph.row_count() / 2) coarse = choose_coarse(graph, neighbourhood, false);
    const std::vector<std::uint32_t>& numbers = coarse.numbers;
    Coarsening result;
    std::vector<Parent> parents;
    for (std::uint32_t node = 0; node < graph.row_count(); ++node) {
        if (numbers[node] != BlockMatrix::kNone) {
            result.coarse_places.push_back(places[node]);
            result.parents.columns.push_back(numbers[node]);
            result.parents.values.push_back(1);
        } else {
            parents.clear();
            for (const std::uint32_t near : neighbourhood.around(node, 2 * threshold::kCoarseSpacing)) {
                if (numbers[near] == BlockMatrix::kNone) continue;
                const Vec3d d = places[near] - places[node];
                parents.push_back({dot(d, d), near});
            }
            std::sort(parents.begin(), parents.end());
            if (parents.size() > threshold::kMostParents) parents.resize(threshold::kMostParents);
            const std::vector<double> weights = weights_at(places[node], parents, places);
            for (std::size_t i = 0; i < parents.size(); ++i) {
                if (std::abs(weights[i]) < threshold::kLeastParentWeight) continue;
                result.parents.columns.push_back(numbers[parents[i].node]);
                result.parents.values.push_back(static_cast<float>(weights[i]));
            }
        }
        result.parents.first.push_back(static_cast<std::uint32_t>(result.parents.columns.size()));
    }
    return result;
}

} // namespace echinus
