#pragma once

#include "simulation/jakobsen/collider_now.hpp"
#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Where each particle was free last, by one collider with an exact map. A particle that begins outside is
/// free there; one that begins inside has no such place yet. One that the collider lets through is free
/// everywhere.
///
/// Nearly always that is where the particle was when the frame began; other places are stored.
class FreePlaces {
  public:
    /// @param passes  [count] 1 for the particles that the collider lets through, or none
    FreePlaces(const ColliderNow& collider, const Particles& particles, std::span<const std::uint8_t> passes);

    /// @param pose  of the collider when the frame begins
    /// These particles are free or not where the frame that comes starts them, whatever they were before.
    void restart(std::span<const std::uint32_t> restarted, const ColliderNow& collider,
                 const Particles& particles);
    void begin_frame(const Collider& collider, const RigidTransform& pose) {
        frame_start_ = FrameChange(collider, pose);
    }

    bool has(std::size_t i) const { return states_[i] != State::Never; }
    /// In the map's frame, to the bit what was tested. @pre has(i)
    Vec3f local(std::size_t i, const Particles& particles) const {
        return states_[i] == State::FrameStart ? frame_start_.point_to_local(particles.frame_start[i])
                                               : stored_[i];
    }
    /// The particles with another place than that at the frame's start, or none.
    std::span<const std::uint32_t> exceptions() const { return exceptions_; }

    /// The particle ends this frame lost. @return false when that was said before in this frame
    bool mark_lost(std::size_t i);

    /// Every particle that is not lost is free where it is now, except one that was never free and is still
    /// inside. A lost one keeps its place if it is `wanted_back`; otherwise it is free again once it is
    /// outside.
    void end_frame(const ColliderNow& collider, const Particles& particles, bool wanted_back);

    void archive(StateArchive& state);

  private:
    enum class State : std::uint8_t { FrameStart, Stored, Never };

    bool is_free_now(std::uint32_t i, const ColliderNow& collider, const Particles& particles,
                     bool wanted_back) const;

    FrameChange frame_start_; ///< of the map
    std::vector<State> states_;
    std::vector<Vec3f> stored_;
    std::vector<std::uint8_t> lost_; ///< in this frame
    std::vector<std::uint32_t> exceptions_;
};

} // namespace echinus
