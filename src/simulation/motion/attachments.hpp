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

/// Particles that move with a collider: rigidly, or with its surface if that deforms. Their positions are
/// computed from the pose and the surface alone, so that errors do not accumulate.
class Attachments {
  public:
    /// The present positions of the deformable and the colliders determine where the particles are attached.
    Attachments(const Deformable& deformable, const std::vector<Collider>& colliders);

    /// From now on the surface of a collider deforms: each of its particles keeps its present position
    /// relative to the point and the axes of the nearest face.
    /// @pre the collider has an exact map
    void hold_on_to_surface(std::size_t collider, const Collider& now, const DeformingCollider& surface);

    /// Moves the particles to where the colliders' poses take them.
    /// @param surfaces  [collider_count] none for colliders that never deformed
    /// @param share     the share of this frame that has passed, from 0 to 1
    void follow(const std::vector<Collider>& colliders,
                std::span<const std::optional<DeformingCollider>> surfaces, float share,
                PointArrays& positions) const;

    /// @param surfaces  as in follow()
    void archive(StateArchive& state, std::span<const std::optional<DeformingCollider>> surfaces);

  private:
    /// A point on a face, and an offset from it.
    struct Hold {
        Triangle face;
        std::array<float, 3> shares; ///< of the corners in the point
        Vec3f aside;                 ///< the offset, along the axes of the face
    };
    struct Place {
        std::uint32_t particle, collider;
        Vec3d from_pose; ///< in the collider's frame, without its scale
        std::optional<Hold> hold;
    };
    std::vector<Place> places_;
};

} // namespace echinus
