#include "simulation/known_contacts.hpp"

#include <algorithm>

namespace echinus {

KnownContacts::KnownContacts(const Particles& particles, std::span<const std::uint8_t> passes) {
    const std::size_t count = particles.count();
    for (PointArrays* points : {&asked_at_body, &asked_at, &normal_body, &normal}) points->resize(count);
    clearance.assign(count + PointArrays::kPadding, kNeverAsk);
    height.assign(count + PointArrays::kPadding, kNoPlane);
    for (std::size_t i = 0; i < count; ++i)
        if (!particles.pinned(i) && (passes.empty() || passes[i] == 0)) clearance[i] = -1;
}

void KnownContacts::follow(const ColliderNow& collider) {
    for (std::size_t i = 0; i + PointArrays::kPadding < clearance.size(); ++i) {
        asked_at.set(i, collider.body.point_to_world(asked_at_body[i]));
        normal.set(i, collider.body.normal_to_world(normal_body[i]));
    }
}

void KnownContacts::weaken(float most) {
    for (std::size_t i = 0; i + PointArrays::kPadding < clearance.size(); ++i) {
        if (is_never_asked(i)) continue;
        clearance[i] = height[i] == kNoPlane ? clearance[i] - most : -1;
        height[i] = kNoPlane;
    }
}

void KnownContacts::archive(StateArchive& state) {
    for (PointArrays* points : {&asked_at_body, &asked_at, &normal_body, &normal}) state.points(*points);
    state.padded(clearance);
    state.padded(height);
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

} // namespace echinus
