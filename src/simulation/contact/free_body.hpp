#pragma once

#include "mechanics/elastic_model.hpp"
#include "simulation/contact/contact_set.hpp"
#include "simulation/motion/rigid_body.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace echinus {

/// A rigid body as unknowns of a step: four control points with a quarter of its mass each, which have the
/// body's centre of mass and inertia, and a stiff tetrahedron between them (affine bodies, Lan et al. 2022).
/// They come after the particles of the deformable, and contacts act on them as on particles. So both sides
/// of a contact are solved together, and neither is moved by forces of the step before.
class FreeBody {
  public:
    static constexpr std::size_t kPointCount = 4;

    /// @param first_point  the number of its first control point among the particles
    FreeBody(std::uint32_t collider, std::uint32_t first_point, const RigidBody& body);

    std::uint32_t collider() const { return collider_; }
    std::uint32_t first_point() const { return first_point_; }
    double mass() const { return kPointCount * point_mass_; }
    /// Does it represent this collider, with this mass, centre of mass and inertia?
    bool is_of(std::uint32_t collider, const RigidBody& body) const;
    /// Appends the control points and their tetrahedron.
    /// @param time_step  the longest step, in seconds
    void add_to(ElasticParts& parts, double time_step) const;

    /// Sets the positions of the control points to those in a pose.
    void put(const RigidTransform& pose, std::span<Vec3d> places) const;
    /// The rigid pose nearest to the control points. @param near  a pose close to it
    RigidTransform fit(std::span<const Vec3d> places, const RigidTransform& near) const;
    /// The load that explains why a step ended in the safe pose and not where inertia and gravity alone would
    /// have led; about the translation of the safe pose. @param led  the pose to which these would have led
    Load load(const RigidTransform& led, double seconds) const;

    /// Makes a contact act on the control points as well. @param point  where it touches the body, in the
    /// world
    /// @param start_apart  like `start` of ContactSet::add(). In: for the deformable's part. Out: relative to
    /// the body
    void join(ContactSet::Contact& contact, Vec3d& start_apart, const Vec3d& point) const;

    RigidTransform start_pose; ///< at the beginning of the step
    RigidTransform safe_pose;  ///< in the safe state
    RigidTransform goal_pose;  ///< at the end of the displacement that is examined
    bool is_stopped = false;   ///< stopped by something that cannot yield

  private:
    std::array<Vec3d, kPointCount> points_at(const RigidTransform& pose) const;

    std::uint32_t collider_, first_point_;
    double point_mass_;
    Vec3d centre_;
    Matrix3 spread_; ///< the principal axes, as long as the standard deviations of the mass along them
};

} // namespace echinus
