#include "mechanics/implicit_step.hpp"

#include "mechanics/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

/// The step of BDF2: v = (x - from) / (2 h / 3) with from = (4 x0 - x00) / 3, and likewise for the velocity.
constexpr double kSecondOrderStep = 2.0 / 3;

} // namespace

ImplicitStep::ImplicitStep(const ElasticParts& parts)
    : masses_(parts.masses), elastic_(parts), hessian_(elastic_.pattern()),
      multigrid_(hessian_, parts.rest_places), translations_(hessian_), inertial_(masses_.size()),
      inertia_(masses_.size()), gradient_(masses_.size()), trial_(masses_.size()),
      right_side_(masses_.size()), direction_(masses_.size()) {
    elastic_.find_entries(hessian_);
}

void ImplicitStep::spread(std::span<std::uint8_t> marks) const {
    // The first particle of a body has the smallest number.
    for (std::size_t i = 0; i < marks.size(); ++i)
        if (marks[i] != 0) marks[bodies()[i]] = 1;
    for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = marks[bodies()[i]];
}

void ImplicitStep::begin(const Motion& motion, std::span<const Vec3d> accelerations,
                         std::span<const std::uint8_t> is_held, double step, double drag,
                         const ControlPoints& control_points) {
    is_held_ = is_held;
    translations_.begin_step(is_held);
    const std::size_t count = motion.particle_count();
    std::copy(motion.places.begin(), motion.places.end(), trial_.begin());
    std::copy(control_points.places.begin(), control_points.places.end(),
              trial_.begin() + static_cast<std::ptrdiff_t>(count));
    elastic_.begin_step(trial_, step);
    for (std::size_t i = count; i < masses_.size(); ++i) {
        inertia_[i] = masses_[i] / (step * step);
        inertial_[i] = control_points.inertial[i - count];
    }
    total_inertia_ = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d place = motion.places[i], velocity = motion.velocities[i];
        // The time in seconds for which the velocity at the end of the step acts, and the position and the
        // velocity from which the step starts.
        double seconds = step;
        Vec3d from = place, velocity_from = velocity;
        if (motion.is_smooth[i] != 0) {
            seconds = kSecondOrderStep * step;
            from = (place * 4 - motion.places_before[i]) * (1.0 / 3);
            velocity_from = (velocity * 4 - motion.velocities_before[i]) * (1.0 / 3);
        }
        // Drag pulls towards `from` like a spring of stiffness m * drag / seconds.
        const double kept = 1 / (1 + drag * seconds);
        inertia_[i] = masses_[i] / (seconds * seconds * kept);
        if (is_held_[i] == 0) total_inertia_ += inertia_[i];
        inertial_[i] = from + (velocity_from + accelerations[i] * seconds) * (seconds * kept);
    }
}

double ImplicitStep::kinetic_energy(Places places, const Workers& workers) const {
    return sum_of(masses_.size(), workers, [&](std::size_t i) {
        if (is_held_[i] != 0) return 0.0;
        const Vec3d away = places[i] - inertial_[i];
        return inertia_[i] / 2 * dot(away, away);
    });
}

double ImplicitStep::energy(Places places, const ContactEnergy* contacts, const Workers& workers) const {
    double energy = kinetic_energy(places, workers) + elastic_.energy(places, workers);
    if (contacts != nullptr) energy += contacts->energy(places, workers);
    return energy;
}

/// Sets the gradient and the Hessian to those of inertia.
void ImplicitStep::begin_derivatives(Places places) {
    hessian_.clear();
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        gradient_[i] = (places[i] - inertial_[i]) * inertia_[i];
        hessian_.blocks.values[hessian_.diagonal[i]].add_identity(static_cast<float>(inertia_[i]));
    }
}

void ImplicitStep::add_derivatives(Places places, const ContactEnergy* contacts, const Workers& workers) {
    begin_derivatives(places);
    elastic_.add_derivatives(places, gradient_, &hessian_, workers);
    if (contacts != nullptr) contacts->add_derivatives(places, gradient_, &hessian_, workers);
    hold(workers);
}

ScratchVector<Vec3d> ImplicitStep::missing_forces(Places places, const ContactEnergy* contacts,
                                                  const Workers& workers) const {
    ScratchVector<Vec3d> forces(masses_.size(), workers.scratch());
    for (std::size_t i = 0; i < masses_.size(); ++i) forces[i] = (places[i] - inertial_[i]) * inertia_[i];
    elastic_.add_derivatives(places, forces, nullptr, workers);
    if (contacts != nullptr) contacts->add_derivatives(places, forces, nullptr, workers);
    return forces;
}

std::vector<double> ImplicitStep::stiffnesses(Places places, const Workers& workers) {
    hessian_.clear();
    elastic_.begin_step(places, std::numeric_limits<double>::infinity()); // without damping
    elastic_.add_derivatives(places, gradient_, &hessian_, workers);
    std::vector<double> stiffnesses(masses_.size());
    for (std::size_t i = 0; i < stiffnesses.size(); ++i)
        stiffnesses[i] = double{hessian_.blocks.values[hessian_.diagonal[i]].trace()} / 3;
    return stiffnesses;
}

bool ImplicitStep::balance(std::span<Vec3d> places, const ContactEnergy& contacts, double tolerance,
                           const Workers& workers) {
    const auto energy_at = [&](Places at) {
        return kinetic_energy(at, workers) + contacts.energy(at, workers);
    };
    double energy = energy_at(places);
    for (std::uint32_t step = 0;; ++step) {
        begin_derivatives(places);
        contacts.add_derivatives(places, gradient_, &hessian_, workers);
        if (translations_.imbalance(gradient_, inertia_, workers) < tolerance) return true;
        if (step == threshold::kMostBalancingSteps) return false;
        std::fill(direction_.begin(), direction_.end(), Float4{});
        for (std::size_t i = 0; i < masses_.size(); ++i) right_side_[i] = Float4(-gradient_[i]);
        translations_.correct(hessian_, right_side_, direction_, workers);
        std::uint32_t halvings = 0;
        search(places, energy, energy_at, halvings);
    }
}

/// Removes held particles from the system: their rows and columns become those of a multiple of the identity.
void ImplicitStep::hold(const Workers& workers) {
    workers.for_ranges(masses_.size(), kRowsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           const auto clear = [&](auto& rows, std::size_t row) {
                               for (std::uint32_t e = rows.first[row]; e < rows.first[row + 1]; ++e)
                                   if (is_held_[row] != 0 || is_held_[rows.columns[e]] != 0)
                                       rows.values[e] = {};
                           };
                           for (std::size_t row = begin; row < end; ++row) {
                               clear(hessian_.blocks, row);
                               clear(hessian_.multiples, row);
                               clear(hessian_.contacts, row);
                               if (is_held_[row] == 0) continue;
                               hessian_.blocks.values[hessian_.diagonal[row]].add_identity(
                                   static_cast<float>(inertia_[row]));
                               gradient_[row] = {};
                           }
                       });
}

void ImplicitStep::calm(Places start, std::span<Vec3d> guess, const Workers& workers) {
    // The common motion of each body is kept.
    const ScratchVector<Vec3d> common =
        common_displacements(start, guess, masses_, bodies(), is_held_, workers);
    for (std::size_t i = 0; i < guess.size(); ++i) trial_[i] = start[i] + common[bodies()[i]];
    const double most = energy(trial_, nullptr, workers);
    for (std::uint32_t halving = 0; halving < threshold::kMostHalvingsOfGuess; ++halving) {
        if (energy(guess, nullptr, workers) <= most) return;
        for (std::size_t i = 0; i < guess.size(); ++i) guess[i] = (trial_[i] + guess[i]) * 0.5;
    }
    std::copy(trial_.begin(), trial_.end(), guess.begin());
}

StepReport ImplicitStep::solve(std::span<Vec3d> places, const ContactEnergy* contacts,
                               const StepBudget& budget, const Workers& workers) {
    StepReport report;
    const auto energy_at = [&](Places at) { return this->energy(at, contacts, workers); };
    double energy = energy_at(places);
    while (report.newton_steps < budget.newton_steps) {
        add_derivatives(places, contacts, workers);
        multigrid_.set(hessian_, is_held_, workers);
        for (std::size_t i = 0; i < masses_.size(); ++i) right_side_[i] = Float4(-gradient_[i]);
        report.linear_iterations += linear_.solve(hessian_, multigrid_, right_side_, direction_,
                                                  budget.linear_iterations, budget.linear_tolerance, workers);
        translations_.correct(hessian_, right_side_, direction_, workers);
        ++report.newton_steps;
        const double share = search(places, energy, energy_at, report.halvings);
        // The Hessian of the energy is nowhere smaller than that of inertia.
        report.last_move = share * std::sqrt(std::max(-slope(), 0.0) / total_inertia_);
        if (report.last_move < budget.tolerance) break;
    }
    return report;
}

/// The derivative of the energy along the direction.
double ImplicitStep::slope() const {
    double slope = 0;
    for (std::size_t i = 0; i < masses_.size(); ++i) slope += dot(gradient_[i], direction_[i].to_double());
    return slope;
}

template <typename EnergyAt>
double ImplicitStep::search(std::span<Vec3d> places, double& energy, const EnergyAt& energy_at,
                            std::uint32_t& halvings) {
    const double slope = this->slope();
    double share = 1, found = 0;
    for (std::uint32_t trial = 0;; ++trial) {
        for (std::size_t i = 0; i < masses_.size(); ++i)
            trial_[i] = places[i] + direction_[i].to_double() * share;
        found = energy_at(trial_);
        const bool is_rounding = std::abs(found - energy) < threshold::kEnergyRounding * std::abs(energy);
        if (found <= energy + threshold::kSufficientDecrease * share * slope || is_rounding ||
            trial == threshold::kMostShorterTrials)
            break;
        // The minimum of the parabola through both energies with the slope at the start, within bounds.
        const double least = -slope * share * share / (2 * (found - energy - slope * share));
        share = std::min(share / 2, std::max(share / 10, least));
        ++halvings;
    }
    energy = found;
    std::copy(trial_.begin(), trial_.end(), places.begin());
    return share;
}

void advance(Motion& motion, Places places, std::span<const std::uint8_t> is_touching, double step) {
    for (std::size_t i = 0; i < motion.particle_count(); ++i) {
        const Vec3d before = motion.places[i], velocity_before = motion.velocities[i];
        const bool is_smooth = is_touching[i] == 0;
        motion.velocities[i] = is_smooth && motion.is_smooth[i] != 0
                                   ? (places[i] * 3 - before * 4 + motion.places_before[i]) * (0.5 / step)
                                   : (places[i] - before) * (1 / step);
        motion.places_before[i] = before;
        motion.velocities_before[i] = velocity_before;
        motion.places[i] = places[i];
        motion.is_smooth[i] = is_smooth ? 1 : 0;
    }
}

} // namespace echinus
