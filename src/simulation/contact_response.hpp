#pragma once

#include <echinus/contact.hpp>
#include <echinus/geometry.hpp>

namespace echinus {

/// How a particle answers a contact.
struct ResponseRules {
    float thickness = 0; ///< distance to keep from the surface, units
    float friction = 0;  ///< tangential motion taken per length of push
};

/// Particles this many thicknesses away along their ray are asked for a contact: a particle at distance t
/// from a slope is farther than t along the ray, by one over the cosine between ray and normal. Steeper than
/// 76 degrees the thickness is not kept in full.
inline constexpr float kReachInThicknesses = 4;

/// How far a particle has to be pushed: 0 or less when it keeps its distance.
float push_length(const Vec3f& position, const Contact& contact, float thickness);

/// Where the push leads. A particle inside goes the paper's way (section 2.2): along the ray to the surface,
/// and from there the thickness along the normal. One that is outside but too near goes along the normal of
/// the contact plane until it keeps its distance: pushed along the ray, it would land beside where it was,
/// once more in every relaxation, and creep uphill.
Vec3f push_out(const Vec3f& position, const Contact& contact, float thickness);

/// The motion that friction leaves: its part along the contact plane is shortened by at most `grip`, and
/// never reversed. @pre normal has unit length
Vec3f apply_friction(const Vec3f& motion, const Vec3f& normal, float grip);

} // namespace echinus
