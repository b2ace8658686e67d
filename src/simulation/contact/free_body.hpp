#pragma once

#include "mechanics/elastic_model.hpp"
#include "simulation/contact/contact_set.hpp"
#include "simulation/motion/rigid_body.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace echinus {

/// A collider that moves freely, as unknowns of a step: four control points of a quarter of its mass each,
/// which have its centre and its inertia and so move as it does (affine bodies, Lan et al. 2022), and a stiff
/// tetrahedron between them. They stand beside the particles of the deformable, and contacts act on them as
/// on those, so that neither side of a contact moves by what the other one did in the step before.
class FreeBody {
  public:
    static constexpr std::size_t kPointCount = 4;

    /// @param first_point  its number among the particles
    FreeBody(std::uint32_t collider, std::uint32_t first_point, const RigidBody& body);

    std::uint32_t collider() const { return collider_; }
    std::uint32_t first_point() const { return first_point_; }
    double mass() const { return kPointCount * point_mass_; }
    /// Does it stand for this body?
    bool is_of(std::uint32_t collider, const RigidBody& body) const;
    /// Adds the control points and their tetrahedron, which they follow those that are there.
    /// @param time_step  the longest of a step, s
    void add_to(ElasticParts& parts, double time_step) const;

    /// Puts the control points where a pose has them.
    void put(const RigidTransform& pose, std::span<Vec3d> places) const;
    /// The pose whose control points are nearest to these. @param near  a pose not far from it
    RigidTransform fit(std::span<const Vec3d> places, const RigidTransform& near) const;
    /// The force on its control points that ends a step here, about the pose's translation.
    /// @param led  where inertia and gravity led it
    Load load(const RigidTransform& led, double seconds) const;

    /// Lets a contact act on the control points, too. @param point  of the body, in the world, that it
    /// touches @param start  as of ContactSet::add(), of the other part: changed to both
    void join(ContactSet::Contact& contact, Vec3d& start, const Vec3d& point) const;

    RigidTransform start_pose; ///< where the step began
    RigidTransform safe_pose;  ///< in the safe state
    RigidTransform goal_pose;  ///< where the displacement that is looked at leads
    bool is_stopped = false;   ///< by what cannot yield to it

  private:
    std::array<Vec3d, kPointCount> points_at(const RigidTransform& pose) const;

    std::uint32_t collider_, first_point_;
    double point_mass_;
    Vec3d centre_;
    Matrix3 spread_; ///< the lower triangular root of the second moments; three columns
};

} // namespace echinus
