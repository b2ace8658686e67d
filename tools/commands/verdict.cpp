#include "commands/verdict.hpp"

#include "geometry/parallel.hpp"
#include "mechanics/small_matrix.hpp"
#include "recording/threads.hpp"

#include <echinus/intersections.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

using namespace echinus;

namespace {

/// The positions of the particles that collide with a collider.
std::vector<Vec3f> stopped_by(std::size_t collider, const Deformable& deformable) {
    const std::vector<std::uint8_t> passes = let_through(deformable, collider);
    if (passes.empty()) return deformable.positions;
    std::vector<Vec3f> positions;
    for (std::size_t i = 0; i < passes.size(); ++i)
        if (passes[i] == 0) positions.push_back(deformable.positions[i]);
    return positions;
}

/// Determines the depths of the particles inside, by the mesh itself.
void judge_particles(std::span<const Vec3f> positions, const TriangleMesh& solid, const RigidTransform& pose,
                     unsigned thread_count, Verdict& verdict) {
    constexpr double kOutside = -1;
    std::vector<double> depths(positions.size(), kOutside);
    parallel_for(depths.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d point = pose.to_local(Vec3d(positions[i]));
            if (winding_number(solid, point) > 0.5) depths[i] = unsigned_distance(solid, point);
        }
    });
    for (const double depth : depths) {
        if (depth == kOutside) continue;
        ++verdict.inside_count;
        verdict.deepest = std::max(verdict.deepest, depth);
    }
}

/// The mesh at a pose, rounded to float as in a recording.
TriangleMesh placed(TriangleMesh mesh, const RigidTransform& pose) {
    for (Vec3f& vertex : mesh.vertices) vertex = Vec3f(pose.to_world(Vec3d(vertex)));
    return mesh;
}

/// Adds the particles near a collider to the gap; its mean contains their sum until all colliders have been
/// added.
void add_gap(std::span<const Vec3f> positions, const Collider& collider, double thickness, ContactGap& gap) {
    std::vector<Contact> contacts(positions.size());
    contacts_batch(collider, positions, static_cast<float>(2 * thickness), contacts);
    for (const Contact& contact : contacts) {
        if (!contact.found() || contact.inside) continue;
        const double distance = -double{contact.depth};
        ++gap.particle_count;
        gap.mean += distance;
        gap.least = std::min(gap.least, distance);
    }
}

} // namespace

TriangleMesh scaled(TriangleMesh mesh, const Vec3d& scale) {
    for (Vec3f& v : mesh.vertices) v = Vec3f(Vec3d(v.x * scale.x, v.y * scale.y, v.z * scale.z));
    if (scale.x * scale.y * scale.z < 0)
        for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

PairCounts count_pairs(const Simulation& simulation, std::span<const TriangleMesh> models) {
    const TriangleMesh surface{simulation.deformable().positions, surface_of(simulation.deformable())};
    if (surface.faces.empty()) return {};
    PairCounts counts{.own = self_intersecting_pairs(surface).size()};
    for (std::size_t c = 0; c < models.size(); ++c) {
        const std::vector<std::uint8_t> passes = let_through(simulation.deformable(), c);
        const auto pairs = intersecting_pairs(surface, placed(models[c], simulation.colliders()[c].pose));
        counts.with_models +=
            static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), [&](const FacePair& pair) {
                return !passes_through(surface.faces[pair.a], passes);
            }));
    }
    return counts;
}

Verdict judge(const Simulation& simulation, std::span<const JudgedModel> models, unsigned thread_count) {
    Verdict verdict;
    verdict.gap.least = std::numeric_limits<double>::infinity();
    std::vector<TriangleMesh> solids;
    for (std::size_t c = 0; c < models.size(); ++c) {
        const Collider& collider = simulation.colliders()[c];
        const std::vector<Vec3f> positions = stopped_by(c, simulation.deformable());
        solids.push_back(scaled(models[c].mesh, collider.scale));
        // An open mesh has no inside.
        if (models[c].map.view().border.empty())
            judge_particles(positions, solids.back(), collider.pose, thread_count, verdict);
        add_gap(positions, {.map = models[c].map, .pose = collider.pose, .scale = collider.scale},
                simulation.options().thickness.value(), verdict.gap);
    }
    verdict.pairs = count_pairs(simulation, solids);
    if (verdict.gap.particle_count != 0) verdict.gap.mean /= static_cast<double>(verdict.gap.particle_count);
    return verdict;
}

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

/// The stretches of the parts of a deformable from their rest positions to their present positions.
class Stretches {
  public:
    explicit Stretches(const Deformable& deformable)
        : now_(deformable.positions),
          rest_(deformable.rest_positions.empty() ? deformable.positions : deformable.rest_positions) {}

    /// None for a part without length at rest.
    std::optional<double> of_edge(std::uint32_t a, std::uint32_t b) const {
        const double rest = length(edge(rest_, a, b));
        if (!(rest > 0)) return std::nullopt;
        return farthest_from_one({length(edge(now_, a, b)) / rest});
    }

    /// None for a triangle without area at rest. The squares of the stretches are the eigenvalues of F^T F, a
    /// symmetric 2 x 2 matrix in axes along the first edge and across it.
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
