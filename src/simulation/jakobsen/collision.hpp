#pragma once

#include "geometry/box.hpp"
#include "geometry/workers.hpp"
#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace echinus {

/// Keeps the particles off one collider, in a way that depends on the kind of its map.
///
/// The relaxations push particles out. The proof at the end of a frame needs a map that can be swept; without
/// one, nothing is proven and every particle counts as free, as these defaults state.
class Collision {
  public:
    virtual ~Collision() = default;
    virtual std::unique_ptr<Collision> clone() const = 0;

    /// Between two frames: these particles start again, at their positions at the start of the next frame.
    /// @pre the collider lets none of them through
    virtual void restart(std::span<const std::uint32_t> /*restarted*/, const Particles&) {}

    /// Takes effect in the next frame.
    virtual void set_friction(double friction) = 0;

    /// @param collider       in its pose at the end of the frame
    /// @param previous_pose  its pose at the beginning
    virtual void begin_frame(const Collider& collider, const RigidTransform& previous_pose) = 0;
    /// Whether no particle can meet the collider in this frame or come within its thickness.
    /// @param starts, ends  boxes around all particles at the beginning and at the end of the frame
    virtual bool is_away(const AlignedBox<double>& /*starts*/, const AlignedBox<double>& /*ends*/) const {
        return false;
    }
    /// One relaxation of all particles.
    /// @param workers  may share the particles
    virtual void relax(Particles& particles, SimulationProfile& profile, const Workers& workers) = 0;
    /// The part of a motion in this frame that a particle keeps after an impact: no component into the
    /// surface on which it is now, and a tangential component reduced by friction.
    virtual Vec3d without_approach(std::size_t i, const Particles& particles, const Vec3d& motion) const = 0;

    /// Lists the particles that are not proven free in their positions, never pinned ones.
    virtual std::span<const std::uint32_t> find_unproven(const Particles&) { return {}; }
    virtual bool is_unproven(std::size_t /*i*/, const Particles&) const { return false; }
    /// Was the particle free once, and is it not free now?
    virtual bool is_lost(std::size_t /*i*/, const Particles&) const { return false; }
    /// Puts an unproven particle in a free position if there is one nearby; otherwise nothing changes.
    virtual void rescue(std::size_t /*i*/, Particles&) const {}
    /// Puts the particle back to its last free position, moved along with the collider, at rest on it.
    virtual void take_back(std::size_t /*i*/, Particles&) const {}
    /// The particle ends this frame lost. @return false if it was already marked in this frame
    virtual bool mark_lost(std::size_t /*i*/) { return false; }
    virtual void end_frame(const Particles&) {}

    /// @param collider  in its pose between two frames
    virtual void archive(StateArchive&, const Collider& /*collider*/) {}
};

} // namespace echinus
