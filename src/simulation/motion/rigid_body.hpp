#pragma once

#include "mechanics/small_matrix.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

namespace echinus {

/// A collider that moves freely: a solid of uniform density, by the load on it and gravity. Momentum is what
/// it keeps from frame to frame, so that nothing is lost as it turns.
class RigidBody {
  public:
    RigidBody() = default; ///< to be read from a state
    /// It goes on as the collider moves. @param surface  closed, in the body frame
    /// @throws Error InvalidOptions where the surface encloses nothing. @param name  of the collider
    RigidBody(const TriangleMesh& surface, double mass, const Collider& collider, const std::string& name);

    /// Where a frame leads it from a pose. @param load  of the frame before, about the pose's translation
    RigidTransform after(const RigidTransform& pose, const Load& load, const Vec3d& gravity, double seconds);
    /// Is no point of it faster than so much? A radian a second counts as a unit of length.
    bool is_slower_than(double speed) const;
    /// It is elsewhere, turned.
    void turn(const Rotation& rotation);
    void archive(StateArchive& state);

  private:
    Vec3d angular_velocity(const Rotation& rotation) const;

    double mass_ = 1;
    Vec3d centre_;                                       ///< of mass, in the body frame
    Matrix3 inertia_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; ///< about it, in the body frame; three columns
    Vec3d velocity_, angular_momentum_,
        angular_velocity_; ///< of the centre and about it, in the world's axes
};

} // namespace echinus
