#pragma once

#include "mechanics/small_matrix.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

namespace echinus {

/// A collider that moves freely: a solid of uniform density. Its state from step to step is the momentum, so
/// that none is lost as it turns.
class RigidBody {
  public:
    RigidBody() = default; ///< for reading from a state
    /// Continues the motion of the collider. @param surface  closed, in the body frame @param name  of the
    /// collider
    /// @throws Error InvalidOptions if the surface encloses nothing
    RigidBody(const TriangleMesh& surface, double mass, const Collider& collider, const std::string& name);

    /// Adds the change of momentum by gravity and by a load about the pose's translation during this time.
    void push(const RigidTransform& pose, const Load& load, const Vec3d& gravity, double seconds);
    /// The pose to which its velocities lead from a pose.
    RigidTransform after(const RigidTransform& pose, double seconds) const;
    /// The same, including gravity.
    RigidTransform after(const RigidTransform& pose, const Vec3d& gravity, double seconds) const;
    /// The share of gravity by which it accelerated in the last step; contacts took the rest.
    double left_of(const Vec3d& gravity) const;
    /// The velocities of a collider that moves with it.
    void give_velocities(Collider& collider) const;

    double mass() const { return mass_; }
    Vec3d centre() const { return centre_; }
    /// The variances of its mass distribution about the centre, and their axes, in the body frame.
    Eigensystem second_moments() const;
    /// Whether its linear and its angular velocity are no greater than this. A radian per second counts as a
    /// unit of length per second.
    bool is_slower_than(double speed) const;
    /// Turns its velocities with a body that has been moved and turned.
    void turn(const Rotation& rotation);
    void archive(StateArchive& state);

  private:
    Vec3d angular_velocity(const Rotation& rotation) const;
    Rotation turned(Rotation rotation, double seconds) const;
    Eigensystem principal_moments() const;
    bool has_inertia() const;

    double mass_ = 1;
    Vec3d centre_; ///< of mass, in the body frame
    /// The inertia about the centre, in the body frame; three columns.
    Matrix3 inertia_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    // The velocity of the centre, and the angular momentum and velocity about it, along the world's axes.
    Vec3d velocity_, angular_momentum_, angular_velocity_;
    Vec3d gained_; ///< the acceleration of the centre by the last push()
};

} // namespace echinus
