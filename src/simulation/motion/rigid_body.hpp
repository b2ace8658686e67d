#pragma once

#include "mechanics/small_matrix.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

namespace echinus {

/// A collider that moves freely: a solid of uniform density. Momentum is what it keeps from step to step, so
/// that nothing is lost as it turns.
class RigidBody {
  public:
    RigidBody() = default; ///< to be read from a state
    /// It goes on as the collider moves. @param surface  closed, in the body frame
    /// @throws Error InvalidOptions where the surface encloses nothing. @param name  of the collider
    RigidBody(const TriangleMesh& surface, double mass, const Collider& collider, const std::string& name);

    /// Adds to its momentum what a load about the pose's translation, and gravity, do in this time.
    void push(const RigidTransform& pose, const Load& load, const Vec3d& gravity, double seconds);
    /// Where its velocities lead it from a pose.
    RigidTransform after(const RigidTransform& pose, double seconds) const;
    /// Where gravity leads it, too.
    RigidTransform after(const RigidTransform& pose, const Vec3d& gravity, double seconds) const;
    /// The share of gravity by which it was accelerated in the last step: what contacts have left of it.
    double left_of(const Vec3d& gravity) const;
    /// The velocities of a collider that moves with it.
    void give_velocities(Collider& collider) const;

    double mass() const { return mass_; }
    Vec3d centre() const { return centre_; }
    /// Of the places of its mass about the centre, in the body frame: variances, and their axes.
    Eigensystem second_moments() const;
    /// Is no point of it faster than so much? A radian a second counts as a unit of length.
    bool is_slower_than(double speed) const;
    /// It is elsewhere, turned.
    void turn(const Rotation& rotation);
    void archive(StateArchive& state);

  private:
    Vec3d angular_velocity(const Rotation& rotation) const;
    Rotation turned(Rotation rotation, double seconds) const;
    Eigensystem principal_moments() const;
    bool has_inertia() const;

    double mass_ = 1;
    Vec3d centre_;                                       ///< of mass, in the body frame
    Matrix3 inertia_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; ///< about it, in the body frame; three columns
    // Of the centre and about it, in the world's axes.
    Vec3d velocity_, angular_momentum_, angular_velocity_;
    Vec3d gained_; ///< the acceleration of the centre by the last push
};

} // namespace echinus
