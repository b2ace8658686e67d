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

/// Keeps the particles off one collider. The kind of the collider's map decides how.
///
/// The relaxations push particles out. The proof at the end of a frame needs a map that can be swept; without
/// one nothing is proven, every particle counts as free, and these defaults say so.
class Collision {
  public:
    virtual ~Collision() = default;
    virtual std::unique_ptr<Collision> clone() const = 0;

    /// Between two frames: these particles begin anew where the frame that comes starts them.
    /// @pre the collider lets none of them through
    virtual void restart(std::span<const std::uint32_t> /*restarted*/, const Particles&) {}

    /// From the frame that comes on.
    virtual void set_friction(double friction) = 0;

    /// @param collider       where the frame leads it
    /// @param previous_pose  from where it comes
    virtual void begin_frame(const Collider& collider, const RigidTransform& previous_pose) = 0;
    /// Whether no particle can meet the collider in this frame, nor come within its thickness.
    /// @param starts, ends  boxes around all particles as the frame begins and ends
    virtual bool is_away(const AlignedBox<double>& /*starts*/, const AlignedBox<double>& /*ends*/) const {
        return false;
    }
    /// One relaxation of all particles.
    /// @param workers  may share them
    virtual void relax(Particles& particles, SimulationProfile& profile, const Workers& workers) = 0;
    /// The part of a motion in this frame that a particle keeps after an impact: nothing into the surface on
    /// which it is now, and friction along it for what was stopped.
    virtual Vec3d without_approach(std::size_t i, const Particles& particles, const Vec3d& motion) const = 0;

    /// Lists the particles that are not proven free where they are; pinned ones are never among them.
    virtual std::span<const std::uint32_t> find_unproven(const Particles&) { return {}; }
    virtual bool is_unproven(std::size_t /*i*/, const Particles&) const { return false; }
    /// Was the particle free once, and is it not free where it is now?
    virtual bool is_lost(std::size_t /*i*/, const Particles&) const { return false; }
    /// Puts an unproven particle to a free place, if there is one near; else nothing is changed.
    virtual void rescue(std::size_t /*i*/, Particles&) const {}
    /// Puts the particle to the place where it was free last, moved along with the collider, at rest on it.
    virtual void take_back(std::size_t /*i*/, Particles&) const {}
    /// The particle ends this frame lost. @return false when that was said before in this frame
    virtual bool mark_lost(std::size_t /*i*/) { return false; }
    virtual void end_frame(const Particles&) {}

    /// @param collider  where it stands between two frames
    virtual void archive(StateArchive&, const Collider& /*collider*/) {}
};

} // namespace echinus
