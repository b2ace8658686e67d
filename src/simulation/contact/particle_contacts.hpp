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

/// Contact of a deformable's particles with colliders without usable faces: the paper's distance maps, a
/// user's own maps, and exact maps if surfaces do not collide. A particle is in contact with the plane that
/// the map returns; nothing is proven. A particle that nevertheless ends inside is put outside, as in the
/// paper, and keeps no velocity across the collider's surface.
class ParticleContacts {
  public:
    /// @param collides  [collider] 1 for colliders with which particles collide
    ParticleContacts(const Deformable& deformable, const std::vector<Collider>& colliders,
                     std::span<const std::uint8_t> collides, double thickness, double friction);

    bool empty() const { return obstacles_.empty(); }

    /// @param before, after  the colliders at the beginning and at the end of the step
    /// @param start    the positions of particles at the beginning
    /// @param is_held  [particle]
    void begin_step(const std::vector<Collider>& before, const std::vector<Collider>& after, Places start,
                    std::span<const std::uint8_t> is_held);
    /// A free body has moved to this pose in the step.
    void move(std::uint32_t collider, const RigidTransform& pose);
    /// Adds the contacts at these positions. @param strengths, is_solved  as in SurfaceContacts
    void add_to(ContactSet& contacts, Places places, std::span<const double> masses,
                std::span<const double> strengths, std::span<const FreeBody> free_bodies, bool is_solved);
    /// Puts particles that are inside a collider outside.
    /// @param is_put  [particle] out: 1 for particles that were put outside
    /// @return whether there were any
    bool put_outside(std::span<Vec3d> places, std::span<std::uint8_t> is_put);
    /// The velocities of particles that were put outside do not include that displacement. For them and for
    /// particles that began the step inside a collider, the component across its surface becomes the
    /// collider's.
    /// @param after  the colliders at the end of the step; free bodies with their new velocities
    void end_step(const std::vector<Collider>& after, Places places, std::span<Vec3d> velocities,
                  double step);

    /// The number of queries of maps since the last call, one for each particle and collider.
    std::uint64_t take_query_count() { return std::exchange(query_count_, 0); }
    /// The number of particles since the last call that ended a step inside a collider: overlapping maps
    /// leave them no room.
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
    /// The arrays for the answers of a query.
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
