#pragma once

#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// Times of frames are multiples of a rounded step: a frame that begins so little before something is due has
/// it, in seconds.
inline constexpr double kRoundingOfTimes = 1e-9;

/// @param now  when a frame begins
inline bool is_due(double due, double now) {
    return now + kRoundingOfTimes >= due;
}

/// The handles of a deformable: where paths lead the particles that they hold, and when they let go. Places
/// are computed from the path alone, so that no error adds up.
class Handles {
  public:
    /// Where the deformable is now, its particles are right for the time 0.
    explicit Handles(const Deformable& deformable);

    /// Lets go of what is due when a frame begins. @param let_go  (particle) is called for each
    template <typename LetGo>
    void begin_frame(double time, const LetGo& let_go) {
        for (Held& held : held_) {
            if (held.is_open || !is_due(held.handle.release_time, time)) continue;
            held.is_open = true;
            for (const std::uint32_t particle : held.handle.particles) let_go(particle);
        }
    }
    /// Puts the particles that are held where paths lead them from one time to another.
    void follow(double from_time, double to_time, PointArrays& positions) const;
    /// Is nothing to come?
    bool all_done(double time) const;
    /// All is elsewhere: paths and what is held.
    void move(const RigidTransform& motion);

    /// @param set_held  (particle, is_held) is called for each after reading
    template <typename SetHeld>
    void archive(StateArchive& state, const SetHeld& set_held) {
        state.pose(moved_);
        for (Held& held : held_) {
            state.flag(held.is_open);
            if (!state.reads()) continue;
            for (const std::uint32_t particle : held.handle.particles) set_held(particle, !held.is_open);
        }
    }

  private:
    struct Held {
        Handle handle;
        std::vector<Vec3d> places; ///< of its particles, in the frame that follows the path
        bool is_open = false;      ///< it has let go
    };
    static bool moves(const Held& held, double from_time, double to_time);
    Vec3d place_at(const Held& held, std::size_t number, const RigidTransform& pose) const;

    std::vector<Held> held_;
    RigidTransform moved_; ///< by which all has been set elsewhere
};

} // namespace echinus
