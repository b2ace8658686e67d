#pragma once

#include "simulation/particles.hpp"
#include "simulation/surfaces/separation.hpp"
#include "simulation/surfaces/surface_pairs.hpp"

#include <echinus/geometry.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace echinus {

/// A point of a deformable's surface, a mean of up to three particles, that is to stay `offset` or more along
/// the normal: from a plane, or, with more particles whose weights are negative, from another such point.
struct SurfaceContact {
    std::array<std::uint32_t, 4> particles{};
    std::array<float, 4> weights{}; ///< 0 for a particle that takes no part
    Vec3f normal;
    float offset = 0;
};

/// One relaxation of a contact: push and friction, shared among the particles by weights and masses.
/// @param material  the motion of what the point rests on, in this substep
/// @return whether it pushed
bool relax(const SurfaceContact& contact, std::span<const float> inverse_masses, const Vec3f& material,
           float friction, Particles& particles);

} // namespace echinus
