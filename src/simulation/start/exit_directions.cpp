#include "simulation/start/exit_directions.hpp"

#include "geometry/union_find.hpp"
#include "simulation/start/openings.hpp"
#include "simulation/start/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace echinus {

namespace {

/// The mean cosine between the normals of the surface and of the nearest points.
double agreement(std::span<const Vec3f> normals, std::span<const Contact> nearest) {
    double sum = 0, count = 0;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (!nearest[v].found()) continue;
        sum += double{dot(normals[v], nearest[v].normal)};
        ++count;
    }
    return count > 0 ? sum / count : 0;
}

} // namespace

void ExitDirections::choose(std::span<const Vec3f> positions, std::span<const std::uint8_t> inside,
                            std::span<const Contact> nearest) {
    const std::vector<Vec3f> normals = smooth_normals(positions);
    float sign = side_ == ExitSide::Front ? 1.0F : side_ == ExitSide::Back ? -1.0F : 0.0F;
    const double agreed = agreement(normals, nearest);
    if (side_ == ExitSide::Nearest && std::abs(agreed) > threshold::kAgreement)
        sign = agreed > 0 ? 1.0F : -1.0F;
    for (std::size_t v = 0; v < directions_.size(); ++v) {
        if (inside[v] == 0) directions_[v] = {};
        if (inside[v] != 0 && sign != 0) directions_[v] = normals[v] * sign;
    }
    if (sign == 0) follow_leaders(inside, nearest);
    if (sign != 0 && side_ == ExitSide::Nearest) let_back_out(inside, nearest);
}

/// [particle] of unit length, or 0
std::vector<Vec3f> ExitDirections::smooth_normals(std::span<const Vec3f> positions) const {
    std::vector<Vec3f> normals(positions.size());
    for (const Element& element : elements_.all) {
        if (!element.is_face()) continue;
        const auto& [a, b, c] = element.vertices;
        const Vec3f normal = cross(positions[b] - positions[a], positions[c] - positions[a]);
        for (const std::uint32_t v : element.vertices) normals[v] += normal;
    }
    for (int i = 0; i < threshold::kSmoothingsOfNormals; ++i) {
        std::vector<Vec3f> sums = normals;
        for (const auto& [p, q] : elements_.edges) {
            sums[p] += normals[q];
            sums[q] += normals[p];
        }
        std::transform(sums.begin(), sums.end(), normals.begin(), unit_or_zero<float>);
    }
    return normals;
}

/// A group of particles whose nearest points lie opposite to their directions has either passed the middle
/// of the part of the model that the surface surrounds, or entered another part from the outside: a sleeve
/// the chest. The group then borders mostly on particles outside, and leaves where it came in.
void ExitDirections::let_back_out(std::span<const std::uint8_t> inside, std::span<const Contact> nearest) {
    const auto is_opposed = [&](std::uint32_t v) {
        return inside[v] != 0 && dot(directions_[v], nearest[v].normal) < threshold::kOpposed;
    };
    UnionFind groups(directions_.size());
    for (const auto& [p, q] : elements_.edges)
        if (is_opposed(p) && is_opposed(q)) groups.join(p, q);
    std::vector<int> excess(directions_.size()); // [root] edges to the outside, less those to others inside
    for (const auto& [p, q] : elements_.edges)
        if (is_opposed(p) != is_opposed(q)) {
            const auto& [in_group, other] = is_opposed(p) ? Edge{p, q} : Edge{q, p};
            excess[groups.find(in_group)] += inside[other] == 0 ? 1 : -1;
        }
    std::vector<std::uint32_t> leaving;
    for (std::uint32_t v = 0; v < directions_.size(); ++v)
        if (is_opposed(v) && excess[groups.find(v)] > 0) leaving.push_back(v);
    for (const std::uint32_t v : leaving) directions_[v] = {};
}

/// Neighbours whose nearest points lie in opposite directions belong to different groups. The smaller group
/// follows the larger one; those that extend to the outside come first, since they show where the surface
/// went in. A particle keeps its direction until it is outside, as its nearest point may change meanwhile.
void ExitDirections::follow_leaders(std::span<const std::uint8_t> inside, std::span<const Contact> nearest) {
    UnionFind groups(directions_.size());
    for (const auto& [p, q] : elements_.edges)
        if (inside[p] != 0 && inside[q] != 0 && dot(nearest[p].normal, nearest[q].normal) > 0)
            groups.join(p, q);
    std::vector<std::pair<bool, std::uint32_t>> ranks(directions_.size());
    for (std::uint32_t v = 0; v < directions_.size(); ++v) ++ranks[groups.find(v)].second;
    for (const auto& [p, q] : elements_.edges)
        if (inside[p] != inside[q]) ranks[groups.find(inside[p] != 0 ? p : q)].first = true;
    std::vector<Vec3f> led(directions_.size());
    for (const auto& [p, q] : elements_.edges) {
        if (inside[p] == 0 || inside[q] == 0) continue;
        const std::uint32_t of_p = groups.find(p), of_q = groups.find(q);
        if (of_p == of_q) continue;
        const bool p_leads = ranks[of_p] > ranks[of_q] || (ranks[of_p] == ranks[of_q] && of_p < of_q);
        led[p_leads ? of_q : of_p] += nearest[p_leads ? p : q].normal;
    }
    for (std::uint32_t v = 0; v < directions_.size(); ++v)
        if (inside[v] != 0 && directions_[v] == Vec3f{}) directions_[v] = unit_or_zero(led[groups.find(v)]);
}

} // namespace echinus
