#include "simulation/jakobsen/known_contacts.hpp"

#include "simulation/jakobsen/contact_response.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// The error of a distance between two positions in the world, relative to lengths and coordinates. The
/// positions were rounded to single precision in two frames, and their distance was rounded: less than 12 x
/// 2^-24.
constexpr float kRounding = 1.0F / (1 << 20);

} // namespace

KnownContacts::KnownContacts(const Particles& particles, std::span<const std::uint8_t> passes) {
    const std::size_t count = particles.count();
    for (PointArrays* points : {&asked_at_body, &asked_at, &normal_body, &normal}) points->resize(count);
    clearance.assign(count, kNeverAsk);
    height.assign(count, kNoPlane);
    for (std::size_t i = 0; i < count; ++i)
        if (!particles.pinned(i) && (passes.empty() || passes[i] == 0)) clearance[i] = -1;
}

void KnownContacts::follow(const ColliderNow& collider) {
    for (std::size_t i = 0; i < clearance.size(); ++i) {
        asked_at.set(i, collider.body.point_to_world(asked_at_body[i]));
        normal.set(i, collider.body.normal_to_world(normal_body[i]));
    }
}

void KnownContacts::archive(StateArchive& state) {
    for (PointArrays* points : {&asked_at_body, &asked_at, &normal_body, &normal}) state.points(*points);
    state.array(clearance);
    state.array(height);
}

void KnownContacts::remember(std::size_t i, const ColliderNow& collider, const Vec3f& position,
                             float clearance_now) {
    asked_at.set(i, position);
    asked_at_body.set(i, collider.body.point_to_local(position));
    clearance[i] = std::min(clearance_now, kNeverAsk);
    normal.set(i, {});
    normal_body.set(i, {});
    height[i] = kNoPlane;
}

void KnownContacts::remember_plane(std::size_t i, const ColliderNow& collider, const Vec3f& normal_in_body,
                                   float height_now) {
    normal_body.set(i, normal_in_body);
    normal.set(i, collider.body.normal_to_world(normal_in_body));
    height[i] = height_now;
}

bool push_one(const KnownContacts& known, const ColliderNow& collider, std::size_t i,
              Particles& particles) noexcept {
    const Vec3f position = particles.positions[i];
    const Vec3f normal = known.normal[i];
    const float missing = collider.thickness - (known.height[i] + dot(position - known.asked_at[i], normal));
    if (!(missing > 0)) return false;
    const Vec3f surface_motion = collider.material.at(position);
    const auto [motion, excess] =
        push_out(particles.step(i) - surface_motion, normal, missing, collider.friction);
    particles.set_step(i, surface_motion + motion);
    particles.move_previous(i, normal * excess);
    return true;
}

std::size_t push_known(const KnownContacts& known, const ColliderNow& collider, std::size_t first,
                       std::size_t end, Particles& particles, ParticleList& to_ask) noexcept {
    const float reuse = kPlaneReuse * collider.thickness;
    std::size_t pushed_count = 0;
    for (auto i = static_cast<std::uint32_t>(first); i < end; ++i) {
        const Vec3f moved = particles.positions[i] - known.asked_at[i];
        const float moved_sq = dot(moved, moved);
        const float quiet = known.clearance[i] - collider.thickness;
        if (moved_sq < quiet * std::fabs(quiet)) continue;
        const bool usable = moved_sq <= reuse * reuse && known.height[i] < KnownContacts::kNoPlane;
        if (!usable)
            to_ask.add(i);
        else
            pushed_count += push_one(known, collider, i, particles) ? 1 : 0;
    }
    return pushed_count;
}

bool is_known_free(const KnownContacts& known, const ColliderNow& collider, std::size_t i,
                   const Vec3f& position, const Vec3f& free_place) noexcept {
    const Vec3f moved = position - known.asked_at[i];
    const Vec3f free_moved = free_place - known.asked_at[i];
    const float clearance = known.clearance[i];
    const float size = std::fabs(position.x) + std::fabs(position.y) + std::fabs(position.z) +
                       collider.coordinate_sum + clearance;
    const float radius = clearance - collider.guard - size * kRounding;
    const float radius_sq = radius * std::fabs(radius);
    return dot(moved, moved) < radius_sq && dot(free_moved, free_moved) < radius_sq;
}

void list_unproven(const KnownContacts& known, const ColliderNow& collider, const PointArrays& positions,
                   const PointArrays& free_places, ParticleList& unproven) noexcept {
    for (std::uint32_t i = 0; i < known.clearance.size(); ++i)
        if (!is_known_free(known, collider, i, positions[i], free_places[i])) unproven.add(i);
}

} // namespace echinus
