#pragma once

#include "simulation/collider_now.hpp"
#include "simulation/particles.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Where each particle was proven last to be outside of one collider.
///
/// Nearly always that is where it was when the frame began; other places are stored.
class FreePlaces {
  public:
    FreePlaces(const ColliderNow& collider, const Particles& particles);

    void begin_frame(const Collider& collider);

    bool has(std::size_t i) const { return states_[i] != State::Never; }
    /// In the map's frame, to the bit what was tested. @pre has(i)
    Vec3f local(std::size_t i, const Particles& particles) const {
        return states_[i] == State::FrameStart ? frame_start_.point_to_local(particles.frame_start[i])
                                               : stored_[i];
    }
    /// The particles with another place than that at the frame's start, or none.
    std::span<const std::uint32_t> exceptions() const { return exceptions_; }

    /// The particle ends this frame where it must not be. @return whether that is news
    bool mark_lost(std::size_t i);

    /// The frame ends: who is free where it is has a new place. One that never was free has if it is outside
    /// by now, and a lost one if it is outside and not wanted back.
    void end_frame(const ColliderNow& collider, const Particles& particles, bool want_back);

  private:
    enum class State : std::uint8_t { FrameStart, Stored, Never };

    FrameChange frame_start_; ///< of the map
    std::vector<State> states_;
    std::vector<Vec3f> stored_;
    std::vector<std::uint8_t> lost_; ///< in this frame
    std::vector<std::uint32_t> exceptions_;
};

} // namespace echinus
