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
/// surface, and a contact plane if one was near. As long as a particle stays in the ball, at a distance from
/// the surface, the map need not be queried again: the distance changes by no more than the particle's
/// displacement.
///
/// Kept in the body frame and, for the present frame, in the world.
struct KnownContacts {
    /// Marks a missing plane.
    static constexpr float kNoPlane = std::numeric_limits<float>::infinity();
    /// The clearance of a particle that is pinned or that the collider lets through, for which the map is
    /// never queried. Its square is finite.
    static constexpr float kNeverAsk = 1e18F;

    PointArrays asked_at_body, asked_at; ///< the position of the particle at the last query
    /// [count] There is no surface within this distance of asked_at; negative before the first answer.
    std::vector<float> clearance;
    /// The normal of the contact plane, towards the side on which the particle has to be.
    PointArrays normal_body, normal;
    std::vector<float> height; ///< [count] the height of asked_at over the plane, or kNoPlane

    /// @param passes  [count] 1 for the particles that the collider lets through, or empty
    KnownContacts(const Particles& particles, std::span<const std::uint8_t> passes);

    /// Forgets what is known around the particle. @param is_pinned  then nothing needs to be known
    void forget(std::size_t i, bool is_pinned) {
        clearance[i] = is_pinned ? kNeverAsk : -1;
        height[i] = kNoPlane;
    }
    bool is_never_asked(std::size_t i) const { return clearance[i] == kNeverAsk; }

    /// Updates the world positions after the collider has moved.
    void follow(const ColliderNow& collider);
    void remember(std::size_t i, const ColliderNow& collider, const Vec3f& position, float clearance_now);
    void remember_plane(std::size_t i, const ColliderNow& collider, const Vec3f& normal_in_body,
                        float height_now);

    void archive(StateArchive& state);
};

/// A contact plane is used until the particle has moved by this share of the thickness.
inline constexpr float kPlaneReuse = 1.0F / 16;

/// A list of particles with capacity for all of them.
struct ParticleList {
    std::vector<std::uint32_t> particles;
    std::size_t count = 0;

    explicit ParticleList(std::size_t most) : particles(most) {}
    void add(std::uint32_t particle) { particles[count++] = particle; }
    std::span<const std::uint32_t> all() const { return {particles.data(), count}; }
};

/// One relaxation of particles first to end: those that are known to be nearer than the thickness are pushed
/// to the thickness over their contact plane, with friction. Lists those for which the map has to be queried,
/// in order.
/// @return how many particles were pushed
std::size_t push_known(const KnownContacts& known, const ColliderNow& collider, std::size_t first,
                       std::size_t end, Particles& particles, ParticleList& to_ask) noexcept;

/// The same for one particle, with the plane that was just found. @return whether it was pushed
bool push_one(const KnownContacts& known, const ColliderNow& collider, std::size_t i,
              Particles& particles) noexcept;

/// Lists the particles that are not known to be free. A particle is known to be free if its position and its
/// last free position are both in the ball that contains no surface: since a ball is convex, it then contains
/// the path between them, too.
/// @param free_places  in the world, moved along with the collider
void list_unproven(const KnownContacts& known, const ColliderNow& collider, const PointArrays& positions,
                   const PointArrays& free_places, ParticleList& unproven) noexcept;

/// Would list_unproven() leave the particle out?
bool is_known_free(const KnownContacts& known, const ColliderNow& collider, std::size_t i,
                   const Vec3f& position, const Vec3f& free_place) noexcept;

} // namespace echinus
