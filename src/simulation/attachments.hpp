#pragma once

#include "simulation/particles.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// Particles that move rigidly with a collider. Their places are computed from the pose alone, so that no
/// error adds up.
class Attachments {
  public:
    /// Where the deformable and the colliders are now, their places are right.
    Attachments(const Deformable& deformable, const std::vector<Collider>& colliders);

    /// Puts the particles where the colliders' poses take them.
    void follow(const std::vector<Collider>& colliders, PointArrays& positions) const;

  private:
    struct Place {
        std::uint32_t particle, collider;
        Vec3d from_pose; ///< in the collider's frame, without its scale
    };
    std::vector<Place> places_;
};

} // namespace echinus
