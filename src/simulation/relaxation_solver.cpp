#include "simulation/relaxation_solver.hpp"

#include "simulation/start_state.hpp"
#include "simulation/stopwatch.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

namespace echinus {

namespace {

/// XPBD's steps are small. Elsewhere gravity decides: is what it moves a particle by in a frame not many
/// times the last digit of a coordinate?
bool needs_remainders(std::span<const Vec3f> positions, const SimulationOptions& options) {
    constexpr double kManyDigits = 50; // gravity is right to 1 %
    if (options.solver == SolverKind::Xpbd) return true;
    float largest = 0;
    for (const Vec3f& p : positions)
        largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    const double digit = double{largest} * std::numeric_limits<float>::epsilon();
    const double fall = length(options.gravity) * options.time_step * options.time_step;
    return fall > 0 && fall < kManyDigits * digit;
}

/// Particles that are worth a piece of the integration.
constexpr std::size_t kParticlesPerPiece = 1 << 14;

/// x' = x + (1 - drag) (x - x_previous) + a dt^2 (Jakobsen 2001, section 2), of one coordinate. Plain arrays
/// that do not overlap and no branch, for the compiler's vectors.
/// @param mobility  1, or 0 of a particle that is pinned
void integrate_coordinate(float* __restrict positions, float* __restrict previous,
                          const float* __restrict mobility, std::size_t count, float keep, float fall) {
    for (std::size_t i = 0; i < count; ++i) {
        const float position = positions[i];
        const float way = (position - previous[i]) * keep * mobility[i];
        previous[i] = position;
        positions[i] = position + way + fall * mobility[i];
    }
}

/// The same, with compensated summation (Kahan 1965) of places and of velocities.
void integrate_compensated(float* __restrict positions, float* __restrict previous,
                           float* __restrict remainders, float* __restrict previous_remainders,
                           const float* __restrict mobility, std::size_t count, float keep, float fall) {
    for (std::size_t i = 0; i < count; ++i) {
        const float position = positions[i], remainder = remainders[i];
        const float step = (position - previous[i]) + (remainder - previous_remainders[i]);
        const float way = (step * keep + fall) * mobility[i] + remainder;
        const float next = position + way;
        previous[i] = position;
        previous_remainders[i] = remainder;
        remainders[i] = way - (next - position);
        positions[i] = next;
    }
}

} // namespace

RelaxationSolver::RelaxationSolver(Deformable deformable_in, std::vector<Collider> colliders_in,
                                   const SimulationOptions& options_in)
    : Solver(std::move(deformable_in), std::move(colliders_in), options_in),
      particles_(deformable, needs_remainders(deformable.positions, options)),
      sticks_(weighted_sticks(deformable, options)), folds_(weighted_folds(deformable, options)),
      tetrahedra_(weighted_tetrahedra(deformable, options)), surface_motions_(colliders.size()),
      clearances_(particles_.count()), collisions_(deformable, colliders, particles_, options),
      goals_give_way_(sticks_.gives_way()), part_(options),
      substep_seconds_(options.time_step / options.substep_count) {
    if (options.surface_collision) {
        surfaces_.emplace(deformable, colliders, particles_, options);
        if (options.solver == SolverKind::Verlet) stretched_part_.emplace(sticks_, particles_.count());
    }
    if (options.self_collision) {
        parts_.emplace(deformable, options);
        if (options.solver == SolverKind::Verlet) gentle_sticks_.emplace();
    }
    if (tetrahedra_.count() > 0) energy_limit_.emplace(tetrahedra_, particles_, deformable.inverse_masses);
    if (options.multilevel) coarse_sheets_.emplace(deformable);
    if (options.measure_loads) meter_.emplace(deformable, colliders.size());
}

void RelaxationSolver::step() {
    const Workers::Session session(workers_);
    bounds_.require_sound();
    {
        const Stopwatch stopwatch(profile.collision_seconds);
        build_maps();
    }
    begin_frame();
    const std::uint32_t part_count = begin_collisions();
    prepare_next_frame();
    if (part_count > 1) divide_frame(part_count);
    for (std::uint32_t part = 0; part < part_count; ++part) {
        begin_part(part_count > 1);
        step_part(part == 0);
    }
    if (part_count > 1) join_parts();
    publish();
    bounds_.require_ends(particles_, frame);
    ++frame;
    judge_frame();
}

/// @param is_first  of the frame, which drags once
void RelaxationSolver::step_part(bool is_first) {
    for (std::uint32_t substep = 0; substep < part_.substep_count; ++substep) {
        if (energy_limit_) energy_limit_->begin_substep(tetrahedra_, particles_);
        integrate(is_first && substep == 0 ? 1 - options.drag : 1);
        if (substep == 0) look_ahead();
        move_colliders(substep);
        begin_constraints();
        relax_coarse_sheets();
        for (std::uint32_t iteration = 0; iteration < options.iteration_count; ++iteration) {
            relax_constraints();
            relax_stretched_part();
            collide();
        }
        if (energy_limit_) energy_limit_->end_substep(particles_);
    }
    bounds_.require_ways(particles_, frame);
    keep_free();
}

void RelaxationSolver::begin_frame() {
    const Stopwatch stopwatch(profile.integration_seconds);
    particles_.frame_start = particles_.positions;
    // Velocities that callers set may be of any size.
    bounds_.require_ways(particles_, frame);
    move_colliders_on();
    if (meter_) meter_->begin_frame(colliders);
    begin_energy_limit();
    if (stretched_part_ && frame % StretchedPart::kFrames == 0)
        stretched_part_->find(sticks_, particles_.positions);
}

/// Which may repeat relaxations, so that multipliers are kept.
void RelaxationSolver::begin_energy_limit() {
    if (!energy_limit_) return;
    energy_limit_->begin_frame(particles_);
    tetrahedra_.begin_substep(); // none is left of a frame that kept them
    tetrahedra_.keeps_multipliers = options.iteration_count > 1 || energy_limit_->measures();
}

/// Velocities are ways in a substep, which is a shorter one now.
void RelaxationSolver::divide_frame(std::uint32_t part_count) {
    part_ = parts_->options_of_part(part_count);
    const double whole = std::exchange(substep_seconds_, part_.time_step / part_.substep_count);
    particles_.scale_velocities(substep_seconds_ / whole);
}

void RelaxationSolver::join_parts() {
    part_ = options;
    const double of_part = std::exchange(substep_seconds_, options.time_step / options.substep_count);
    particles_.scale_velocities(substep_seconds_ / of_part);
    if (meter_) meter_->scale(substep_seconds_ / of_part);
}

/// A frame that is not divided has begun already, but for the surfaces.
void RelaxationSolver::begin_part(bool is_divided) {
    const Stopwatch stopwatch(profile.collision_seconds);
    if (is_divided) {
        particles_.frame_start = particles_.positions;
        collisions_.begin_frame(colliders, surface_motions_, particles_, part_);
    }
    if (surfaces_)
        surfaces_->begin_frame(colliders, surface_motions_, collisions_, particles_, part_, workers_);
}

/// Colliders that deform get the maps of the frame's end.
void RelaxationSolver::deform() {
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        surface_motions_[c] = nullptr;
        if (!deforming_[c]) continue;
        collisions_.known_clearances(c, particles_, clearances_);
        deforming_[c]->begin_frame(colliders[c], particles_, clearances_, surfaces_->carry_reach(c),
                                   workers_);
        surface_motions_[c] = deforming_[c]->motion();
    }
}

/// @return into how many parts the frame is divided
std::uint32_t RelaxationSolver::begin_collisions() {
    const Stopwatch stopwatch(profile.collision_seconds);
    deform();
    collisions_.begin_frame(colliders, surface_motions_, particles_, options);
    const bool deforms = std::any_of(surface_motions_.begin(), surface_motions_.end(),
                                     [](const SurfaceMotion* motion) { return motion != nullptr; });
    // A surface that deforms goes its ways in a whole frame.
    return parts_ && !deforms ? parts_->count(colliders, collisions_, particles_) : 1;
}

void RelaxationSolver::look_ahead() {
    const Stopwatch stopwatch(profile.collision_seconds);
    if (surfaces_) surfaces_->look_ahead(colliders, particles_, workers_);
}

/// @param share_kept  of the velocity
void RelaxationSolver::integrate(double share_kept) {
    const Stopwatch stopwatch(profile.integration_seconds);
    const Vec3f fall(options.gravity * (substep_seconds_ * substep_seconds_));
    const auto keep = static_cast<float>(share_kept);
    PointArrays& now = particles_.positions;
    PointArrays& before = particles_.previous;
    PointArrays& lost = particles_.remainders;
    PointArrays& lost_before = particles_.previous_remainders;
    const float* mobility = particles_.mobility.data();
    const auto integrate_along = [&](std::vector<float> PointArrays::*axis, float fall_along) {
        float *const positions = (now.*axis).data(), *const previous = (before.*axis).data();
        const auto integrate_range = [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
            const std::size_t count = end - begin;
            if (particles_.keeps_remainders)
                integrate_compensated(positions + begin, previous + begin, (lost.*axis).data() + begin,
                                      (lost_before.*axis).data() + begin, mobility + begin, count, keep,
                                      fall_along);
            else
                integrate_coordinate(positions + begin, previous + begin, mobility + begin, count, keep,
                                     fall_along);
        };
        workers_.for_ranges(particles_.count(), kParticlesPerPiece, integrate_range);
    };
    integrate_along(&PointArrays::x, fall.x);
    integrate_along(&PointArrays::y, fall.y);
    integrate_along(&PointArrays::z, fall.z);
}

void RelaxationSolver::move_colliders(std::uint32_t substep) {
    const Stopwatch stopwatch(profile.collision_seconds);
    collisions_.begin_substep(colliders, substep_seconds_);
    const auto share = static_cast<float>(substep + 1) / static_cast<float>(part_.substep_count);
    attachments_.follow(colliders, deforming_, share, particles_.positions);
    if (surfaces_) surfaces_->begin_substep(colliders);
}

/// Multipliers begin at 0 in each substep (Macklin et al. 2016, algorithm 1).
void RelaxationSolver::begin_constraints() {
    const Stopwatch stopwatch(profile.constraint_seconds);
    if (goals_give_way_)
        std::copy(sticks_.rest_lengths.begin(), sticks_.rest_lengths.end(), sticks_.goal_lengths.begin());
    if (gentle_sticks_) gentle_sticks_->set_goals(sticks_, particles_.positions);
    folds_.restore_goals();
    tetrahedra_.begin_substep();
    damp(tetrahedra_, particles_, workers_);
}

void RelaxationSolver::relax_coarse_sheets() {
    if (!coarse_sheets_ || coarse_sheets_->empty()) return;
    const Stopwatch stopwatch(profile.constraint_seconds);
    if (meter_) meter_->note(particles_);
    coarse_sheets_->relax(particles_);
    if (meter_) meter_->charge_holder(particles_);
}

void RelaxationSolver::relax_constraints() {
    const Stopwatch stopwatch(profile.constraint_seconds);
    if (meter_) meter_->note(particles_);
    relax(folds_, particles_.positions, particles_.kept_remainders(), workers_);
    relax(sticks_, particles_.positions, particles_.kept_remainders(), workers_);
    relax_tetrahedra();
    if (meter_) meter_->charge_holder(particles_);
}

void RelaxationSolver::relax_tetrahedra() {
    if (energy_limit_) energy_limit_->note(tetrahedra_, particles_);
    do relax(tetrahedra_, particles_, workers_);
    while (energy_limit_ && energy_limit_->charge(tetrahedra_, particles_));
}

void RelaxationSolver::collide() {
    const Stopwatch stopwatch(profile.collision_seconds);
    LoadMeter* const meter = meter_ ? &*meter_ : nullptr;
    collisions_.relax(particles_, profile, meter, workers_);
    if (surfaces_) surfaces_->relax(particles_, profile, meter);
}

void RelaxationSolver::relax_stretched_part() {
    if (!stretched_part_ || stretched_part_->empty()) return;
    const Stopwatch stopwatch(profile.constraint_seconds);
    LoadMeter* const meter = meter_ ? &*meter_ : nullptr;
    surfaces_->relax_part(stretched_part_->particles(), particles_, profile, meter);
    if (meter != nullptr) meter->note(particles_);
    relax(sticks_, stretched_part_->sticks(), particles_.positions, particles_.kept_remainders());
    if (meter != nullptr) meter->charge_holder(particles_);
}

void RelaxationSolver::keep_free() {
    const Stopwatch stopwatch(profile.collision_seconds);
    for (const std::size_t collider : collisions_.meet_late(colliders, particles_))
        if (surfaces_) surfaces_->meet_late(collider, colliders[collider], particles_, workers_);
    LoadMeter* const meter = meter_ ? &*meter_ : nullptr;
    if (meter != nullptr) meter->note(particles_);
    if (!surfaces_) return collisions_.keep_free(particles_, profile, meter);
    const std::uint64_t squeezed_before = profile.squeezed_count, truncated_before = profile.truncated_count;
    surfaces_->end_frame(particles_, profile, meter, workers_);
    if (gentle_sticks_) gentle_sticks_->note(profile.truncated_count > truncated_before);
    collisions_.end_frame(particles_, profile.squeezed_count > squeezed_before, profile);
}

void RelaxationSolver::publish() {
    const Stopwatch stopwatch(profile.integration_seconds);
    particles_.positions.store(deformable.positions);
    particles_.previous.store(deformable.previous_positions);
    particles_.keep_remainders(needs_remainders(deformable.positions, options));
}

void RelaxationSolver::judge_frame() {
    const Stopwatch stopwatch(profile.integration_seconds);
    float largest_motion_sq = 0;
    for (std::size_t i = 0; i < deformable.particle_count(); ++i) {
        const Vec3f motion = deformable.positions[i] - deformable.previous_positions[i];
        largest_motion_sq = std::max(largest_motion_sq, dot(motion, motion));
    }
    largest_speed = std::sqrt(double{largest_motion_sq}) / substep_seconds_;
    rest_.watch(deformable.positions, largest_speed);
}

Load RelaxationSolver::load_on(std::size_t collider) const {
    return meter_ ? meter_->load_on(collider, options.time_step, substep_seconds_) : Load{};
}

/// The velocity is what the particle moved in the last substep.
void RelaxationSolver::set_particle_velocity(std::size_t particle, const Vec3d& velocity) {
    if (particles_.pinned(particle)) return;
    particles_.set_velocity(particle, velocity * substep_seconds_);
    deformable.previous_positions[particle] = particles_.previous[particle];
}

void RelaxationSolver::blow(const Vec3d& wind, double rate) {
    // No more than all of the difference, however long a frame is.
    const auto share = static_cast<float>(std::min(rate * options.time_step, 1.0));
    wind_.blow(deformable.faces, Vec3f(wind * substep_seconds_), share, particles_);
    particles_.previous.store(deformable.previous_positions);
}

} // namespace echinus
