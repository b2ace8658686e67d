#include "commands/verdict.hpp"

#include "geometry/parallel.hpp"
#include "recording/threads.hpp"

#include <echinus/intersections.hpp>

#include <algorithm>
#include <limits>
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

/// Depths of the particles inside, by the mesh itself.
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

/// As a recording has it: rounded to float.
TriangleMesh placed(TriangleMesh mesh, const RigidTransform& pose) {
    for (Vec3f& vertex : mesh.vertices) vertex = Vec3f(pose.to_world(Vec3d(vertex)));
    return mesh;
}

/// Adds the particles near a collider to the gap; its mean is their sum until all colliders are done.
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
