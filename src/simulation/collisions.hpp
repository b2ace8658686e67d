#pragma once

#include "simulation/broad_phase.hpp"
#include "simulation/collision.hpp"
#include "simulation/load_meter.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace echinus {

/// Keeps the particles off all colliders, in the order of the colliders.
class Collisions {
  public:
    Collisions(const Deformable& deformable, const std::vector<Collider>& colliders,
               const Particles& particles, const SimulationOptions& options);
    Collisions(const Collisions& other);
    Collisions& operator=(const Collisions&) = delete;

    /// @param motions  [collider_count] how surfaces deform in this frame, null where they do not
    void begin_frame(const std::vector<Collider>& colliders, std::span<const SurfaceMotion* const> motions,
                     const Particles& particles, const SimulationOptions& options);
    /// Nothing is done about a collider that is away.
    bool is_away(std::size_t collider) const { return broad_phase_.is_away(collider); }
    /// Moves the colliders on.
    void begin_substep(std::vector<Collider>& colliders, double seconds);
    /// @param meter  of the loads on the colliders, or null
    void relax(Particles& particles, SimulationProfile& profile, LoadMeter* meter, const Workers& workers);
    /// Of the particles from one collider: Collision::known_clearances(). Nothing is known of one that is
    /// away.
    void known_clearances(std::size_t collider, const Particles& particles,
                          std::span<float> clearances) const {
        if (is_away(collider)) return std::fill(clearances.begin(), clearances.end(), 0.0F);
        collisions_[collider]->known_clearances(particles, clearances);
    }
    /// The colliders that were away and are not any more, at the end of a frame, which are made up for. Call
    /// before the proof.
    const std::vector<std::size_t>& meet_late(const std::vector<Collider>& colliders,
                                              const Particles& particles);
    /// The proof at the end of a frame: rescues the particles that are not proven free, and counts those that
    /// are lost nevertheless.
    /// @param meter  has noted the velocities, or null
    void keep_free(Particles& particles, SimulationProfile& profile, LoadMeter* meter);
    /// Instead of keep_free() where surfaces collide: no particle passes through anything, unless surfaces
    /// left one no place. Counts the particles that are lost.
    /// @param was_squeezed  that happened in this frame
    void end_frame(Particles& particles, bool was_squeezed, SimulationProfile& profile);

    /// @param colliders  where they stand
    void archive(StateArchive& state, const std::vector<Collider>& colliders);

  private:
    void prove(Particles& particles, bool rescues, SimulationProfile& profile, LoadMeter* meter);
    std::size_t rescue(std::uint32_t particle, Particles& particles) const;
    bool is_lost(std::uint32_t particle, const Particles& particles) const;
    void end_frames(const Particles& particles);
    std::size_t mark_lost(std::uint32_t particle, const Particles& particles);

    std::vector<std::unique_ptr<Collision>> collisions_; ///< one for each collider
    BroadPhase broad_phase_;
    std::vector<std::uint8_t> was_away_;            ///< by collider, in the frame before
    std::vector<RigidTransform> frame_start_poses_; ///< of the colliders
    std::vector<std::uint32_t> unproven_;           ///< in keep_free(), with room for all
    bool rescues_;
    bool has_lost_ = false; ///< a particle ended the last frame lost
};

} // namespace echinus
