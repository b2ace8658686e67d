#pragma once

#include "mechanics/elastic_model.hpp"
#include "mechanics/linear/body_translations.hpp"
#include "mechanics/linear/conjugate_gradients.hpp"
#include "mechanics/linear/multigrid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Where particles are and how they move. Of those that have a history, the last step's beginning, too.
struct Motion {
    std::vector<Vec3d> places, velocities;
    std::vector<Vec3d> places_before, velocities_before;
    /// 1 where what came before is smooth, so that the step is of second order (BDF2); 0 after an impact, or
    /// where the host has set a velocity, where it is of first order (implicit Euler).
    std::vector<std::uint8_t> is_smooth;

    explicit Motion(std::size_t particle_count)
        : places(particle_count), velocities(particle_count), places_before(particle_count),
          velocities_before(particle_count), is_smooth(particle_count) {}
    std::size_t particle_count() const { return places.size(); }
};

/// Energy beside the elastic one: of contacts, of friction.
class ContactEnergy {
  public:
    virtual ~ContactEnergy() = default;
    virtual double energy(Places places, const Workers& workers) const = 0;
    /// The gradient, and a positive semi-definite Hessian: added to the diagonal blocks of the matrix, to
    /// others of its pattern, and to its contacts; null: the gradient alone.
    virtual void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                                 const Workers& workers) const = 0;
};

/// The bound of a step's cost. It ends earlier where it has converged.
struct StepBudget {
    std::uint32_t newton_steps = 2;
    std::uint32_t linear_iterations = 8; ///< at most, of each
    double linear_tolerance = 1e-2;      ///< of the residual, relative
    double tolerance = 1e-6; ///< a Newton step that moves particles less than this is the last, in the
                             ///< root mean square that is possible by the energy it gains; length
};

struct StepReport {
    std::uint32_t newton_steps = 0, linear_iterations = 0, halvings = 0;
    double last_move = 0; ///< in the last Newton step, as the budget's tolerance
};

/// Steps of a deformable's motion: each finds a minimum of
///     sum of c m / (2 h^2) |x - y|^2 + elastic energy(x) + contact energy(x),
/// y where inertia and outer forces would lead, by Newton's method with a projected Hessian, a line search,
/// and conjugate gradients preconditioned by multigrid (docs/mechanics.md). Places are in double: the
/// residual of a stiff material is a small difference of large forces.
class ImplicitStep {
  public:
    explicit ImplicitStep(const ElasticParts& parts);

    /// Spreads marks over bodies: to all particles that the material connects with one that has it. The step
    /// is to be of the same order for all of those, or what they do to each other would not balance.
    /// @param marks  [particle] 0 or 1
    void spread(std::span<std::uint8_t> marks) const;
    /// Particles after those of a motion: the control points of rigid bodies.
    struct ControlPoints {
        Places places, inertial; ///< where they are, and where inertia and outer forces lead them
    };
    /// Where inertia leads: begins a step. @param accelerations  [particle] by outer forces
    /// @param is_held  [particle] 1 for those that do not follow forces, but goals
    /// @param drag     the rate at which a velocity decays, 1/s
    /// @param control_points  make a step of first order without drag
    void begin(const Motion& motion, std::span<const Vec3d> accelerations,
               std::span<const std::uint8_t> is_held, double step, double drag = 0,
               const ControlPoints& control_points = {});
    /// Brings a guess nearer to what only moves as a whole until the energy without contacts is no greater
    /// than there, so that a step which only descends ends no higher, however far inertia leads.
    /// @param start  [particle] where the step begins; held particles as in the guess
    void calm(Places start, std::span<Vec3d> guess, const Workers& workers);
    /// Minimises from a guess. @param places  in: the guess; held particles are where they are to be. Out:
    /// the minimum as far as the budget leads
    StepReport solve(std::span<Vec3d> places, const ContactEnergy* contacts, const StepBudget& budget,
                     const Workers& workers);

    double energy(Places places, const ContactEnergy* contacts, const Workers& workers) const;
    /// The forces that are missing for equilibrium at these places: those by which particles are stopped or
    /// held, and what the solver has left.
    ScratchVector<Vec3d> missing_forces(Places places, const ContactEnergy* contacts,
                                        const Workers& workers) const;
    /// Translates whole bodies of which nothing is held to where contacts balance their inertia, by Newton's
    /// method in those translations alone. No elastic force acts against a translation, so whatever the
    /// solver leaves of one stays as momentum, while the material pulls back what is left within a body: so
    /// this is solved more exactly than all else, and far faster.
    /// @param tolerance  how far a body may go, as if inertia alone kept it; length
    /// @return whether all are in balance
    bool balance(std::span<Vec3d> places, const ContactEnergy& contacts, double tolerance,
                 const Workers& workers);
    /// The elastic part alone, without dissipation in progress.
    const ElasticModel& elastic() const { return elastic_; }
    std::span<const double> masses() const { return masses_; }
    /// [particle] the stiffness with which the material resists a displacement of it alone, in the mean of
    /// all directions; force / length
    std::vector<double> stiffnesses(Places places, const Workers& workers);
    /// [particle] the first one of its body: of those that the material connects.
    std::span<const std::uint32_t> bodies() const { return translations_.bodies(); }
    std::size_t level_count() const { return multigrid_.level_count(); }

  private:
    /// Of inertia alone.
    double kinetic_energy(Places places, const Workers& workers) const;
    void begin_derivatives(Places places);
    void add_derivatives(Places places, const ContactEnergy* contacts, const Workers& workers);
    void hold(const Workers& workers);
    double slope() const;
    /// Goes so far along the direction that the energy falls. @param energy  in: at the places. Out: at the
    /// new ones. @param energy_at  gives that of other places @return the share of the direction
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
    double total_inertia_ = 0;    ///< of particles of the motion that are not held
    std::vector<Vec3d> gradient_, trial_;
    std::vector<Float4> right_side_, direction_;
};

/// The motion after a step that led to these places. @param is_touching  [particle] 1 where a contact pushed
/// or stopped a particle, so that its velocity may have jumped: there the step counts as one of first order,
/// and so does the next
void advance(Motion& motion, Places places, std::span<const std::uint8_t> is_touching, double step);

} // namespace echinus
