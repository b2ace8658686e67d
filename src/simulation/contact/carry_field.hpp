#pragma once

#include "geometry/workers.hpp"
#include "mechanics/energy_term.hpp"
#include "simulation/deforming_collider.hpp"
#include "simulation/particles.hpp"

#include <echinus/collider.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// How the surface of a collider deforms in a frame, and how it carries particles near it.
struct Deformation {
    /// A particle that is near the surface when the frame begins.
    struct Near {
        std::uint32_t particle;
        float distance;
        Vec3f displacement; ///< of the nearest point of the surface in the frame, in the body frame
        Vec3d away;         ///< unit vector from that point to the particle
    };

    Deformation() = default;
    /// @param before  the collider when the frame begins, with the map of its surface there
    /// @param points  the particles of the deformable
    /// @param room    how far the deformable may move in the frame
    /// @param touch   as in CarryField
    Deformation(const Collider& before, const DeformingCollider& surface, const PointArrays& points,
                std::size_t point_count, double room, double touch, const Workers& workers);

    const SurfaceMotion* motion = nullptr; ///< null if it does not deform
    double longest = 0; ///< the longest displacement of a vertex that may come near the deformable
    std::vector<Near> near;
};

/// A part of a frame, by the shares of the frame that have passed when the part begins and when it ends.
struct FramePart {
    float begin = 0, end = 1;
};

/// How moving colliders carry nearby particles along in a step: from the displacements of their material, all
/// of the component that would close a gap, and as much of the rest as a particle moves by itself. These are
/// blended by the inverse of the distance (Shepard 1968) and fade with it. A particle that lies on a collider
/// and moves with it keeps its gap, so a step begins in a state that is safe for the final poses of the
/// colliders.
class CarryField {
  public:
    /// @param before, after  the colliders when a step begins and when it ends
    /// @param is_near        [collider] 1 for colliders that may carry anything, according to may_carry(), or
    /// that hold particles
    /// @param deformations   [collider] of the frame that contains the step
    /// @param touch  the distance from a collider within which particles are carried fully
    CarryField(const std::vector<Collider>& before, const std::vector<Collider>& after,
               std::span<const std::uint8_t> is_near, std::span<const Deformation> deformations,
               const FramePart& part, double touch);

    bool is_zero() const { return !moves_; }
    /// The longest displacement of any point of a collider's material by the change of its pose.
    static double longest_displacement(const Collider& before, const Collider& after);
    /// Could a collider whose surface does not deform carry any of these points, if they move no farther than
    /// `room` meanwhile?
    static bool may_carry(const Collider& before, const Collider& after, const PointArrays& points,
                          std::size_t point_count, double room, double touch);

    /// Moves all points except held ones.
    /// @param own  [point] the displacement without the colliders
    void carry(PointArrays& points, std::span<const std::uint8_t> is_held, Places own,
               const Workers& workers) const;

  private:
    /// The weighted sum of the displacements near a point.
    struct Blend;
    void add_rigid(std::size_t collider, const Vec3f& point, const Vec3d& own, Blend& blend) const;
    void add_deforming(std::size_t collider, const PointArrays& points, Places own,
                       std::span<Blend> blends) const;
    Vec3d displacement_of(const Blend& blend) const;

    const std::vector<Collider>& before_;
    const std::vector<Collider>& after_;
    std::span<const std::uint8_t> is_near_;
    std::span<const Deformation> deformations_;
    FramePart part_;
    double touch_, reach_;
    bool moves_ = false;
};

} // namespace echinus
