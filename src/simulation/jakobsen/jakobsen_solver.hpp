#pragma once

#include "simulation/jakobsen/collisions.hpp"
#include "simulation/particles.hpp"
#include "simulation/solver.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A constraint as its relaxation needs it.
struct JakobsenConstraint {
    std::uint32_t a, b;
    float rest_length;
    float share_a, share_b; ///< of its error, by the masses and the stiffness
};

/// Wind as a change of velocity between frames.
class Wind {
  public:
    /// Gives each particle a share of the wind's velocity across the faces around it, as seen from the
    /// particle: the mean over these faces.
    /// @param wind_step  how far the air moves in one frame
    void blow(std::span<const Triangle> faces, const Vec3f& wind_step, float share, Particles& particles);

  private:
    /// The motion that the faces around a particle would give it.
    struct Gust {
        Vec3f sum;
        std::uint32_t face_count = 0;

        void add(const Vec3f& across) {
            sum += across;
            ++face_count;
        }
        Vec3f mean() const { return sum * (1 / static_cast<float>(face_count)); }
    };

    std::vector<Gust> gusts_; ///< of each particle
};

/// The paper's simulation (section 2.3), which is that of Jakobsen (2001): Verlet integration, then
/// constraints relaxed one after the other and collision of the particles in each relaxation.
class JakobsenSolver : public Solver {
  public:
    /// @throws Error InvalidOptions
    JakobsenSolver(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);

    std::unique_ptr<Solver> copy() const override { return std::make_unique<JakobsenSolver>(*this); }
    void step() override;
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity) override;
    void blow(const Vec3d& wind, double rate) override;
    Load load_on(std::size_t) const override { return {}; }
    void record_contacts(bool) override {}
    std::span<const ContactPoint> contact_points() const override { return {}; }
    void archive(StateArchive& state) override;

  protected:
    // Handles and teleports need the other solver.
    void set_held(std::uint32_t, bool) override {}
    void move_particles(const RigidTransform&) override {}

  private:
    void begin_frame();
    void integrate();
    void move_colliders();
    void relax_constraints();
    void collide();
    void keep_free();
    void publish();
    void publish_velocities();
    void judge_frame();

    Particles particles_;
    std::vector<JakobsenConstraint> constraints_;
    Collisions collisions_;
    Wind wind_;
};

} // namespace echinus
