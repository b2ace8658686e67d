#include "simulation/jakobsen/collider_now.hpp"

#include "directions/lattice.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// In lattice steps. The lattice is inexact by one step, and a mesh that is tested without it by as much.
constexpr float kGuard = 8;

float largest_of(const Vec3d& scale) {
    return static_cast<float>(std::max({std::fabs(scale.x), std::fabs(scale.y), std::fabs(scale.z)}));
}

float sum_of_coordinates(const Vec3d& v) {
    return static_cast<float>(std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
}

} // namespace

ColliderNow::ColliderNow(const Collider& collider, const RigidTransform& previous_pose,
                         const SimulationOptions& options)
    : map(map_of_surface(collider)->view()), scale(collider.scale), local(collider),
      body(collider.pose, {1, 1, 1}), material(previous_pose, collider.pose),
      step(map.radius / static_cast<float>(kLatticeExtent) * largest_of(collider.scale)),
      guard(kGuard * step), thickness(std::max(static_cast<float>(options.thickness.value()), 2 * guard)),
      friction(static_cast<float>(options.friction)),
      coordinate_sum(sum_of_coordinates(collider.pose.translation) +
                     sum_of_coordinates({double{map.centre.x} * collider.scale.x,
                                         double{map.centre.y} * collider.scale.y,
                                         double{map.centre.z} * collider.scale.z})) {}

} // namespace echinus
