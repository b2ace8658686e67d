#pragma once

#include "simulation/collisions.hpp"
#include "simulation/jakobsen_sticks.hpp"
#include "simulation/particles.hpp"
#include "simulation/solver.hpp"
#include "simulation/wind.hpp"

#include <vector>

namespace echinus {

/// The paper's simulation (section 2.3), which is that of Jakobsen (2001): Verlet integration, then sticks
/// relaxed one after the other and collision of the particles in each relaxation.
class JakobsenSolver : public Solver {
  public:
    /// @throws Error InvalidOptions
    JakobsenSolver(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);

    std::unique_ptr<Solver> copy() const override { return std::make_unique<JakobsenSolver>(*this); }
    void step() override;
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity) override;
    void blow(const Vec3d& wind, double rate) override;
    Load load_on(std::size_t) const override { return {}; }
    void archive(StateArchive& state) override;

  protected:
    // Handles and teleports need the other solver.
    void set_held(std::uint32_t, bool) override {}
    void move_particles(const RigidTransform&) override {}

  private:
    void begin_frame();
    void integrate();
    void move_colliders();
    void relax_sticks();
    void collide();
    void keep_free();
    void publish();
    void judge_frame();

    Particles particles_;
    std::vector<JakobsenStick> sticks_;
    Collisions collisions_;
    Wind wind_;
};

} // namespace echinus
