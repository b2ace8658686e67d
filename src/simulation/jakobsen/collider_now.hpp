#pragma once

#include "collider/frame_change.hpp"
#include "simulation/jakobsen/material_motion.hpp"

#include <echinus/collider.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/simulation.hpp>

namespace echinus {

/// A collider with a surface (map_of_surface()) in its pose in one frame, with the data for keeping particles
/// off it.
///
/// Lengths in the *body frame* are those of the world: the collider's frame with its scale applied. The map
/// is queried in its own frame, *local*.
struct ColliderNow {
    ExactMapView map;
    Vec3d scale;
    FrameChange local, body;
    MaterialMotion material;
    float step;      ///< of the lattice, in world units
    float guard;     ///< particles are kept at least this far from the surface
    float thickness; ///< at least two guards
    float friction;
    float coordinate_sum; ///< of the positions of collider and mesh; bounds the rounding

    /// @pre the collider has a surface, and the options a thickness
    ColliderNow(const Collider& collider, const RigidTransform& previous_pose,
                const SimulationOptions& options);

    Vec3f to_body(const Vec3f& point_local) const { return Vec3f(times(Vec3d(point_local), scale)); }
    bool outside(const Vec3f& position) const { return !contains(map, local.point_to_local(position)); }
};

} // namespace echinus
