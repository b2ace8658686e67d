#pragma once

#include "simulation/coarse_sheets.hpp"
#include "simulation/collisions.hpp"
#include "simulation/energy_limit.hpp"
#include "simulation/folds.hpp"
#include "simulation/frame_parts.hpp"
#include "simulation/gentle_sticks.hpp"
#include "simulation/load_meter.hpp"
#include "simulation/particles.hpp"
#include "simulation/solver.hpp"
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

/// Sticks, folds and tetrahedra relaxed one after the other: Jakobsen's method, and XPBD.
class RelaxationSolver : public Solver {
  public:
    RelaxationSolver(Deformable deformable, std::vector<Collider> colliders,
                     const SimulationOptions& options);

    std::unique_ptr<Solver> copy() const override { return std::make_unique<RelaxationSolver>(*this); }
    void step() override;
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity) override;
    void blow(const Vec3d& wind, double rate) override;
    Load load_on(std::size_t collider) const override;
    void archive(StateArchive& state) override;

  private:
    void deform();
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

    Particles particles_;
    StickArrays sticks_;
    FoldArrays folds_;
    TetrahedronArrays tetrahedra_;
    std::optional<EnergyLimit> energy_limit_; ///< with tetrahedra
    std::optional<CoarseSheets> coarse_sheets_;
    std::vector<const SurfaceMotion*> surface_motions_; ///< by collider, in this frame
    std::vector<float> clearances_;                     ///< of the particles, while it begins
    Collisions collisions_;
    std::optional<SurfaceCollision> surfaces_;
    std::optional<StretchedPart> stretched_part_; ///< with contact of surfaces, by Verlet
    std::optional<GentleSticks> gentle_sticks_;   ///< with contact of the deformable with itself, by Verlet
    std::optional<LoadMeter> meter_;
    Wind wind_;
    bool goals_give_way_;
    std::optional<FrameParts> parts_; ///< with contact of the deformable with itself
    SimulationOptions part_;          ///< for the part of a frame at hand: all of it, mostly
    double substep_seconds_;          ///< of that
};

} // namespace echinus
