#pragma once

#include "simulation/deforming_collider.hpp"
#include "simulation/particles.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// Particles that move with a collider: rigidly, or with its surface where that deforms. Their places are
/// computed from the pose and the surface alone, so that no error adds up.
class Attachments {
  public:
    /// Where the deformable and the colliders are now, their places are right.
    Attachments(const Deformable& deformable, const std::vector<Collider>& colliders);

    /// From now on the surface of a collider deforms: its particles stay beside the point of a face that is
    /// nearest to them now, at the same place as that face sees it.
    /// @pre the collider has an exact map
    void hold_on_to_surface(std::size_t collider, const Collider& now, const DeformingCollider& surface);

    /// Puts the particles where the colliders' poses take them.
    /// @param surfaces  [collider_count] none where they never deformed
    /// @param share     of this frame that is over, from 0 to 1
    void follow(const std::vector<Collider>& colliders,
                std::span<const std::optional<DeformingCollider>> surfaces, float share,
                PointArrays& positions) const;

    /// @param surfaces  as in follow()
    void archive(StateArchive& state, std::span<const std::optional<DeformingCollider>> surfaces);

  private:
    /// On a face, and beside it.
    struct Hold {
        Triangle face;
        std::array<float, 3> shares; ///< of its corners in the point of it
        Vec3f aside;                 ///< from there, along the face's own axes
    };
    struct Place {
        std::uint32_t particle, collider;
        Vec3d from_pose; ///< in the collider's frame, without its scale
        std::optional<Hold> hold;
    };
    std::vector<Place> places_;
};

} // namespace echinus
