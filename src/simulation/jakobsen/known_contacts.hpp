#pragma once

#include "simulation/jakobsen/collider_now.hpp"
#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace echinus {

/// The knowledge about the surface around each particle since the last query of the map: a ball without
/// surface, and a contact plane where one was near. As long as a particle stays in the ball, at its distance
/// from the surface, the map need not be asked again: the distance changes by no more than the particle
/// moves.
///
/// Kept in the body frame, and for the present frame in the world.
struct KnownContacts {
    /// Marks a missing plane.
    static constexpr float kNoPlane = std::numeric_limits<float>::infinity();
    /// A particle that is pinned, or that the collider lets through, has this clearance, so that the map is
    /// never asked. Its square is finite.
    static constexpr float kNeverAsk = 1e18F;

    PointArrays asked_at_body, asked_at; ///< where the particle was when the map was asked
    /// [count] No surface within this distance of there; negative before the first answer.
    std::vector<float> clearance;
    PointArrays normal_body, normal; ///< of the contact plane, towards where the particle has to be
    std::vector<float> height;       ///< [count] of asked_at over the plane, or kNoPlane

    /// @param passes  [count] 1 for the particles that the collider lets through, or none
    KnownContacts(const Particles& particles, std::span<const std::uint8_t> passes);

    /// Nothing is known around the particle. @param is_pinned  so that nothing need be
    void forget(std::size_t i, bool is_pinned) {
        clearance[i] = is_pinned ? kNeverAsk : -1;
        height[i] = kNoPlane;
    }
    bool is_never_asked(std::size_t i) const { return clearance[i] == kNeverAsk; }

    /// Moves along with the collider, which has moved.
    void follow(const ColliderNow& collider);
    void remember(std::size_t i, const ColliderNow& collider, const Vec3f& position, float clearance_now);
    void remember_plane(std::size_t i, const ColliderNow& collider, const Vec3f& normal_in_body,
                        float height_now);

    void archive(StateArchive& state);
};

/// A contact plane is used until the particle has moved by this share of the thickness.
inline constexpr float kPlaneReuse = 1.0F / 16;

/// A list of particles with room for all of them.
struct ParticleList {
    std::vector<std::uint32_t> particles;
    std::size_t count = 0;

    explicit ParticleList(std::size_t most) : particles(most) {}
    void add(std::uint32_t particle) { particles[count++] = particle; }
    std::span<const std::uint32_t> all() const { return {particles.data(), count}; }
};

/// One relaxation of the particles from first on: puts those that are known to be below the thickness over
/// their contact plane, with friction. Lists those for which the map has to be asked, in order.
/// @return how many were pushed
std::size_t push_known(const KnownContacts& known, const ColliderNow& collider, std::size_t first,
                       std::size_t end, Particles& particles, ParticleList& to_ask) noexcept;

/// The same for one particle, by the plane that was just found. @return whether it was pushed
bool push_one(const KnownContacts& known, const ColliderNow& collider, std::size_t i,
              Particles& particles) noexcept;

/// Lists the particles that are not known to be free. A particle is known to be free when the place where it
/// is and the place where it was free last both lie in the ball without surface, which is convex.
/// @param free_places  in the world, moved along with the collider
void list_unproven(const KnownContacts& known, const ColliderNow& collider, const PointArrays& positions,
                   const PointArrays& free_places, ParticleList& unproven) noexcept;

/// Is the particle not one of those that list_unproven() lists?
bool is_known_free(const KnownContacts& known, const ColliderNow& collider, std::size_t i,
                   const Vec3f& position, const Vec3f& free_place) noexcept;

} // namespace echinus
