#pragma once

#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace echinus {

/// The bounds of particles and colliders. A simulation in which something has left them has diverged, and is
/// stopped.
class Bounds {
  public:
    Bounds(const SimulationOptions& options, const Deformable& start);

    /// @throws Error Diverged once anything has left its bounds
    void require_sound() const;

    // These throw Error Diverged, with the frame. NaN is outside all bounds.
    /// For the middle of a frame, in which a particle that is far out may still be stopped on its way, unless
    /// it is a hundred times the bound away.
    void require_ways(const Particles& particles, std::uint32_t frame);
    /// The same for the positions to which the motion of particles leads. @param ends  [particle]
    void require_ways(std::span<const Vec3d> ends, std::uint32_t frame);
    void require_ends(const Particles& particles, std::uint32_t frame) {
        require_ends(particles.positions, particles.count(), frame);
    }
    void require_ends(const PointArrays& positions, std::size_t count, std::uint32_t frame);
    [[noreturn]] void diverge(std::uint32_t frame, const std::string& what);

    /// Whether the displacements of a collider in this time are within bounds.
    static bool contain_way(const Collider& collider, double seconds);

  private:
    double most_on_the_way() const;
    template <typename Points>
    void require_within(const Points& points, std::size_t count, double most, std::uint32_t frame);

    Vec3d centre_;    ///< of the deformable at the start
    double farthest_; ///< the largest distance of a particle from the centre at the end of a frame
    std::string diverged_;
};

} // namespace echinus
