#pragma once

#include "geometry/workers.hpp"
#include "simulation/bounds.hpp"
#include "simulation/deforming_collider.hpp"
#include "simulation/motion/attachments.hpp"
#include "simulation/motion/collider_motions.hpp"
#include "simulation/motion/handles.hpp"
#include "simulation/particles.hpp"
#include "simulation/rest.hpp"
#include "simulation/state/fingerprint.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace echinus {

/// A simulation, independent of the method that moves its particles: the state of the deformable, of the
/// colliders and of rest. `deformable` is the user's view: it changes when a frame is complete.
class Solver {
  public:
    Solver(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);
    virtual ~Solver() = default;
    Solver& operator=(const Solver&) = delete;

    virtual std::unique_ptr<Solver> copy() const = 0;
    virtual void step() = 0;
    virtual void set_particle_velocity(std::size_t particle, const Vec3d& velocity) = 0;
    virtual void blow(const Vec3d& wind, double rate) = 0;
    virtual Load load_on(std::size_t collider) const = 0;
    virtual void record_contacts(bool is_on) = 0;
    virtual std::span<const ContactPoint> contact_points() const = 0;
    /// Writes or reads everything that determines how the simulation continues. If reading throws, a part may
    /// have been read.
    virtual void archive(StateArchive& state) = 0;

    /// @throws Error InvalidOptions
    void set_free(std::size_t collider, double mass);
    /// At once, or in the frame of its time. @throws Error InvalidOptions; the teleport is then dropped
    void teleport(const Teleport& teleport);
    /// Carries out the teleports of the next frame. @throws Error as teleport()
    void carry_out_teleports();
    Residual residual() const;
    /// @throws Error InvalidOptions, and the errors of DeformingCollider
    void lead_vertices(std::size_t collider, std::span<const Vec3f> vertices_local);
    void follow_cache(std::size_t collider, VertexCache cache);
    std::string name_of_collider(std::size_t collider) const;
    /// The fingerprint of what does not change during the simulation: the options, the deformable and its
    /// initial positions, and each collider.
    StateFingerprint fingerprint() const;
    bool at_rest() const { return rest_.at_rest() && all_arrived(); }

    Deformable deformable;
    std::vector<Collider> colliders;
    ColliderMotions motions;
    SimulationOptions options;
    std::uint32_t frame = 0;
    bool has_blown = false; ///< whether blow() was called for the next frame
    double largest_speed;
    SimulationProfile profile;

  protected:
    Solver(const Solver&) = default;

    /// A handle takes hold of a particle, or releases it.
    virtual void set_held(std::uint32_t particle, bool is_held) = 0;
    /// Moves all particles; the next frame treats them as if they had always been there.
    virtual void move_particles(const RigidTransform& motion) = 0;

    /// Builds all maps for the frame's end before anything moves: if a map cannot be built, nothing has
    /// changed.
    void build_maps();
    /// Lets an idle thread build the maps of the next frame in the meantime.
    void prepare_next_frame();
    /// Gives led colliders the velocities of the frame. @throws Error Diverged
    void move_colliders_on();
    void archive_counts(StateArchive& state);
    void archive_colliders(StateArchive& state);

    Workers workers_;
    Attachments attachments_;
    Handles handles_;
    std::vector<std::optional<DeformingCollider>> deforming_; ///< [collider] none if it never deformed
    RestWatch rest_;
    Bounds bounds_;

  private:
    template <typename Lead>
    void lead_surface(std::size_t collider, const Lead& lead);
    bool all_arrived() const;
    void carry_out(const Teleport& teleport);

    std::vector<Load> loads_;                 ///< [collider] of the frame before
    std::vector<Teleport> teleports_;         ///< that are still to come
    std::uint64_t start_hash_;                ///< of the initial positions
    std::vector<RigidTransform> start_poses_; ///< of the colliders
};

/// Makes the solver that the options name. @throws Error InvalidOptions, as Simulation's constructor
std::unique_ptr<Solver> make_solver(Deformable deformable, std::vector<Collider> colliders,
                                    const SimulationOptions& options);

} // namespace echinus
