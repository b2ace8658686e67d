#include "commands/strain.hpp"

#include "mechanics/small_matrix.hpp"
#include "recording/threads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <set>
#include <utility>

using namespace echinus;

namespace {

std::optional<Strain> summary_of(std::vector<double> shares) {
    if (shares.empty()) return std::nullopt;
    std::sort(shares.begin(), shares.end());
    return Strain{.mean =
                      std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size()),
                  .percentile_99 = shares[(shares.size() - 1) * 99 / 100],
                  .largest = shares.back()};
}

double farthest_from_one(std::initializer_list<double> stretches) {
    double farthest = 0;
    for (const double stretch : stretches) farthest = std::max(farthest, std::abs(stretch - 1));
    return farthest;
}

/// Of the parts of a deformable between where they are at rest and where they are.
class Stretches {
  public:
    explicit Stretches(const Deformable& deformable)
        : now_(deformable.positions),
          rest_(deformable.rest_positions.empty() ? deformable.positions : deformable.rest_positions) {}

    /// None of parts without length at rest.
    std::optional<double> of_edge(std::uint32_t a, std::uint32_t b) const {
        const double rest = length(edge(rest_, a, b));
        if (!(rest > 0)) return std::nullopt;
        return farthest_from_one({length(edge(now_, a, b)) / rest});
    }

    /// None of one without area at rest. The squares of the stretches are the eigenvalues of F^T F, which in
    /// axes along the first edge and across it are those of a symmetric matrix of 2 x 2.
    std::optional<double> of_triangle(const Triangle& face) const {
        const auto& [a, b, c] = face;
        const Vec3d rest_b = edge(rest_, a, b), rest_c = edge(rest_, a, c);
        const double along = length(rest_b), twice_area = length(cross(rest_b, rest_c));
        if (!(twice_area > 0)) return std::nullopt;
        const double c_along = dot(rest_c, rest_b) / along, c_across = twice_area / along;
        const Vec3d first = edge(now_, a, b) * (1 / along);
        const Vec3d second = (edge(now_, a, c) - first * c_along) * (1 / c_across);
        const double p = dot(first, first), q = dot(second, second), r = dot(first, second);
        const double middle = (p + q) / 2, away = std::hypot((p - q) / 2, r);
        return farthest_from_one({std::sqrt(middle + away), std::sqrt(std::max(middle - away, 0.0))});
    }

    double of_tetrahedron(const ElasticTetrahedron& tetrahedron) const {
        const auto& [a, b, c, d] = tetrahedron.particles;
        const auto& [at_b, at_c, at_d] = tetrahedron.gradients;
        const Vec3d to_b = edge(now_, a, b), to_c = edge(now_, a, c), to_d = edge(now_, a, d);
        const auto column = [&](float Vec3f::*axis) {
            return to_b * double{at_b.*axis} + to_c * double{at_c.*axis} + to_d * double{at_d.*axis};
        };
        const auto stretches = decompose({column(&Vec3f::x), column(&Vec3f::y), column(&Vec3f::z)}).stretches;
        return farthest_from_one({stretches[0], stretches[1], stretches[2]});
    }

  private:
    static Vec3d edge(const std::vector<Vec3f>& places, std::uint32_t from, std::uint32_t to) {
        return Vec3d(places[to]) - Vec3d(places[from]);
    }

    const std::vector<Vec3f>&now_, &rest_;
};

void add(std::vector<double>& shares, std::optional<double> share) {
    if (share) shares.push_back(*share);
}

} // namespace

std::optional<Strain> material_strain(const Deformable& deformable) {
    const Stretches stretches(deformable);
    std::vector<bool> is_body(deformable.particle_count());
    std::vector<double> shares;
    for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra) {
        for (const std::uint32_t particle : tetrahedron.particles) is_body[particle] = true;
        shares.push_back(stretches.of_tetrahedron(tetrahedron));
    }
    for (const Triangle& face : deformable.faces)
        if (!is_body[face[0]] || !is_body[face[1]] || !is_body[face[2]])
            add(shares, stretches.of_triangle(face));
    for (const auto& [a, b] : threads_of(deformable)) add(shares, stretches.of_edge(a, b));
    return summary_of(std::move(shares));
}

std::optional<Strain> edge_strain(const Deformable& deformable) {
    const Stretches stretches(deformable);
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [a, b, c] : deformable.faces)
        for (const auto& edge : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)}) edges.insert(edge);
    for (const auto& [a, b] : threads_of(deformable)) edges.insert(std::minmax(a, b));
    std::vector<double> shares;
    for (const auto& [a, b] : edges) add(shares, stretches.of_edge(a, b));
    return summary_of(std::move(shares));
}
