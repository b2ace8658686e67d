#pragma once

#include "mechanics/energy_term.hpp"
#include "simulation/contact/contact_set.hpp"
#include "simulation/contact/free_body.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace echinus {

/// Contact of a deformable's particles with colliders that have no faces for it: the paper's distance map, a
/// user's own map, and exact maps where surfaces do not collide. A particle is a contact with the plane that
/// the map answers with; nothing is proven. A particle that ends inside all the same is put outside, as the
/// paper has it, and keeps no velocity into the collider or out of it.
class ParticleContacts {
  public:
    /// @param collides  [collider] 1 for those that particles collide with
    ParticleContacts(const Deformable& deformable, const std::vector<Collider>& colliders,
                     std::span<const std::uint8_t> collides, double thickness, double friction);

    bool empty() const { return obstacles_.empty(); }

    /// @param before, after  the colliders where the step begins, and where it ends
    /// @param start    where particles are when it begins
    /// @param is_held  [particle]
    void begin_step(const std::vector<Collider>& before, const std::vector<Collider>& after, Places start,
                    std::span<const std::uint8_t> is_held);
    /// A free body has gone there in the step.
    void move(std::uint32_t collider, const RigidTransform& pose);
    /// Adds the contacts at these places. @param strengths, is_solved  as SurfaceContacts::find_contacts()
    void add_to(ContactSet& contacts, Places places, std::span<const double> masses,
                std::span<const double> strengths, std::span<const FreeBody> free_bodies, bool is_solved);
    /// Puts particles that are inside outside.
    /// @param is_put  [particle] out: 1 for those
    /// @return whether there were any
    bool put_outside(std::span<Vec3d> places, std::span<std::uint8_t> is_put);
    /// The velocities of those that were put outside do not count that displacement; of them, and of those
    /// that began the step inside a collider, the part across its surface is the collider's.
    /// @param after  the colliders as the step has left them: free bodies with their velocities
    void end_step(const std::vector<Collider>& after, Places places, std::span<Vec3d> velocities,
                  double step);

    /// Queries of maps since the last call, one for each particle and collider.
    std::uint64_t take_query_count() { return std::exchange(query_count_, 0); }
    /// Particles since the last call that ended a step inside: maps that overlap leave them no place.
    std::uint64_t take_lost_count() { return std::exchange(lost_count_, 0); }

  private:
    struct Obstacle {
        std::uint32_t number; ///< of the collider
        std::vector<std::uint8_t> passes;
    };
    /// The answer of a collider's map about a particle.
    struct Found {
        std::uint32_t particle, obstacle;
        Vec3d point, normal;
        double depth;
        bool inside;
    };
    /// The arrays that are asked for.
    struct Answers {
        std::vector<std::uint32_t> particles, colliders;
        std::vector<Vec3d> points;
        std::vector<Vec3f> normals;
        std::vector<float> depths;
        std::vector<std::uint8_t> inside;
        void resize(std::size_t count);
    };
    struct Inside {
        std::uint32_t particle, obstacle;
    };
    struct Put : Inside {
        Vec3d from;
        bool goes_back; ///< to where the step began
    };

    void find(Places places, double margin);
    void keep_with_surface(const Inside& inside, Places places, std::span<Vec3d> velocities) const;
    Vec3d carried(std::uint32_t particle, std::uint32_t obstacle) const;
    bool came_through_a_side(const Found& found, const Vec3d& place) const;

    double thickness_, friction_;
    std::vector<Obstacle> obstacles_;
    std::vector<Collider> before_, after_; ///< [obstacle]
    std::vector<Vec3d> start_;
    std::span<const std::uint8_t> is_held_;
    std::vector<Inside> began_inside_; ///< sorted
    std::vector<Put> put_;             ///< outside, in this step
    Answers answers_;                  ///< of the last find()
    std::vector<Found> found_;         ///< of the last find()
    std::uint64_t query_count_ = 0, lost_count_ = 0;
};

} // namespace echinus
