#pragma once

#include "simulation/jakobsen/collider_now.hpp"
#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The last position in which each particle was free of one collider with an exact map. A particle that
/// begins outside is free there; one that begins inside has no such position yet. A particle that the
/// collider lets through is free everywhere.
///
/// This is nearly always the particle's position at the beginning of the frame; other positions are stored.
class FreePlaces {
  public:
    /// @param passes  [count] 1 for the particles that the collider lets through, or empty
    FreePlaces(const ColliderNow& collider, const Particles& particles, std::span<const std::uint8_t> passes);

    /// Decides again whether these particles are free, from their positions at the start of the next frame
    /// only.
    void restart(std::span<const std::uint32_t> restarted, const ColliderNow& collider,
                 const Particles& particles);
    void begin_frame(const Collider& collider, const RigidTransform& pose) {
        frame_start_ = FrameChange(collider, pose);
    }

    bool has(std::size_t i) const { return states_[i] != State::Never; }
    /// In the map's frame, bitwise as it was tested. @pre has(i)
    Vec3f local(std::size_t i, const Particles& particles) const {
        return states_[i] == State::FrameStart ? frame_start_.point_to_local(particles.frame_start[i])
                                               : stored_[i];
    }
    /// The particles whose last free position, if any, is not that at the start of the frame.
    std::span<const std::uint32_t> exceptions() const { return exceptions_; }

    /// The particle ends this frame lost. @return false if it was already marked in this frame
    bool mark_lost(std::size_t i);

    /// Every particle that is not lost is free in its present position, except one that was never free and is
    /// still inside. A lost particle keeps its stored position if it is `wanted_back`; otherwise it is free
    /// again once it is outside.
    void end_frame(const ColliderNow& collider, const Particles& particles, bool wanted_back);

    void archive(StateArchive& state);

  private:
    enum class State : std::uint8_t { FrameStart, Stored, Never };

    bool is_free_now(std::uint32_t i, const ColliderNow& collider, const Particles& particles,
                     bool wanted_back) const;

    FrameChange frame_start_; ///< of the map when the frame begins
    std::vector<State> states_;
    std::vector<Vec3f> stored_;
    std::vector<std::uint8_t> lost_; ///< in this frame
    std::vector<std::uint32_t> exceptions_;
};

} // namespace echinus
