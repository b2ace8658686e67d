#pragma once

#include "mechanics/elastic_model.hpp"
#include "mechanics/linear/body_translations.hpp"
#include "mechanics/linear/conjugate_gradients.hpp"
#include "mechanics/linear/multigrid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The positions and velocities of particles and, for those that have a history, also their values at the
/// beginning of the last step.
struct Motion {
    std::vector<Vec3d> places, velocities;
    std::vector<Vec3d> places_before, velocities_before;
    /// 1 if the previous motion is smooth, so that the step is of second order (BDF2); 0 after an impact, or
    /// if the host has set a velocity: the step is then of first order (implicit Euler).
    std::vector<std::uint8_t> is_smooth;

    explicit Motion(std::size_t particle_count)
        : places(particle_count), velocities(particle_count), places_before(particle_count),
          velocities_before(particle_count), is_smooth(particle_count) {}
    std::size_t particle_count() const { return places.size(); }
};

/// The energy in addition to the elastic one: that of contacts and friction.
class ContactEnergy {
  public:
    virtual ~ContactEnergy() = default;
    virtual double energy(Places places, const Workers& workers) const = 0;
    /// The gradient and a positive semi-definite Hessian, which is added to the diagonal blocks of the
    /// matrix, to other blocks of its pattern, and to its contacts. If `hessian` is null, only the gradient
    /// is computed.
    virtual void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                                 const Workers& workers) const = 0;
};

/// The limits of a step's cost. A step that has converged ends earlier.
struct StepBudget {
    std::uint32_t newton_steps = 2;
    std::uint32_t linear_iterations = 8; ///< the most for each Newton step
    double linear_tolerance = 1e-2;      ///< relative to the residual
    double tolerance = 1e-6; ///< length; the last Newton step is one that moves particles by less than this,
                             ///< in the largest root mean square that its gain of energy permits
};

struct StepReport {
    std::uint32_t newton_steps = 0, linear_iterations = 0, halvings = 0;
    double last_move = 0; ///< of the last Newton step, measured like the tolerance of the budget
};

/// Steps of a deformable's motion: each finds a minimum of
///     sum of c m / (2 h^2) |x - y|^2 + elastic energy(x) + contact energy(x),
/// where y is the position to which inertia and outer forces would lead. It uses Newton's method with a
/// projected Hessian, a line search, and conjugate gradients preconditioned by multigrid (docs/mechanics.md).
/// Positions are in double: the residual of a stiff material is a small difference between large forces.
class ImplicitStep {
  public:
    explicit ImplicitStep(const ElasticParts& parts);

    /// Spreads marks over bodies, to all particles that the material connects with a marked one. The step has
    /// to be of the same order for all particles of a body, or the forces between them would not balance.
    /// @param marks  [particle] 0 or 1
    void spread(std::span<std::uint8_t> marks) const;
    /// Particles that follow those of a motion: the control points of rigid bodies.
    struct ControlPoints {
        Places places, inertial; ///< their positions, and those to which inertia and outer forces lead
    };
    /// Begins a step: computes where inertia leads.
    /// @param accelerations  [particle] the accelerations by outer forces
    /// @param is_held  [particle] 1 for those that follow goals instead of forces
    /// @param drag     the rate at which a velocity decays, 1/s
    /// @param control_points  take a step of first order without drag
    void begin(const Motion& motion, std::span<const Vec3d> accelerations,
               std::span<const std::uint8_t> is_held, double step, double drag = 0,
               const ControlPoints& control_points = {});
    /// Moves a guess towards the purely translated start of each body until the energy without contacts is no
    /// greater than there, so that a step that only descends ends no higher, however far inertia leads.
    /// @param start  [particle] the positions at which the step begins; held particles are where they are in
    /// the guess
    void calm(Places start, std::span<Vec3d> guess, const Workers& workers);
    /// Minimises the energy from a guess.
    /// @param places  in: the guess, with held particles at their goals. Out: the minimum, as far as the
    /// budget permits
    StepReport solve(std::span<Vec3d> places, const ContactEnergy* contacts, const StepBudget& budget,
                     const Workers& workers);

    double energy(Places places, const ContactEnergy* contacts, const Workers& workers) const;
    /// The forces that are missing for equilibrium at these positions: those that stop or hold particles, and
    /// the residual of the solver.
    ScratchVector<Vec3d> missing_forces(Places places, const ContactEnergy* contacts,
                                        const Workers& workers) const;
    /// Translates whole bodies of which nothing is held to positions at which contacts balance their inertia,
    /// by Newton's method in those translations alone. No elastic force acts against a translation, so any
    /// error that the solver leaves in one remains as momentum, whereas the material corrects errors within a
    /// body. Therefore translations are solved more precisely than everything else, and much faster.
    /// @param tolerance  the displacement that the imbalance of a body would cause against its inertia alone;
    /// length
    /// @return whether all bodies are in balance
    bool balance(std::span<Vec3d> places, const ContactEnergy& contacts, double tolerance,
                 const Workers& workers);
    /// The elastic part alone, without dissipation.
    const ElasticModel& elastic() const { return elastic_; }
    std::span<const double> masses() const { return masses_; }
    /// [particle] the stiffness with which the material resists a displacement of this particle alone,
    /// averaged over all directions; force / length
    std::vector<double> stiffnesses(Places places, const Workers& workers);
    /// [particle] the first particle of its body. A body consists of particles that the material connects.
    std::span<const std::uint32_t> bodies() const { return translations_.bodies(); }
    std::size_t level_count() const { return multigrid_.level_count(); }

  private:
    /// The energy of inertia alone.
    double kinetic_energy(Places places, const Workers& workers) const;
    void begin_derivatives(Places places);
    void add_derivatives(Places places, const ContactEnergy* contacts, const Workers& workers);
    void hold(const Workers& workers);
    double slope() const;
    /// Goes along the direction to a point where the energy is sufficiently lower. @param energy  in: at the
    /// given positions. Out: at the new ones. @param energy_at  returns the energy at other positions @return
    /// the share of the direction
    template <typename EnergyAt>
    double search(std::span<Vec3d> places, double& energy, const EnergyAt& energy_at,
                  std::uint32_t& halvings);

    std::vector<double> masses_;
    ElasticModel elastic_;
    BlockMatrix hessian_;
    Multigrid multigrid_;
    BodyTranslations translations_;
    ConjugateGradients linear_;
    std::span<const std::uint8_t> is_held_;
    std::vector<Vec3d> inertial_; ///< y
    std::vector<double> inertia_; ///< c m / h^2
    double total_inertia_ = 0;    ///< of those particles of the motion that are not held
    std::vector<Vec3d> gradient_, trial_;
    std::vector<Float4> right_side_, direction_;
};

/// The motion after a step that led to these positions. @param is_touching  [particle] 1 if a contact pushed
/// or stopped the particle, so that its velocity may have jumped: this step and the next then count as steps
/// of first order
void advance(Motion& motion, Places places, std::span<const std::uint8_t> is_touching, double step);

} // namespace echinus
