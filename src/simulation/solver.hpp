#pragma once

#include "geometry/workers.hpp"
#include "simulation/attachments.hpp"
#include "simulation/bounds.hpp"
#include "simulation/coarse_sheets.hpp"
#include "simulation/collider_motions.hpp"
#include "simulation/collisions.hpp"
#include "simulation/deforming_collider.hpp"
#include "simulation/energy_limit.hpp"
#include "simulation/folds.hpp"
#include "simulation/frame_parts.hpp"
#include "simulation/gentle_sticks.hpp"
#include "simulation/load_meter.hpp"
#include "simulation/particles.hpp"
#include "simulation/rest.hpp"
#include "simulation/state/fingerprint.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/sticks.hpp"
#include "simulation/stretched_part.hpp"
#include "simulation/surfaces/surface_collision.hpp"
#include "simulation/tetrahedra.hpp"
#include "simulation/wind.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace echinus {

/// The parts of a simulation. `deformable` is the user's view: it changes when a frame is complete.
class Simulation::Solver {
  public:
    Solver(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);

    void step();
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity);
    void blow(const Vec3d& wind, double rate);
    /// @throws Error InvalidOptions, as DeformingCollider's
    void lead_vertices(std::size_t collider, std::span<const Vec3f> vertices_local);
    void follow_cache(std::size_t collider, VertexCache cache);
    Load load_on(std::size_t collider) const;
    Residual residual() const;
    std::string name_of_collider(std::size_t collider) const;
    /// Of all that decides how the simulation goes on. Reading may leave a part of it when it throws.
    void archive(StateArchive& state);
    /// Of what does not change while it goes on: options, the deformable and where it began, each collider.
    StateFingerprint fingerprint() const;
    bool at_rest() const { return rest_.at_rest() && all_arrived(); }

    Deformable deformable;
    std::vector<Collider> colliders;
    ColliderMotions motions;
    SimulationOptions options;
    std::uint32_t frame = 0;
    double largest_speed;
    SimulationProfile profile;

  private:
    template <typename Lead>
    void lead_surface(std::size_t collider, const Lead& lead);
    void build_maps();
    void deform();
    void prepare_next_frame();
    bool all_arrived() const;
    void begin_frame();
    void begin_energy_limit();
    void integrate(double share_kept);
    std::uint32_t begin_collisions();
    void divide_frame(std::uint32_t part_count);
    void begin_part(bool is_divided);
    void step_part(bool is_first);
    void join_parts();
    void look_ahead();
    void move_colliders(std::uint32_t substep);
    void begin_constraints();
    void relax_coarse_sheets();
    void relax_constraints();
    void relax_tetrahedra();
    void collide();
    void relax_stretched_part();
    void keep_free();
    void publish();
    void judge_frame();
    void archive_colliders(StateArchive& state);

    Workers workers_;
    Particles particles_;
    StickArrays sticks_;
    FoldArrays folds_;
    TetrahedronArrays tetrahedra_;
    std::optional<EnergyLimit> energy_limit_; ///< with tetrahedra
    std::optional<CoarseSheets> coarse_sheets_;
    Attachments attachments_;
    std::vector<std::optional<DeformingCollider>> deforming_; ///< by collider; none where it never deformed
    std::vector<const SurfaceMotion*> surface_motions_;       ///< by collider, in this frame
    std::vector<float> clearances_;                           ///< of the particles, while it begins
    Collisions collisions_;
    std::optional<SurfaceCollision> surfaces_;
    std::optional<StretchedPart> stretched_part_; ///< with contact of surfaces, by Verlet
    std::optional<GentleSticks> gentle_sticks_;   ///< with contact of the deformable with itself, by Verlet
    std::optional<LoadMeter> meter_;
    RestWatch rest_;
    Bounds bounds_;
    Wind wind_;
    bool goals_give_way_;
    std::optional<FrameParts> parts_;         ///< with contact of the deformable with itself
    SimulationOptions part_;                  ///< for the part of a frame at hand: all of it, mostly
    double substep_seconds_;                  ///< of that
    std::uint64_t start_hash_;                ///< of where particles began
    std::vector<RigidTransform> start_poses_; ///< of the colliders
};

} // namespace echinus
