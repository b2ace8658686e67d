#include "simulation/newton_solver.hpp"

#include "mechanics/thresholds.hpp"
#include "simulation/contact/carry_field.hpp"
#include "simulation/contact/thresholds.hpp"
#include "simulation/stopwatch.hpp"
#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

double mean_edge_of(const Deformable& deformable) {
    return double{mean_edge_length(elements_of(deformable), deformable.positions)};
}

/// The options with a thickness that is large enough for contacts to push.
SimulationOptions contact_options(SimulationOptions options, double mean_edge) {
    const double least = std::max(threshold::kLeastThickness * mean_edge, threshold::kLeastThicknessOfAll);
    options.thickness = std::max(*options.thickness, least);
    std::optional<double>& own = options.newton().self_thickness;
    if (own) own = std::max(*own, least);
    return options;
}

/// The vertices of a collider's present surface, in its body frame.
std::vector<Vec3f> vertices_of(const Collider& collider, const std::optional<DeformingCollider>& surface) {
    if (!surface) return model_mesh(map_of_surface(collider)->view(), collider.scale).vertices;
    std::vector<Vec3f> vertices = surface->vertices();
    for (Vec3f& v : vertices) v = Vec3f(times(Vec3d(v), collider.scale));
    return vertices;
}

} // namespace

NewtonSolver::NewtonSolver(Deformable deformable_in, std::vector<Collider> colliders_in,
                           const SimulationOptions& options_in)
    : Solver(std::move(deformable_in), std::move(colliders_in), options_in),
      step_(elastic_parts(deformable, options)), motion_(deformable.particle_count()),
      is_held_(deformable.particle_count()), accelerations_(deformable.particle_count(), options.gravity),
      gained_(deformable.particle_count()), deformations_(colliders.size()), is_near_(colliders.size()),
      may_touch_(deformable.particle_count()), held_by_(deformable.particle_count(), kNoObstacle),
      meets_some_(colliders.size(), 1), mean_edge_(mean_edge_of(deformable)),
      thickness_(*contact_options(options, mean_edge_).thickness) {
    for (std::size_t i = 0; i < deformable.particle_count(); ++i) {
        motion_.places[i] = Vec3d(deformable.positions[i]);
        motion_.velocities[i] = Vec3d(deformable.velocities[i]);
        is_held_[i] = deformable.inverse_masses[i] == 0 ? 1 : 0;
    }
    for (const Handle& handle : deformable.handles)
        for (const std::uint32_t particle : handle.particles) is_held_[particle] = 1;
    for (std::size_t i = 0; i < is_held_.size(); ++i)
        if (is_held_[i] != 0) motion_.velocities[i] = {};
    led_.load(deformable.positions);
    for (const Attachment& attachment : deformable.attachments)
        held_by_[attachment.particle] = attachment.collider;
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        const std::vector<std::uint8_t> passes = let_through(deformable, c);
        const bool all_pass =
            std::all_of(passes.begin(), passes.end(), [](std::uint8_t p) { return p != 0; });
        if (!passes.empty() && all_pass) meets_some_[c] = 0;
    }
    if (options.surfaces_collide() || !colliders.empty())
        contacts_.emplace(deformable, colliders, step_.masses(), strengths(), step_.bodies(),
                          contact_options(options, mean_edge_));
}

/// [particle] the force that strains the material around it by 1.
std::vector<double> NewtonSolver::strengths() {
    std::vector<double> strengths = step_.stiffnesses(motion_.places, workers_);
    for (double& strength : strengths)
        strength = std::max(strength * mean_edge_, std::numeric_limits<double>::min());
    return strengths;
}

bool NewtonSolver::holds(std::size_t collider) const {
    return std::any_of(deformable.attachments.begin(), deformable.attachments.end(),
                       [&](const Attachment& attachment) { return attachment.collider == collider; });
}

/// Free colliders are unknowns of the steps, except those that hold particles: these move by the load of the
/// frame before.
void NewtonSolver::find_free_bodies() {
    if (!contacts_) return;
    const std::span<const FreeBody> known = contacts_->free_bodies();
    std::size_t count = 0;
    bool is_known = true;
    for (std::uint32_t c = 0; c < colliders.size(); ++c) {
        const RigidBody* const body = motions.body_of(c);
        motions.leave_to_step(c, body != nullptr && !holds(c));
        if (!motions.is_unknown(c)) continue;
        is_known = is_known && count < known.size() && known[count].is_of(c, *body);
        ++count;
    }
    if (is_known && count == known.size()) return;
    std::vector<FreeBody> bodies;
    ElasticParts parts = elastic_parts(deformable, options);
    for (std::uint32_t c = 0; c < colliders.size(); ++c) {
        if (!motions.is_unknown(c)) continue;
        bodies.emplace_back(c, static_cast<std::uint32_t>(parts.masses.size()), *motions.body_of(c));
        bodies.back().add_to(parts, options.time_step);
    }
    step_ = ImplicitStep(parts);
    is_held_.resize(parts.masses.size(), 0);
    contacts_->set_free_bodies(std::move(bodies), step_.masses(), step_.bodies());
}

/// A body that is an unknown does not move before the step.
RigidTransform NewtonSolver::pose_without_contact(std::size_t collider, double seconds) const {
    return motions.is_unknown(collider) ? colliders[collider].pose : pose_after(colliders[collider], seconds);
}

/// Guesses the pose from inertia and the share of gravity that acted in the last step.
RigidTransform NewtonSolver::guess(const FreeBody& body, double seconds) {
    const RigidBody& rigid = *motions.body_of(body.collider());
    return rigid.after(colliders[body.collider()].pose, options.gravity * rigid.left_of(options.gravity),
                       seconds);
}

/// Moves the collider to the pose that contacts permitted its body, and gives the body the momentum of that.
void NewtonSolver::end_step_of(const FreeBody& body, double seconds) {
    RigidBody& rigid = *motions.body_of(body.collider());
    Collider& collider = colliders[body.collider()];
    const RigidTransform led = rigid.after(collider.pose, options.gravity, seconds);
    collider.pose = body.safe_pose;
    rigid.push(collider.pose, body.load(led, seconds), options.gravity, seconds);
    rigid.give_velocities(collider);
}

void NewtonSolver::step() {
    const Workers::Session session(workers_);
    bounds_.require_sound();
    find_free_bodies();
    const std::uint64_t truncated_before = profile.truncated_count;
    {
        const Stopwatch stopwatch(profile.collision_seconds);
        build_maps();
    }
    move_colliders_on();
    deform();
    prepare_next_frame();
    if (contacts_) contacts_->begin_frame();
    float share = 1 / static_cast<float>(part_count());
    for (FramePart part{0, 0}; part.begin < 1;) {
        require_ways();
        part.end = part.begin + share < 1 - share / 2 ? part.begin + share : 1;
        if (step_part(part))
            part.begin = part.end;
        else
            share /= 2;
    }
    std::fill(deformations_.begin(), deformations_.end(), Deformation{});
    if (contacts_) {
        contacts_->end_frame();
        profile.unresolved_count += contacts_->unresolved_count();
        profile.map_query_count += contacts_->particles().take_query_count();
        profile.lost_count += contacts_->particles().take_lost_count();
    }
    accelerations_.assign(deformable.particle_count(), options.gravity);
    publish();
    ++frame;
    rest_.watch(deformable.positions, largest_speed, profile.truncated_count > truncated_before);
}

/// Requires that no particle would leave all bounds in the frame if nothing stopped it.
void NewtonSolver::require_ways() {
    ScratchVector<Vec3d> ends(motion_.places.begin(), motion_.places.end(), workers_.scratch());
    for (std::size_t i = 0; i < ends.size(); ++i)
        ends[i] += (motion_.velocities[i] + accelerations_[i] * options.time_step) * options.time_step;
    bounds_.require_ways(ends, frame);
}

/// Gives deforming colliders the maps of the frame's end.
void NewtonSolver::deform() {
    const Stopwatch stopwatch(profile.collision_seconds);
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        deformations_[c] = {};
        if (!deforming_[c]) continue;
        const Collider before = colliders[c];
        deforming_[c]->begin_frame(colliders[c]);
        find_now();
        const double room = threshold::kDecidingRoom * fastest() * options.time_step;
        deformations_[c] = {
            before,  *deforming_[c], now_, motion_.particle_count(), room, threshold::kTouch * thickness_,
            workers_};
    }
}

/// The number of parts of a frame, such that loads follow whatever yields to colliders, and impacts are
/// solved where they happen.
std::uint32_t NewtonSolver::part_count() {
    if (!options.surfaces_collide()) return 1;
    find_now();
    colliders_before_ = colliders;
    for (std::size_t c = 0; c < colliders.size(); ++c)
        colliders[c].pose = pose_without_contact(c, options.time_step);
    find_near_colliders();
    const double carried = most_carried();
    colliders = colliders_before_;
    for (FreeBody& body : free_bodies()) body.goal_pose = guess(body, options.time_step);
    const double overlap = contacts_->overlap_ahead(colliders, now_, guess(motion_.places, options.time_step),
                                                    may_touch_, workers_);
    const double parts = std::ceil(std::max(carried / (threshold::kMostCarried * thickness_),
                                            overlap / (threshold::kMostOverlap * mean_edge_)));
    return static_cast<std::uint32_t>(std::clamp(parts, 1.0, double{threshold::kMostPartsOfFrame}));
}

/// Requires that colliders are in their poses at the end of the frame.
void NewtonSolver::find_near_colliders() {
    const double room = threshold::kDecidingRoom * fastest() * options.time_step;
    const auto may_carry = [&](std::size_t c) {
        return meets_some_[c] != 0 &&
               CarryField::may_carry(colliders_before_[c], colliders[c], now_, motion_.particle_count(), room,
                                     threshold::kTouch * thickness_);
    };
    for (std::size_t c = 0; c < colliders.size(); ++c) is_near_[c] = holds(c) || may_carry(c) ? 1 : 0;
}

/// The largest distance by which colliders carry a particle in the frame beyond its own motion. Requires that
/// colliders are in their poses at the end of the frame.
double NewtonSolver::most_carried() {
    const CarryField field(colliders_before_, colliders, is_near_, deformations_, {},
                           threshold::kTouch * thickness_);
    if (field.is_zero()) return 0;
    start_ = now_;
    const ScratchVector<Vec3d> own = own_displacements(options.time_step);
    field.carry(start_, std::span(is_held_).first(own.size()), own, workers_);
    double most = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const Vec3d displacement = Vec3d(start_[i]) - Vec3d(now_[i]);
        most = std::max(most, std::min(length(displacement), length(displacement - own[i])));
    }
    return most;
}

/// The displacements by the particles' present velocities.
ScratchVector<Vec3d> NewtonSolver::own_displacements(double seconds) const {
    ScratchVector<Vec3d> own(motion_.velocities.begin(), motion_.velocities.end(), workers_.scratch());
    for (Vec3d& displacement : own) displacement *= seconds;
    return own;
}

/// The vertices of a deforming collider cannot be moved back.
bool NewtonSolver::can_be_halved(float share) const {
    return options.surfaces_collide() && share > threshold::kLeastPartToMove &&
           std::none_of(deformations_.begin(), deformations_.end(),
                        [](const Deformation& deformation) { return deformation.motion != nullptr; });
}

/// @return whether moving colliders could carry nearby particles this far, and anything could move. If not,
/// nothing has changed, and a smaller part has to be tried; the smallest is always accepted
bool NewtonSolver::step_part(const FramePart& part) {
    const float share = part.end - part.begin;
    const double seconds = options.time_step * double{share};
    const std::size_t unresolved_count = contacts_ ? contacts_->unresolved_count() : 0;
    colliders_before_ = colliders;
    for (std::size_t c = 0; c < colliders.size(); ++c) colliders[c].pose = pose_without_contact(c, seconds);
    if (!find_start(part, share <= threshold::kLeastPartOfFrame)) {
        colliders = colliders_before_;
        return false;
    }
    if (contacts_) contacts_->particles().begin_step(colliders_before_, colliders, motion_.places, is_held_);
    ScratchVector<Vec3d> from = exact_start();
    ScratchVector<Vec3d> places = guess(from, seconds), led = from;
    for (ScratchVector<Vec3d>* const all : {&from, &places, &led}) all->resize(step_.masses().size());
    for (FreeBody& body : free_bodies()) {
        body.safe_pose = colliders[body.collider()].pose;
        body.put(body.safe_pose, from);
        body.put(guess(body, seconds), places);
        body.put(motions.body_of(body.collider())->after(body.safe_pose, options.gravity, seconds), led);
    }
    choose_orders(share < 1);
    const auto count = motion_.particle_count();
    step_.begin(motion_, accelerations_, is_held_, seconds, options.newton().air_drag,
                {Places(from).subspan(count), Places(led).subspan(count)});
    step_.calm(from, places, workers_);
    if (!minimise(places, seconds, !can_be_halved(share))) {
        contacts_->cancel_step(unresolved_count);
        colliders = colliders_before_;
        return false;
    }
    std::swap(led_, led_to_);
    const ScratchVector<Vec3d> velocities_before(motion_.velocities.begin(), motion_.velocities.end(),
                                                 workers_.scratch());
    const ScratchVector<std::uint8_t> nothing_touches(contacts_ ? 0 : places.size(), workers_.scratch());
    advance(motion_, places, contacts_ ? contacts_->touching() : std::span(nothing_touches), seconds);
    for (const FreeBody& body : free_bodies()) end_step_of(body, seconds);
    if (contacts_) contacts_->particles().end_step(colliders, motion_.places, motion_.velocities, seconds);
    for (std::size_t i = 0; i < count; ++i) {
        gained_[i] = (motion_.velocities[i] - velocities_before[i]) * (1 / seconds);
        // The motion of a held particle is prescribed.
        if (is_held_[i] != 0) motion_.is_smooth[i] = 0;
    }
    return true;
}

/// If a body touches something or may do so, its steps are of first order, since an impact is not smooth. So
/// are steps whose length differs from that of the step before.
void NewtonSolver::choose_orders(bool is_part) {
    if (is_part || was_part_) std::fill(motion_.is_smooth.begin(), motion_.is_smooth.end(), std::uint8_t{0});
    was_part_ = is_part ? 1 : 0;
    ScratchVector<std::uint8_t> is_rough(may_touch_.begin(), may_touch_.end(), workers_.scratch());
    for (std::size_t i = 0; i < is_rough.size(); ++i)
        if (motion_.is_smooth[i] == 0 && is_held_[i] == 0) is_rough[i] = 1;
    step_.spread(is_rough);
    for (std::size_t i = 0; i < is_rough.size(); ++i)
        if (is_rough[i] != 0) motion_.is_smooth[i] = 0;
}

void NewtonSolver::find_now() {
    now_.resize(motion_.particle_count());
    for (std::size_t i = 0; i < motion_.particle_count(); ++i) now_.set(i, Vec3f(motion_.places[i]));
}

/// Finds the start of the step, to which colliders carry particles along.
/// @param is_least  carries particles even if some pairs then meet
/// @return whether colliders can carry them this far
bool NewtonSolver::find_start(const FramePart& part, bool is_least) {
    find_now();
    start_ = now_;
    led_to_ = led_;
    attachments_.follow(colliders, deforming_, part.end, led_to_);
    handles_.follow(time_of(part.begin), time_of(part.end), led_to_);
    for (std::size_t i = 0; i < motion_.particle_count(); ++i)
        if (is_held_[i] != 0) start_.set(i, led_to_[i]);
    const bool is_any_led = start_ != now_;
    if (!contacts_ || !options.surfaces_collide()) return true;
    const Stopwatch stopwatch(profile.collision_seconds);
    const CarryField field(colliders_before_, colliders, is_near_, deformations_, part,
                           threshold::kTouch * thickness_);
    if (field.is_zero() && !is_any_led) return true;
    field.carry(start_, std::span(is_held_).first(motion_.particle_count()),
                own_displacements(options.time_step * double{part.end - part.begin}), workers_);
    return contacts_->carry(colliders_before_, colliders, deformations_, part, now_, start_, is_held_,
                            is_least, workers_);
}

/// Particles that nothing carries keep double precision.
ScratchVector<Vec3d> NewtonSolver::exact_start() const {
    ScratchVector<Vec3d> places(motion_.places.begin(), motion_.places.end(), workers_.scratch());
    for (std::size_t i = 0; i < places.size(); ++i)
        if (start_[i] != Vec3f(places[i])) places[i] = Vec3d(start_[i]);
    return places;
}

/// Guesses positions from inertia and the share of gravity that acted in the last step. @param start  the
/// positions after carrying
ScratchVector<Vec3d> NewtonSolver::guess(std::span<const Vec3d> start, double seconds) const {
    ScratchVector<Vec3d> places(start.begin(), start.end(), workers_.scratch());
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (is_held_[i] != 0) continue;
        const Vec3d pull = accelerations_[i];
        const double pull_sq = dot(pull, pull);
        const double share = pull_sq > 0 ? std::clamp(dot(gained_[i], pull) / pull_sq, 0.0, 1.0) : 0;
        // A carried particle already has the motion of its collider.
        const Vec3d carried = start[i] - motion_.places[i], own = motion_.velocities[i] * seconds;
        places[i] += own - carried + pull * (share * seconds * seconds);
    }
    return places;
}

/// @param may_stop  whether a step is accepted in which nothing can move
/// @return whether the step is accepted
bool NewtonSolver::minimise(std::span<Vec3d> places, double seconds, bool may_stop) {
    const std::uint32_t steps_in_contact = options.newton().step_count;
    const std::uint32_t steps_without = threshold::kStepsWithoutContact * steps_in_contact;
    StepBudget budget;
    budget.tolerance = options.newton().tolerance * mean_edge_;
    if (!contacts_) {
        const Stopwatch stopwatch(profile.constraint_seconds);
        budget.newton_steps = steps_without;
        step_.solve(places, nullptr, budget, workers_);
        return true;
    }
    const auto contact = [&](const auto& work) {
        const Stopwatch stopwatch(profile.collision_seconds);
        work();
    };
    const auto energy = [&](Places at) { return step_.energy(at, &contacts_->energy(), workers_); };
    contact([&] { contacts_->begin_step(colliders, start_, places, is_held_, seconds, workers_); });
    budget.newton_steps = 1;
    std::size_t stopped = 0;
    for (std::uint32_t newton = 1;; ++newton) {
        double last_move = 0;
        bool is_balanced = false;
        {
            const Stopwatch stopwatch(profile.constraint_seconds);
            last_move = step_.solve(places, &contacts_->energy(), budget, workers_).last_move;
            is_balanced = step_.balance(places, contacts_->energy(),
                                        threshold::kBodyTolerance * budget.tolerance, workers_);
        }
        contact([&] { stopped = contacts_->advance(places, energy, workers_); });
        const bool has_converged = last_move < budget.tolerance && stopped == 0 && is_balanced;
        if (has_converged || newton >= (contacts_->has_contacts() ? steps_in_contact : steps_without)) break;
        contact([&] { contacts_->renew(); });
    }
    if (stopped > 0 && !may_stop && !contacts_->has_moved()) return false;
    profile.truncated_count += stopped;
    contact([&] {
        contacts_->put_outside(places, energy, workers_);
        contacts_->end_step(places);
        if (contacts_->stops() || !deformable.attachments.empty())
            contacts_->add_loads(places, step_.missing_forces(places, &contacts_->energy(), workers_),
                                 held_by_, workers_);
    });
    profile.contact_count += contacts_->pushing_count(places);
    profile.measured_pair_count += contacts_->pair_count();
    return true;
}

double NewtonSolver::fastest() const {
    double largest_sq = 0;
    for (std::size_t i = 0; i < motion_.particle_count(); ++i)
        if (is_held_[i] == 0)
            largest_sq = std::max(largest_sq, dot(motion_.velocities[i], motion_.velocities[i]));
    return std::sqrt(largest_sq);
}

void NewtonSolver::publish() {
    publish_places();
    largest_speed = fastest();
    now_.load(deformable.positions);
    bounds_.require_ends(now_, deformable.particle_count(), frame);
}

void NewtonSolver::publish_places() {
    for (std::size_t i = 0; i < motion_.particle_count(); ++i) {
        deformable.positions[i] = Vec3f(motion_.places[i]);
        deformable.velocities[i] = Vec3f(motion_.velocities[i]);
    }
}

void NewtonSolver::set_particle_velocity(std::size_t particle, const Vec3d& velocity) {
    if (is_held_[particle] != 0) return;
    motion_.velocities[particle] = velocity;
    motion_.is_smooth[particle] = 0;
    deformable.velocities[particle] = Vec3f(velocity);
}

void NewtonSolver::move_particles(const RigidTransform& motion) {
    const Rotation& turn = motion.rotation;
    for (std::vector<Vec3d>* places : {&motion_.places, &motion_.places_before})
        for (Vec3d& place : *places) place = motion.to_world(place);
    for (std::size_t i = 0; i < motion_.particle_count(); ++i)
        led_.set(i, Vec3f(motion.to_world(Vec3d(led_[i]))));
    for (std::vector<Vec3d>* vectors : {&motion_.velocities, &motion_.velocities_before, &gained_})
        for (Vec3d& vector : *vectors) vector = turn.apply(vector);
    if (contacts_) contacts_->turn_own(turn);
    publish_places();
}

/// The wind acts as an acceleration in the next frame: `rate` per second times the velocity of the air across
/// a face, relative to the face.
void NewtonSolver::blow(const Vec3d& wind, double rate) {
    const double most = 1 / options.time_step; // no more than the whole difference in a frame
    ScratchVector<Vec3d> sums(deformable.particle_count(), workers_.scratch());
    ScratchVector<std::uint32_t> counts(deformable.particle_count(), workers_.scratch());
    for (const Triangle& face : deformable.faces) {
        const auto& [a, b, c] = face;
        const Vec3d normal =
            cross(motion_.places[b] - motion_.places[a], motion_.places[c] - motion_.places[a]);
        const double normal_sq = dot(normal, normal);
        if (!(normal_sq > 0)) continue;
        const Vec3d velocity =
            (motion_.velocities[a] + motion_.velocities[b] + motion_.velocities[c]) * (1.0 / 3);
        const Vec3d across = normal * (dot(wind - velocity, normal) / normal_sq);
        for (const std::uint32_t corner : face) {
            sums[corner] += across;
            ++counts[corner];
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (counts[i] > 0) accelerations_[i] = options.gravity + sums[i] * (std::min(rate, most) / counts[i]);
}

Load NewtonSolver::load_on(std::size_t collider) const {
    return contacts_ ? contacts_->load_on(collider, options.time_step) : Load{};
}

void NewtonSolver::record_contacts(bool is_on) {
    if (contacts_) contacts_->record(is_on);
}

std::span<const ContactPoint> NewtonSolver::contact_points() const {
    return contacts_ ? contacts_->points() : std::span<const ContactPoint>();
}

void NewtonSolver::archive(StateArchive& state) {
    archive_counts(state);
    for (std::vector<Vec3d>* vectors : {&motion_.places, &motion_.velocities, &motion_.places_before,
                                        &motion_.velocities_before, &accelerations_, &gained_})
        state.array(*vectors);
    state.array(motion_.is_smooth);
    state.value(was_part_);
    state.points(led_);
    rest_.archive(state);
    archive_colliders(state);
    attachments_.archive(state, deforming_);
    if (contacts_) contacts_->archive(state);
    if (!state.reads()) return;
    for (std::size_t i = 0; i < motion_.particle_count(); ++i)
        state.require(is_finite(motion_.places[i]) && is_finite(motion_.velocities[i]));
    for (std::size_t c = 0; c < colliders.size(); ++c)
        if (options.surfaces_collide() && map_of_surface(colliders[c]) != nullptr)
            contacts_->place_obstacle(c, vertices_of(colliders[c], deforming_[c]));
    const double speed = largest_speed;
    publish();
    largest_speed = speed;
}

} // namespace echinus
