#pragma once

#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace echinus {

/// The bounds of particles and colliders. A simulation in which something has left them has diverged, and
/// ends.
class Bounds {
  public:
    Bounds(const SimulationOptions& options, const Deformable& start);

    /// @throws Error Diverged once anything has
    void require_sound() const;

    // These throw Error Diverged, with the frame. NaN is in no bounds.
    /// In the middle of a frame, in which what would be far out may be stopped on its way; but not from a
    /// hundred times as far.
    void require_ways(const Particles& particles, std::uint32_t frame);
    /// The same of the ends to which their motion leads. @param ends  [particle]
    void require_ways(std::span<const Vec3d> ends, std::uint32_t frame);
    void require_ends(const Particles& particles, std::uint32_t frame) {
        require_ends(particles.positions, particles.count(), frame);
    }
    void require_ends(const PointArrays& positions, std::size_t count, std::uint32_t frame);
    [[noreturn]] void diverge(std::uint32_t frame, const std::string& what);

    /// Whether the collider goes a way that is one, in so many seconds.
    static bool contain_way(const Collider& collider, double seconds);

  private:
    double most_on_the_way() const;
    template <typename Points>
    void require_within(const Points& points, std::size_t count, double most, std::uint32_t frame);

    Vec3d centre_;    ///< of where the deformable began
    double farthest_; ///< that a particle may be from there when a frame ends
    std::string diverged_;
};

} // namespace echinus
