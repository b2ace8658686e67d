#pragma once

#include "simulation/collision.hpp"

#include <memory>
#include <span>
#include <vector>

namespace echinus {

/// Keeps the particles off all colliders, in the order of the colliders.
class Collisions {
  public:
    Collisions(const std::vector<Collider>& colliders, const Particles& particles,
               const SimulationOptions& options);
    Collisions(const Collisions& other);
    Collisions& operator=(const Collisions&) = delete;

    void begin_frame(const std::vector<Collider>& colliders);
    /// Moves the colliders on.
    void begin_substep(std::vector<Collider>& colliders, double seconds);
    void relax(Particles& particles, SimulationProfile& profile);
    /// Of the particles from one collider: Collision::known_clearances().
    void known_clearances(std::size_t collider, const Particles& particles,
                          std::span<float> clearances) const {
        collisions_[collider]->known_clearances(particles, clearances);
    }
    /// The proof at the end of a frame: rescues the particles that are not proven free, and counts those that
    /// are lost nevertheless.
    void keep_free(Particles& particles, SimulationProfile& profile);
    /// Instead of keep_free() where surfaces collide: no particle passes through anything, unless surfaces
    /// left one no place. Counts the particles that are lost.
    /// @param was_squeezed  that happened in this frame
    void end_frame(Particles& particles, bool was_squeezed, SimulationProfile& profile);

  private:
    void prove(Particles& particles, bool rescues, SimulationProfile& profile);
    void rescue(std::uint32_t particle, Particles& particles) const;
    bool is_lost(std::uint32_t particle, const Particles& particles) const;
    std::size_t mark_lost(std::uint32_t particle, const Particles& particles);

    std::vector<std::unique_ptr<Collision>> collisions_; ///< one for each collider
    std::vector<std::uint32_t> unproven_;                ///< in keep_free(), with room for all
    bool rescues_;
    bool has_lost_ = false; ///< a particle ended the last frame lost
};

} // namespace echinus
