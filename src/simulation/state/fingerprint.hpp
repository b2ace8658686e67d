#pragma once

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Hashes of what a saved state takes for granted: a simulation can continue from it only if all of these are
/// equal.
struct StateFingerprint {
    std::uint64_t options = 0;
    std::uint64_t deformable = 0; ///< its constant properties and its initial positions
    std::vector<std::uint64_t> colliders;
};

/// The hash of the options that affect bits.
std::uint64_t hash_of(const SimulationOptions& options);
/// The hash of everything except positions. @param start_hash  the hash of the initial positions
std::uint64_t hash_of(const Deformable& deformable, std::uint64_t start_hash);
std::uint64_t hash_of(std::span<const Vec3f> places);
/// The hash of the kind of a map, of the mesh from which it was built and of how it was built; for a custom
/// map only of its kind.
/// @param start  the initial pose of the collider
std::uint64_t hash_of(const ColliderMap& map, const Vec3d& scale, const RigidTransform& start);

} // namespace echinus
