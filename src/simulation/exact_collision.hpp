#pragma once

#include "collider/frame_change.hpp"
#include "simulation/material_motion.hpp"
#include "simulation/surface_memory.hpp"

#include <echinus/simulation.hpp>

#include <cstdint>

namespace echinus {

/// Particles against one collider with an exact map, for one frame.
///
/// In the relaxations a particle is asked for its nearest point only when it has moved so far since the last
/// answer that another one is possible: the distance to the surface changes by no more than the particle
/// moves. All that is remembered is kept in the *body frame*, the collider's frame with its scale applied: it
/// moves along with the collider, and lengths are those of the world.
///
/// After the relaxations comes the proof. A particle is *free* when it is outside and the chord from the last
/// place proven free, both in the map's frame, crosses no surface.
class ExactCollision {
  public:
    ExactCollision(const Collider& collider, const RigidTransform& previous_pose,
                   const SimulationOptions& options);

    /// Is the place outside? Remembers it as free if it is.
    void begin(SurfaceMemory& memory, const Vec3f& position) const;

    /// One relaxation of one particle: to the thickness over the nearest point, with friction.
    /// @return whether it was pushed
    bool relax(SurfaceMemory& memory, Vec3f& position, Vec3f& previous, SimulationProfile& profile) const;

    /// Is the particle free where it is, and as far from the surface as a particle at rest has to be? One
    /// that never was free need only be outside.
    bool settled(const SurfaceMemory& memory, const Vec3f& position) const;

    /// Is the particle free where it is?
    bool free_at(const SurfaceMemory& memory, const Vec3f& position) const;

    /// Leads a particle that is not settled to a free place: before the crossing, at the thickness or what
    /// room there is; or where it was free last, carried along. Its velocity into the surface is gone.
    /// @return whether there was such a place; else nothing is changed
    bool rescue(const SurfaceMemory& memory, Vec3f& position, Vec3f& previous) const;

    /// To the place proven free last, carried along, at rest on the collider. @return whether it is free
    /// there
    bool carry(const SurfaceMemory& memory, Vec3f& position, Vec3f& previous) const;

    /// Remembers the place of a particle that is free.
    void commit(SurfaceMemory& memory, const Vec3f& position) const;

    /// Outside? Whatever way the particle came.
    bool outside(const Vec3f& position) const;

  private:
    void ask(SurfaceMemory& memory, const Vec3f& position_body, const Vec3f& position, float speed,
             SimulationProfile& profile) const;
    bool meet_on_the_way(SurfaceMemory& memory, const Vec3f& position_body, const Vec3f& position_local,
                         SimulationProfile& profile) const;
    bool within_known_ball(const SurfaceMemory& memory, const Vec3f& position_body) const;
    bool way_is_free(const SurfaceMemory& memory, const Vec3f& position_local) const;
    /// Of the face that was met: along the body's axes, towards the side the particle came from.
    Vec3f free_normal(const SurfaceMemory& memory, const SweepHit& hit, const Vec3f& to_local) const;
    Vec3f to_body(const Vec3f& point_local) const {
        return Vec3f(times(Vec3d(point_local), collider_.scale));
    }
    bool leave(const SurfaceMemory& memory, const Vec3f& target_body, const Vec3f& normal_body,
               Vec3f& position, Vec3f& previous) const;
    bool lead_out(const SurfaceMemory& memory, Vec3f& position, Vec3f& previous) const;

    const Collider& collider_;
    const ExactMapView& map_;
    FrameChange local_, body_;
    MaterialMotion material_;
    float step_;      ///< of the lattice, in world units
    float thickness_; ///< at least some lattice steps
    float friction_;
    bool keep_free_;
};

} // namespace echinus
