#pragma once

#include <echinus/contact.hpp>
#include <echinus/geometry.hpp>

namespace echinus {

/// How a particle responds to a contact.
struct ResponseRules {
    float thickness = 0; ///< distance to keep from the surface, in the caller's unit
    float friction = 0;  ///< tangential motion taken per length of push
};

/// The distance along their ray, in thicknesses, up to which the contacts of particles are queried: a
/// particle at distance t from a slope is farther than t along the ray, by one over the cosine between ray
/// and normal. On slopes steeper than 76 degrees the thickness is not kept in full.
inline constexpr float kReachInThicknesses = 4;

/// The distance, in thicknesses, within which a particle that was just put at the thickness counts as
/// touching.
inline constexpr float kTouchInThicknesses = 1 + 1.0F / 16;

/// How far the particle is below the plane at `thickness` over the contact plane.
inline float missing_distance(const Vec3f& position, const Contact& contact, float thickness) {
    return thickness - dot(position - contact.point, contact.normal);
}

/// Has the particle met the surface, or come nearer than the thickness? Called for every particle, hence
/// inline.
inline bool needs_response(const Vec3f& position, const Contact& contact, float thickness) {
    if (contact.inside) return true;
    return contact.found() && missing_distance(position, contact, thickness) > 0;
}

/// The push that the contact asks for. A particle inside moves as in the paper (section 2.2), along the ray
/// to the surface and then along the normal by the thickness. A particle that is outside but too near moves
/// along the normal of the contact plane: pushed along the ray, it would land next to its previous position
/// in every relaxation, and so creep uphill.
Vec3f wanted_push(const Vec3f& position, const Contact& contact, float thickness);

/// The part of the wanted push that is carried out. The particle is pushed back as far as it moved against
/// the push in this frame. The rest of the push would be new motion. Outside the surface it is omitted,
/// because the map's answer may jump from one cell of directions to the next, and a particle that was pushed
/// by the jump would never come to rest. Inside, a tenth of it in every relaxation moves the particle out.
/// @param motion  since the last frame, relative to the collider's material
Vec3f granted_push(const Vec3f& wanted, const Vec3f& motion, bool inside);

/// The motion after friction: its part along the contact plane is shortened by at most `grip`, and never
/// reversed. @pre normal has unit length
Vec3f apply_friction(const Vec3f& motion, const Vec3f& normal, float grip);

/// The motion after a collision: the component into the surface is removed, and the tangential component is
/// reduced by friction. @param motion  relative to the surface's material
Vec3d stopped_motion(const Vec3d& motion, const Vec3f& normal, float friction);

/// The motion after an exact contact, and the part of the push that was new motion instead of a way back: the
/// particle is put in its position, but the excess is not added to its velocity.
struct PushedOut {
    Vec3f motion;
    float excess;
};

/// Pushes by `missing` along the normal at once, since the nearest point is exact. Friction is in proportion
/// to the part of the push that was a way back.
/// @param motion  since the last frame, relative to the collider's material
PushedOut push_out(const Vec3f& motion, const Vec3f& normal, float missing, float friction);

/// The motion of a particle after a contact: the push, then friction in proportion to the push.
Vec3f respond(const Vec3f& position, const Vec3f& motion, const Contact& contact, const ResponseRules& rules);

} // namespace echinus
