#include "simulation/jakobsen/contact_response.hpp"

#include <algorithm>

namespace echinus {

namespace {

constexpr float kRecoveryPerRelaxation = 0.1F;

} // namespace

Vec3f wanted_push(const Vec3f& position, const Contact& contact, float thickness) {
    if (contact.inside) return contact.point + contact.normal * thickness - position;
    return contact.normal * missing_distance(position, contact, thickness);
}

Vec3f granted_push(const Vec3f& wanted, const Vec3f& motion, bool inside) {
    const float wanted_length = length(wanted);
    if (wanted_length == 0) return {};
    const float approach = std::max(0.0F, -dot(motion, wanted) / wanted_length);
    const float back = std::min(wanted_length, approach);
    const float granted = inside ? back + kRecoveryPerRelaxation * (wanted_length - back) : back;
    return wanted * (granted / wanted_length);
}

Vec3f apply_friction(const Vec3f& motion, const Vec3f& normal, float grip) {
    const Vec3f tangential = motion - normal * dot(motion, normal);
    const float slip = length(tangential);
    if (slip <= grip) return motion - tangential;
    return motion - tangential * (grip / slip);
}

Vec3d stopped_motion(const Vec3d& motion, const Vec3f& normal, float friction) {
    const double approach = -dot(motion, Vec3d(normal));
    if (!(approach > 0)) return motion;
    const Vec3d along = motion + Vec3d(normal) * approach;
    const double slip = length(along), grip = double{friction} * approach;
    return slip > grip ? along * (1 - grip / slip) : Vec3d{};
}

PushedOut push_out(const Vec3f& motion, const Vec3f& normal, float missing, float friction) {
    const float approach = std::max(0.0F, -dot(motion, normal));
    const float back = std::min(missing, approach);
    return {apply_friction(motion + normal * missing, normal, friction * back), missing - back};
}

Vec3f respond(const Vec3f& position, const Vec3f& motion, const Contact& contact,
              const ResponseRules& rules) {
    const Vec3f push = granted_push(wanted_push(position, contact, rules.thickness), motion, contact.inside);
    return apply_friction(motion + push, contact.normal, rules.friction * length(push));
}

} // namespace echinus
