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

void judge_faces(const Deformable& cloth, const TriangleMesh& model, Verdict& verdict) {
    const TriangleMesh surface{cloth.positions, surface_of(cloth)};
    if (surface.faces.empty()) return;
    verdict.model_pair_count = intersecting_pairs(surface, model).size();
    verdict.own_pair_count = self_intersecting_pairs(surface).size();
}

ContactGap gap_of(std::span<const Vec3f> positions, const Collider& collider, double thickness) {
    std::vector<Contact> contacts(positions.size());
    contacts_batch(collider, positions, static_cast<float>(2 * thickness), contacts);
    ContactGap gap{.least = std::numeric_limits<double>::infinity()};
    for (const Contact& contact : contacts) {
        if (!contact.found() || contact.inside) continue;
        const double distance = -double{contact.depth};
        ++gap.particle_count;
        gap.mean += distance;
        gap.least = std::min(gap.least, distance);
    }
    if (gap.particle_count != 0) gap.mean /= static_cast<double>(gap.particle_count);
    return gap;
}

} // namespace

TriangleMesh scaled(TriangleMesh mesh, const Vec3d& scale) {
    for (Vec3f& v : mesh.vertices) v = Vec3f(Vec3d(v.x * scale.x, v.y * scale.y, v.z * scale.z));
    if (scale.x * scale.y * scale.z < 0)
        for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

Verdict judge(const Simulation& simulation, const TriangleMesh& mesh, const ExactMap& exact_map,
              unsigned thread_count) {
    const Collider& collider = simulation.colliders().front();
    const TriangleMesh solid = scaled(mesh, collider.scale);
    const Collider exact{.map = exact_map, .pose = collider.pose, .scale = collider.scale};
    Verdict verdict;
    // An open mesh has no inside.
    if (exact_map.view().border.empty())
        judge_particles(simulation.positions(), solid, collider.pose, thread_count, verdict);
    judge_faces(simulation.deformable(), placed(solid, collider.pose), verdict);
    verdict.gap = gap_of(simulation.positions(), exact, simulation.options().thickness.value());
    return verdict;
}
