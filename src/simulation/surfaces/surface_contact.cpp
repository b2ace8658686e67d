#include "simulation/surfaces/surface_contact.hpp"

#include "simulation/contact_response.hpp"

namespace echinus {

void archive(StateArchive& state, SurfaceContact& contact, std::size_t particle_count) {
    for (std::uint32_t& particle : contact.particles) state.index(particle, particle_count);
    state.value(contact.weights);
    state.value(contact.normal);
    state.value(contact.offset);
}

bool relax(const SurfaceContact& contact, std::span<const float> inverse_masses, const Vec3f& material,
           float friction, Particles& particles) {
    float height = 0;
    for (std::size_t k = 0; k < 4; ++k)
        height += contact.weights[k] * dot(contact.normal, particles.positions[contact.particles[k]]);
    const float missing = contact.offset - height;
    if (!(missing > 0)) return false;
    Vec3f motion = -material;
    float mobility = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t i = contact.particles[k];
        motion += particles.step(i) * contact.weights[k];
        mobility += contact.weights[k] * contact.weights[k] * inverse_masses[i];
    }
    if (!(mobility > 0)) return false;
    const PushedOut pushed = push_out(motion, contact.normal, missing, friction);
    const Vec3f change = pushed.motion - motion;
    const Vec3f excess = contact.normal * pushed.excess;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t i = contact.particles[k];
        const float share = contact.weights[k] * inverse_masses[i] / mobility;
        particles.move(i, change * share);
        particles.move_previous(i, excess * share);
    }
    return true;
}

} // namespace echinus
