#pragma once

#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// In seconds. Times of frames are multiples of a rounded step, so whatever is due up to this long after a
/// frame begins belongs to that frame.
inline constexpr double kRoundingOfTimes = 1e-9;

/// @param now  when the frame begins
inline bool is_due(double due, double now) {
    return now + kRoundingOfTimes >= due;
}

/// The handles of a deformable: the paths along which they lead their particles, and the times at which they
/// release them. Positions are computed from the path alone, so that errors do not accumulate.
class Handles {
  public:
    /// The deformable's present positions are those of its held particles at time 0.
    explicit Handles(const Deformable& deformable);

    /// Releases the particles that are due when a frame begins. @param let_go  (particle) is called for each
    template <typename LetGo>
    void begin_frame(double time, const LetGo& let_go) {
        for (Held& held : held_) {
            if (held.is_open || !is_due(held.handle.release_time, time)) continue;
            held.is_open = true;
            for (const std::uint32_t particle : held.handle.particles) let_go(particle);
        }
    }
    /// Moves held particles along their paths, from one time to another.
    void follow(double from_time, double to_time, PointArrays& positions) const;
    /// Whether all paths have ended and no release is to come.
    bool all_done(double time) const;
    /// Moves everything: paths and the particles on them.
    void move(const RigidTransform& motion);

    /// @param set_held  (particle, is_held) is called for each particle after reading
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
        std::vector<Vec3d> places; ///< positions of its particles, in the frame that follows the path
        bool is_open = false;      ///< whether it has released its particles
    };
    static bool moves(const Held& held, double from_time, double to_time);
    Vec3d place_at(const Held& held, std::size_t number, const RigidTransform& pose) const;

    std::vector<Held> held_;
    RigidTransform moved_; ///< the motion by which all handles have been moved
};

} // namespace echinus
