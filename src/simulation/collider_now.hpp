#pragma once

#include "collider/frame_change.hpp"
#include "simulation/material_motion.hpp"
#include "simulation/particles.hpp"

#include <echinus/collider.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/simulation.hpp>

namespace echinus {

/// A collider with a surface (map_of_surface()) as it stands in one substep, and what is needed to keep
/// particles off it.
///
/// Lengths are those of the world in the *body frame*: the collider's frame with its scale applied. The map
/// is asked in its own frame, *local*.
struct ColliderNow {
    ExactMapView map;
    Vec3d scale;
    FrameChange local, body;
    MaterialMotion material;
    float step;      ///< of the lattice, in world units
    float guard;     ///< no particle is left nearer to the surface than this
    float thickness; ///< at least two guards
    float friction;
    /// An open surface that lets nothing through: each particle stays on its side, and none is inside.
    bool two_sided;
    /// [particle_count] How the surface beside each particle deforms in this substep, in the world, beyond
    /// what the collider itself moves; null where it does not.
    const PointArrays* drift = nullptr;
    float coordinate_sum; ///< of where collider and mesh stand; bounds what rounding loses

    /// @pre the collider has a surface, and the options a thickness
    ColliderNow(const Collider& collider, const RigidTransform& previous_pose,
                const SimulationOptions& options);

    /// How the surface beside a particle has moved in this substep.
    Vec3f motion_at(std::size_t particle, const Vec3f& position) const {
        return drift == nullptr ? material.at(position) : material.at(position) + (*drift)[particle];
    }
    Vec3f to_body(const Vec3f& point_local) const { return Vec3f(times(Vec3d(point_local), scale)); }
    /// Is the place outside, whichever way the particle came?
    bool outside(const Vec3f& position) const {
        return two_sided || !contains(map, local.point_to_local(position));
    }
};

} // namespace echinus
