#pragma once

#include "simulation/attachments.hpp"
#include "simulation/collisions.hpp"
#include "simulation/folds.hpp"
#include "simulation/particles.hpp"
#include "simulation/rest.hpp"
#include "simulation/sticks.hpp"
#include "simulation/stretched_part.hpp"
#include "simulation/surfaces/surface_collision.hpp"
#include "simulation/wind.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace echinus {

/// The parts of a simulation. `deformable` is the user's view: it changes when a frame is complete.
class Simulation::Solver {
  public:
    Solver(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);

    void step();
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity);
    void blow(const Vec3d& wind, double rate);
    bool at_rest() const { return rest_.at_rest(); }

    Deformable deformable;
    std::vector<Collider> colliders;
    SimulationOptions options;
    std::uint32_t frame = 0;
    double largest_speed;
    SimulationProfile profile;

  private:
    void begin_frame();
    void integrate(double share_kept);
    void begin_surfaces();
    void look_ahead();
    void move_colliders();
    void restore_goals();
    void relax_constraints();
    void collide();
    void relax_stretched_part();
    void keep_free();
    void publish();
    void judge_frame();

    Particles particles_;
    StickArrays sticks_;
    FoldArrays folds_;
    Attachments attachments_;
    Collisions collisions_;
    std::optional<SurfaceCollision> surfaces_;
    std::optional<StretchedPart> stretched_part_; ///< with contact of surfaces, by Verlet
    RestWatch rest_;
    Wind wind_;
    bool goals_give_way_;
    double substep_seconds_;
    Vec3d start_centre_;
    double bound_ = 0;
};

} // namespace echinus
