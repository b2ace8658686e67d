#pragma once

#include "simulation/collider_now.hpp"
#include "simulation/free_places.hpp"
#include "simulation/known_contacts.hpp"
#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Particles against one collider with an exact map.
///
/// In the relaxations a particle is asked for its nearest point only when it has moved so far since the last
/// answer that another one is possible (KnownContacts); those that have to be are asked for together.
///
/// After the relaxations comes the proof. A particle is *free* when it is outside and the chord from the last
/// place proven free (FreePlaces), both in the map's frame, crosses no surface. Most are by what is known
/// already; the rest are swept.
class ExactCollision {
  public:
    /// Particles that are outside now are free.
    ExactCollision(const Collider& collider, const Particles& particles, const SimulationOptions& options);

    void begin_frame(const Collider& collider);
    /// The collider has moved on, or not.
    void begin_substep(const Collider& collider, const RigidTransform& previous_pose,
                       const SimulationOptions& options);

    /// One relaxation of all particles: to the thickness over the nearest point, with friction.
    void relax(Particles& particles, SimulationProfile& profile);

    /// Particles that are not known to be settled; pinned ones never are among them.
    std::span<const std::uint32_t> find_unsettled(const Particles& particles);

    /// Is the particle free where it is, and as far from the surface as a particle at rest has to be? One
    /// that never was free need only be outside.
    bool settled(std::size_t i, const Particles& particles) const;

    /// Was the particle free once, and is it not where it is now?
    bool strayed(std::size_t i, const Particles& particles) const;

    /// Leads a particle that is not settled to a free place: before the crossing, at the thickness or what
    /// room there is; or where it was free last, carried along. Its velocity into the surface is gone.
    /// @return whether there was such a place; else nothing is changed
    bool rescue(std::size_t i, Particles& particles) const;

    /// To the place proven free last, carried along, at rest on the collider. @return whether it is free
    /// there
    bool carry(std::size_t i, Particles& particles) const;

    /// The particle ends this frame where it must not be. @return whether that is news
    bool mark_lost(std::size_t i);

    void end_frame(const Particles& particles);

  private:
    void ask(Particles& particles, SimulationProfile& profile);
    bool meet_on_the_way(std::size_t i, const Particles& particles, const Vec3f& position_local,
                         SimulationProfile& profile);
    float reach_of(std::size_t i, const Particles& particles) const;
    void remember(std::size_t i, const Vec3f& position, const Contact& nearest, float reach);
    void ask_for_nearest(std::span<const std::uint32_t> asked, std::span<const Vec3f> places_local,
                         float reach, Particles& particles, SimulationProfile& profile);

    bool way_is_free(std::size_t i, const Particles& particles, const Vec3f& position_local) const;
    /// Of the face that was met: along the body's axes, towards the side the particle came from.
    Vec3f free_normal(const Vec3f& free_local, const SweepHit& hit, const Vec3f& to_local) const;
    bool leave(std::size_t i, const Vec3f& target_body, const Vec3f& normal_body, Particles& particles) const;
    bool lead_out(std::size_t i, Particles& particles) const;

    ColliderNow now_;
    RigidTransform frame_start_pose_;
    KnownContacts known_;
    FreePlaces free_places_;
    PointArrays carried_; // places at the frame's start, carried along; empty while the collider stands still
    ParticleList to_ask_, unsettled_;
    bool keep_free_;
    bool moves_ = false;
};

} // namespace echinus
