#pragma once

#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/geometry.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace echinus {

/// Beside what a pair may close on its way: contacts that begin to push within this share of the thickness
/// are kept ready.
inline constexpr float kReadiness = 1.0F / 8;
/// The same beside a vertex that was pushed lately.
inline constexpr float kAlertReadiness = 1.0F / 2;
/// A contact's plane is used until one of its vertices has moved by this share of the thickness.
inline constexpr float kContactReuse = 1.0F / 8;

/// A point of a deformable's surface, a mean of up to three particles, that is to stay `offset` or more along
/// the normal: from a plane, or, with more particles whose weights are negative, from another such point.
struct SurfaceContact {
    std::array<std::uint32_t, 4> particles{};
    std::array<float, 4> weights{}; ///< 0 for a particle that takes no part
    Vec3f normal;
    float offset = 0;
};

void archive(StateArchive& state, SurfaceContact& contact, std::size_t particle_count);

/// One relaxation of a contact: push and friction, shared among the particles by weights and masses.
/// @param material  the motion of what the point rests on, in this substep
/// @return whether it pushed
bool relax(const SurfaceContact& contact, std::span<const float> inverse_masses, const Vec3f& material,
           float friction, Particles& particles);

} // namespace echinus
