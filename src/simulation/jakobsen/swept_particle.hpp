#pragma once

#include "simulation/jakobsen/collider_now.hpp"
#include "simulation/jakobsen/free_places.hpp"
#include "simulation/particles.hpp"

#include <echinus/exact_map.hpp>

#include <cstddef>
#include <initializer_list>
#include <optional>

namespace echinus {

/// One particle, and its path from its last position free of a collider with an exact map.
///
/// A particle is *free* if it is outside and the chord from that position, both in the map's frame, crosses
/// no surface. It is *unproven* while that is not certain: the lattice rounds, so a position nearer to the
/// surface than the guard proves nothing. It is *lost* if it was free once and is not free now.
class SweptParticle {
  public:
    SweptParticle(const ColliderNow& collider, const FreePlaces& free_places, std::size_t i,
                  const Particles& particles);

    /// A particle that was never free only has to be outside.
    bool is_unproven() const;
    bool is_lost() const { return was_free_ && !is_free_at(position_local_); }

    /// The first crossing of the chord with the surface. @pre the particle was free once
    SweepHit crossing() const { return sweep(now_.map, free_local_, position_local_); }
    /// The normal of the face at the crossing, along the body's axes, towards the side from which the
    /// particle came.
    Vec3f free_normal(const SweepHit& crossing) const;

    /// A free position for an unproven particle: before the crossing, at the thickness or as far as there is
    /// room; or its last free position; or its present one, if there is little room. Its velocity into the
    /// surface is removed.
    std::optional<Placement> rescued() const;
    /// The last free position of the particle, moved along with the collider, at rest on it; none if it is
    /// not free there.
    std::optional<Placement> taken_back() const;

  private:
    bool is_free_at(const Vec3f& place_local) const;
    std::optional<Placement> rescued_before(const SweepHit& crossing) const;
    std::optional<Placement> rescued_from_guard() const;
    std::optional<Placement> rescued_from_inside() const;
    std::optional<Placement> first_free(std::initializer_list<float> gaps, const Vec3f& surface_local,
                                        const Vec3f& normal_body) const;
    std::optional<Placement> put(const Vec3f& target_body, const Vec3f& normal_body) const;

    const ColliderNow& now_;
    Vec3f position_, step_, position_local_;
    bool was_free_;
    Vec3f free_local_;
};

} // namespace echinus
