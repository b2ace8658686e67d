#pragma once

#include <echinus/contact.hpp>
#include <echinus/geometry.hpp>

namespace echinus {

/// How a particle responds to a contact.
struct ResponseRules {
    float thickness = 0; ///< distance to keep from the surface, units
    float friction = 0;  ///< tangential motion taken per length of push
};

/// Particles this many thicknesses away along their ray are asked for a contact: a particle at distance t
/// from a slope is farther than t along the ray, by one over the cosine between ray and normal. Steeper than
/// 76 degrees the thickness is not kept in full.
inline constexpr float kReachInThicknesses = 4;

/// A particle that was just put at the thickness counts as touching nearer than this.
inline constexpr float kTouchInThicknesses = 1 + 1.0F / 16;

/// How far the particle is below the plane at `thickness` over the contact plane.
inline float missing_distance(const Vec3f& position, const Contact& contact, float thickness) {
    return thickness - dot(position - contact.point, contact.normal);
}

/// Has the particle met the surface, or come nearer than the thickness? Asked for every particle, hence
/// inline.
inline bool needs_response(const Vec3f& position, const Contact& contact, float thickness) {
    if (contact.inside) return true;
    return contact.found() && missing_distance(position, contact, thickness) > 0;
}

/// The push that the contact asks for. A particle inside goes the paper's way (section 2.2), along the ray to
/// the surface, and from there the thickness along the normal. One that is outside but too near goes along
/// the normal of the contact plane: pushed along the ray it would land beside where it was, once more in
/// every relaxation, and creep uphill.
Vec3f wanted_push(const Vec3f& position, const Contact& contact, float thickness);

/// The part of the wanted push that is carried out. As far as the particle came against the push in this
/// frame, it is pushed back. The rest of the push would be new motion. Outside the surface it is
/// left out: there the map's answer may change from one cell of directions to the next, and a particle that
/// was thrown by it would never rest. Inside, a tenth of it in every relaxation leads the particle out.
/// @param motion  since the last frame, relative to the collider's material
Vec3f granted_push(const Vec3f& wanted, const Vec3f& motion, bool inside);

/// The motion that friction leaves: its part along the contact plane is shortened by at most `grip`, and
/// never reversed. @pre normal has unit length
Vec3f apply_friction(const Vec3f& motion, const Vec3f& normal, float grip);

/// The motion that a surface leaves of a motion into it: that part is gone, and friction takes its share of
/// the rest. @param motion  relative to the surface's material
Vec3d stopped_motion(const Vec3d& motion, const Vec3f& normal, float friction);

/// The motion that an exact contact leaves, and the part of the push that was new motion rather than a way
/// back: the particle is put where it belongs, and the excess is not added to its velocity.
struct PushedOut {
    Vec3f motion;
    float excess;
};

/// Pushes by `missing` along the normal, all at once, since the nearest point is where it seems to be. Then
/// friction, in proportion to the part of the push that was a way back.
/// @param motion  since the last frame, relative to the collider's material
PushedOut push_out(const Vec3f& motion, const Vec3f& normal, float missing, float friction);

/// The motion that a contact leaves of a particle's motion: push, then friction in proportion to the push.
Vec3f respond(const Vec3f& position, const Vec3f& motion, const Contact& contact, const ResponseRules& rules);

} // namespace echinus
