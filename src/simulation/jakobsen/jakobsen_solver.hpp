#pragma once

#include "simulation/jakobsen/collisions.hpp"
#include "simulation/particles.hpp"
#include "simulation/solver.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A constraint in the form that its relaxation needs.
struct JakobsenConstraint {
    std::uint32_t a, b;
    float rest_length;
    float share_a, share_b; ///< the shares of its error for a and b, by the masses and the stiffness
};

/// Wind, as a change of velocities between frames.
class Wind {
  public:
    /// Gives each particle a share of the wind's velocity across the surrounding faces relative to the
    /// particle, averaged over these faces.
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

    std::vector<Gust> gusts_; ///< [particle]
};

/// The paper's simulation (section 2.3), following Jakobsen (2001): Verlet integration, then relaxations,
/// each of which treats all constraints in turn and then the collisions of particles.
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
    // Handles and teleports need the newton solver.
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
