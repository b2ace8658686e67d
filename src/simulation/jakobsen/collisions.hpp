#pragma once

#include "simulation/jakobsen/collision.hpp"

#include <cstddef>
#include <cstdint>
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

    void restart(std::span<const std::uint32_t> particles, const Particles& now);
    void set_friction(std::size_t number, double friction) { collisions_[number]->set_friction(friction); }
    /// @param number    of the collider
    /// @param collider  in its pose at the end of the frame
    void begin_frame(std::size_t number, const Collider& collider, const RigidTransform& previous_pose) {
        collisions_[number]->begin_frame(collider, previous_pose);
    }
    /// Leaves out colliders that no particle is near, at this time in the frame and again when keep_free()
    /// begins.
    void leave_out_away(const Particles& particles);
    void relax(Particles& particles, SimulationProfile& profile, const Workers& workers);
    /// The proof at the end of a frame: rescues the particles that are not proven free, and counts those that
    /// are lost nevertheless.
    void keep_free(Particles& particles, SimulationProfile& profile);
    /// @param motion  of the particle in this frame @return the part of it that the surfaces permit
    Vec3d without_approach(std::size_t particle, const Particles& particles, Vec3d motion) const;

    /// @param colliders  in their present poses
    void archive(StateArchive& state, const std::vector<Collider>& colliders);

  private:
    void rescue(std::uint32_t particle, Particles& particles) const;
    bool is_lost(std::uint32_t particle, const Particles& particles) const;
    std::size_t mark_lost(std::uint32_t particle, const Particles& particles);

    std::vector<std::unique_ptr<Collision>> collisions_; ///< one for each collider
    std::vector<std::uint8_t> is_away_;                  ///< [collider], in this frame
    /// Scratch list of keep_free(), with capacity for every particle of every collider.
    std::vector<std::uint32_t> unproven_;
    bool rescues_;
};

} // namespace echinus
