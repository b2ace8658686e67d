#include "simulation/contact_response.hpp"

namespace echinus {

float push_length(const Vec3f& position, const Contact& contact, float thickness) {
    return thickness - dot(position - contact.point, contact.normal);
}

Vec3f push_out(const Vec3f& position, const Contact& contact, float thickness) {
    if (contact.inside) return contact.point + contact.normal * thickness;
    return position + contact.normal * push_length(position, contact, thickness);
}

Vec3f apply_friction(const Vec3f& motion, const Vec3f& normal, float grip) {
    const Vec3f tangential = motion - normal * dot(motion, normal);
    const float speed = length(tangential);
    if (speed <= grip) return motion - tangential;
    return motion - tangential * (grip / speed);
}

} // namespace echinus
