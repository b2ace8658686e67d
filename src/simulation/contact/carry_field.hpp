#pragma once

#include "geometry/workers.hpp"
#include "simulation/particles.hpp"

#include <echinus/collider.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// How colliders that move in a step carry what is near them along: the displacements of their material,
/// blended by the inverse of the distance (Shepard 1968), and fading with it. What lies on a collider keeps
/// its gap as if it were glued to it, so that a step begins in a state that is safe where the colliders end.
class CarryField {
  public:
    /// @param before, after  the colliders when a step begins and when it ends
    /// @param touch  what is no farther from a collider is carried whole
    CarryField(const std::vector<Collider>& before, const std::vector<Collider>& after, double touch);

    bool is_zero() const { return !moves_; }
    /// The longest displacement of any collider's material.
    static double longest_displacement(const Collider& before, const Collider& after);

    /// Moves points, but those that are held.
    void carry(PointArrays& points, std::span<const std::uint8_t> is_held, const Workers& workers) const;

  private:
    Vec3d displacement_at(const Vec3f& point) const;

    const std::vector<Collider>& before_;
    const std::vector<Collider>& after_;
    double touch_, reach_;
    bool moves_ = false;
};

} // namespace echinus
