#pragma once

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Of what a saved state takes for granted: it can go on only where all of this is the same.
struct StateFingerprint {
    std::uint64_t options = 0;
    std::uint64_t deformable = 0; ///< what is constant, and where it began
    std::vector<std::uint64_t> colliders;
};

/// Of the options that decide bits.
std::uint64_t hash_of(const SimulationOptions& options);
/// Of all but places. @param start_hash  of the places where it began
std::uint64_t hash_of(const Deformable& deformable, std::uint64_t start_hash);
std::uint64_t hash_of(std::span<const Vec3f> places);
/// Of the kind of a map, of the mesh that it was built of and how; of a custom map the kind only.
/// @param start  where the collider began
std::uint64_t hash_of(const ColliderMap& map, const Vec3d& scale, const RigidTransform& start);

} // namespace echinus
