#include "simulation/exact_collision.hpp"

#include "directions/lattice.hpp"
#include "simulation/contact_response.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace echinus {

namespace {

/// In lattice steps: nearer to the surface no particle is left. The lattice itself is off by one step, a
/// mesh judged without it by as much.
constexpr float kGuard = 8;

/// A contact plane is used until the particle has moved by this share of the thickness.
constexpr float kPlaneReuse = 1.0F / 16;

float largest(const Vec3d& scale) {
    return static_cast<float>(std::max({std::fabs(scale.x), std::fabs(scale.y), std::fabs(scale.z)}));
}

} // namespace

ExactCollision::ExactCollision(const Collider& collider, const RigidTransform& previous_pose,
                               const SimulationOptions& options)
    : collider_(collider), map_(std::get_if<ExactMap>(&collider.map)->view()), local_(collider),
      body_(collider.pose, {1, 1, 1}), material_(previous_pose, collider.pose),
      step_(map_.radius / static_cast<float>(kLatticeExtent) * largest(collider.scale)),
      thickness_(std::max(static_cast<float>(options.thickness), 2 * kGuard * step_)),
      friction_(static_cast<float>(options.friction)), keep_free_(options.keep_free) {}

void ExactCollision::begin(SurfaceMemory& memory, const Vec3f& position) const {
    memory.was_free = outside(position);
    memory.free_local = local_.point_to_local(position);
}

bool ExactCollision::outside(const Vec3f& position) const {
    return !contains(map_, local_.point_to_local(position));
}

bool ExactCollision::relax(SurfaceMemory& memory, Vec3f& position, Vec3f& previous,
                           SimulationProfile& profile) const {
    const Vec3f place = body_.point_to_local(position);
    const float moved = length(place - memory.asked_at);
    if (moved + thickness_ < memory.clearance) return false;
    const bool has_plane = memory.normal != Vec3f{};
    if (!has_plane || !(moved <= kPlaneReuse * thickness_))
        ask(memory, place, position, length(position - previous), profile);
    if (memory.normal == Vec3f{}) return false;
    const float missing = thickness_ - dot(place - memory.point, memory.normal);
    if (!(missing > 0)) return false;
    const Vec3f normal = body_.normal_to_world(memory.normal);
    const Vec3f start = previous + material_.at(position);
    const auto [motion, excess] = push_out(position - start, normal, missing, friction_);
    position = start + motion;
    previous += normal * excess;
    return true;
}

/// The nearest point now, or the crossing when the particle came through the surface since it was free last:
/// behind a thin plate the nearest point lies on the wrong side.
void ExactCollision::ask(SurfaceMemory& memory, const Vec3f& position_body, const Vec3f& position,
                         float speed, SimulationProfile& profile) const {
    const Vec3f position_local = local_.point_to_local(position);
    if (meet_on_the_way(memory, position_body, position_local, profile)) return;
    ++profile.map_query_count;
    const bool was_far = memory.normal == Vec3f{} && memory.clearance > 0;
    const float reach = std::max(2 * (thickness_ + speed), was_far ? 2 * memory.clearance : 0.0F);
    const Contact nearest = contact(map_, position_local, reach, collider_.scale);
    memory.asked_at = position_body;
    memory.normal = nearest.normal;
    memory.point = to_body(nearest.point);
    memory.clearance = !nearest.found() ? reach : nearest.inside ? 0 : -nearest.depth;
}

bool ExactCollision::meet_on_the_way(SurfaceMemory& memory, const Vec3f& position_body,
                                     const Vec3f& position_local, SimulationProfile& profile) const {
    if (!keep_free_ || !memory.was_free) return false;
    if (length(position_body - memory.asked_at) < memory.clearance) return false;
    ++profile.map_query_count;
    const SweepHit hit = sweep(map_, memory.free_local, position_local);
    if (!hit.found()) return false;
    memory.asked_at = position_body;
    memory.normal = free_normal(memory, hit, position_local);
    memory.point = to_body(hit.point);
    memory.clearance = 0;
    return true;
}

Vec3f ExactCollision::free_normal(const SurfaceMemory& memory, const SweepHit& hit,
                                  const Vec3f& to_local) const {
    const Vec3f way = to_local - memory.free_local;
    const Vec3f normal = local_.scaled_normal(hit.normal);
    return dot(way, hit.normal) > 0 ? -normal : normal;
}

/// A ball around the place that was asked about holds no surface; what begins and ends in it is free.
bool ExactCollision::within_known_ball(const SurfaceMemory& memory, const Vec3f& position_body) const {
    const float radius = memory.clearance - kGuard * step_;
    return length(position_body - memory.asked_at) < radius &&
           length(to_body(memory.free_local) - memory.asked_at) < radius;
}

bool ExactCollision::way_is_free(const SurfaceMemory& memory, const Vec3f& position_local) const {
    if (sweep(map_, memory.free_local, position_local).found()) return false;
    // In a closed surface the sweep's silence says this too.
    return map_.border.empty() || !contains(map_, position_local);
}

bool ExactCollision::free_at(const SurfaceMemory& memory, const Vec3f& position) const {
    return memory.was_free && (within_known_ball(memory, body_.point_to_local(position)) ||
                               way_is_free(memory, local_.point_to_local(position)));
}

bool ExactCollision::settled(const SurfaceMemory& memory, const Vec3f& position) const {
    if (!memory.was_free) return outside(position);
    if (within_known_ball(memory, body_.point_to_local(position))) return true;
    const Vec3f position_local = local_.point_to_local(position);
    if (!way_is_free(memory, position_local)) return false;
    return !contact(map_, position_local, kGuard * step_, collider_.scale).found();
}

bool ExactCollision::rescue(const SurfaceMemory& memory, Vec3f& position, Vec3f& previous) const {
    if (!memory.was_free) return lead_out(memory, position, previous);
    const Vec3f position_local = local_.point_to_local(position);
    const SweepHit hit = sweep(map_, memory.free_local, position_local);
    if (hit.found()) {
        const Vec3f normal = free_normal(memory, hit, position_local);
        for (const float gap : {thickness_, thickness_ / 8, 4 * kGuard * step_, 2 * kGuard * step_})
            if (leave(memory, to_body(hit.point) + normal * gap, normal, position, previous)) return true;
    } else {
        const Contact nearest = contact(map_, position_local, kGuard * step_, collider_.scale);
        for (const float gap : {4 * kGuard * step_, 2 * kGuard * step_})
            if (nearest.found() && leave(memory, to_body(nearest.point) + nearest.normal * gap,
                                         nearest.normal, position, previous))
                return true;
        if (way_is_free(memory, position_local)) return true; // in a narrow place, but free
    }
    return carry(memory, position, previous);
}

/// A particle that began inside: to the nearest point, and beyond.
bool ExactCollision::lead_out(const SurfaceMemory& memory, Vec3f& position, Vec3f& previous) const {
    if (outside(position)) return true;
    const Contact nearest = contact(map_, local_.point_to_local(position), 0, collider_.scale);
    for (const float gap : {thickness_, thickness_ / 8, 4 * kGuard * step_, 2 * kGuard * step_})
        if (leave(memory, to_body(nearest.point) + nearest.normal * gap, nearest.normal, position, previous))
            return true;
    return false;
}

/// Tries a place: the particle goes there if it is free there after rounding. Of its motion the part along
/// the surface remains, less friction.
bool ExactCollision::leave(const SurfaceMemory& memory, const Vec3f& target_body, const Vec3f& normal_body,
                           Vec3f& position, Vec3f& previous) const {
    const Vec3f target = body_.point_to_world(target_body);
    const Vec3f target_local = local_.point_to_local(target);
    if (memory.was_free ? !way_is_free(memory, target_local) : contains(map_, target_local)) return false;
    const Vec3f normal = body_.normal_to_world(normal_body);
    const Vec3f motion = position - previous - material_.at(position);
    const float impact = dot(motion, normal);
    const Vec3f slide = apply_friction(motion - normal * impact, normal, friction_ * std::fabs(impact));
    position = target;
    previous = target - material_.at(target) - slide;
    return true;
}

bool ExactCollision::carry(const SurfaceMemory& memory, Vec3f& position, Vec3f& previous) const {
    if (!memory.was_free) return false;
    const Vec3f carried = body_.point_to_world(to_body(memory.free_local));
    const Contact nearest = contact(map_, memory.free_local, thickness_, collider_.scale);
    const Vec3f out = body_.normal_to_world(nearest.normal);
    // Rounding to float may lead through a surface that is very near: away from it, by more and more.
    float gap = 0;
    for (int attempt = 0; attempt < 16; ++attempt) {
        const Vec3f target = carried + out * gap;
        if (way_is_free(memory, local_.point_to_local(target))) {
            position = target;
            previous = target - material_.at(target);
            return true;
        }
        gap = gap == 0 ? step_ / 2 : 2 * gap;
    }
    return false;
}

void ExactCollision::commit(SurfaceMemory& memory, const Vec3f& position) const {
    memory.was_free = true;
    memory.free_local = local_.point_to_local(position);
}

} // namespace echinus
