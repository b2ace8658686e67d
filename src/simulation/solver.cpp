#include "simulation/solver.hpp"

#include "simulation/jakobsen/jakobsen_solver.hpp"
#include "simulation/newton_solver.hpp"
#include "simulation/start/start_state.hpp"
#include "simulation/start/untangle.hpp"
#include "simulation/start/validation.hpp"
#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

namespace echinus {

namespace {

/// Half the spacing of the particles: with it a model cuts hardly any face of a cloth at rest, and the cloth
/// lies close (docs/thickness.md).
double default_thickness(const Deformable& deformable) {
    double sum = 0;
    std::size_t count = 0;
    for (const DistanceConstraint& constraint : deformable.constraints) {
        if (constraint.kind != ConstraintKind::Structural) continue;
        sum += double{constraint.rest_length};
        ++count;
    }
    if (count > 0) return sum / static_cast<double>(count) / 2;
    if (deformable.tetrahedra.empty()) return 0;
    return double{mean_edge_length(elements_of(deformable), deformable.positions)} / 2;
}

SimulationOptions with_thickness(SimulationOptions options, const Deformable& deformable) {
    if (!options.thickness) options.thickness = default_thickness(deformable);
    return options;
}

/// Rotations of unit length up to rounding in double keep their bits.
std::vector<Collider> with_unit_rotations(std::vector<Collider> colliders) {
    constexpr double kUnitRounding = 1e-12;
    for (Collider& collider : colliders) {
        Rotation& r = collider.pose.rotation;
        if (std::abs(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z - 1) > kUnitRounding) r = r.normalised();
    }
    return colliders;
}

/// The deformable in its initial state.
/// @throws Error InvalidOptions
Deformable valid_start(Deformable deformable, const std::vector<Collider>& colliders,
                       const SimulationOptions& options) {
    require_valid(options);
    require_valid(deformable);
    require_solver(deformable, options);
    require_valid(colliders, options);
    require_valid_attachments(deformable, colliders.size());
    require_valid_filters(deformable, colliders.size());
    require_valid_handles(deformable);
    deformable.velocities.resize(deformable.particle_count());
    // So that later reads always find rest positions, and untangling does not change the rest shape.
    if (deformable.rest_positions.empty()) deformable.rest_positions = deformable.positions;
    if (options.surfaces_collide() && options.newton().untangle)
        untangle(deformable, with_unit_rotations(colliders), with_thickness(options, deformable));
    return deformable;
}

} // namespace

Solver::Solver(Deformable deformable_in, std::vector<Collider> colliders_in,
               const SimulationOptions& options_in)
    : deformable(valid_start(std::move(deformable_in), colliders_in, options_in)),
      colliders(with_unit_rotations(std::move(colliders_in))), motions(colliders.size()),
      options(with_thickness(options_in, deformable)), largest_speed(std::numeric_limits<double>::infinity()),
      workers_(options.thread_count), attachments_(deformable, colliders), handles_(deformable),
      deforming_(colliders.size()), rest_(options.rest, deformable.positions), bounds_(options, deformable),
      loads_(colliders.size()), start_hash_(hash_of(deformable.positions)) {
    for (const Collider& collider : colliders) start_poses_.push_back(collider.pose);
    if (options.surfaces_collide()) require_apart(deformable, colliders, options);
}

std::unique_ptr<Solver> make_solver(Deformable deformable, std::vector<Collider> colliders,
                                    const SimulationOptions& options) {
    if (options.kind() == SolverKind::Jakobsen)
        return std::make_unique<JakobsenSolver>(std::move(deformable), std::move(colliders), options);
    return std::make_unique<NewtonSolver>(std::move(deformable), std::move(colliders), options);
}

void Solver::build_maps() {
    try {
        for (std::optional<DeformingCollider>& collider : deforming_)
            if (collider) collider->build_ahead((frame + 1.0) * options.time_step);
    } catch (const Error& error) {
        throw Error(error.code(), "in frame " + std::to_string(frame + 1) + ": " + error.what());
    }
}

/// Errors are ignored here: the next frame builds the map again and reports them.
void Solver::prepare_next_frame() {
    if (std::none_of(deforming_.begin(), deforming_.end(), [](const auto& collider) { return !!collider; }))
        return;
    workers_.offer([this, end_time = (frame + 2.0) * options.time_step] {
        for (std::optional<DeformingCollider>& collider : deforming_) {
            try {
                if (collider) collider->build_ahead(end_time);
            } catch (...) {
                continue;
            }
        }
    });
}

void Solver::move_colliders_on() {
    handles_.begin_frame(frame * options.time_step,
                         [&](std::uint32_t particle) { set_held(particle, false); });
    for (std::size_t c = 0; c < colliders.size(); ++c) loads_[c] = load_on(c);
    motions.begin_frame(colliders, (frame + 1.0) * options.time_step, options.time_step, loads_,
                        options.gravity);
    for (std::size_t i = 0; i < colliders.size(); ++i)
        if (!Bounds::contain_way(colliders[i], options.time_step))
            bounds_.diverge(frame, name_of_collider(i) + " left all bounds; try a smaller velocity");
}

void Solver::set_free(std::size_t collider, double mass) {
    const std::string name = name_of_collider(collider);
    require_option(options.kind() == SolverKind::Newton,
                   name + " cannot be free under the jakobsen solver, which measures no loads; use newton");
    const ExactMap* const map = map_of_surface(colliders[collider]);
    require_option(map != nullptr,
                   name + " has no exact map, which determines its centre of mass and inertia");
    require_option(map->view().border.empty(),
                   name + " has an open mesh, so it has no centre of mass; a free collider has to be closed");
    motions.set_free(collider, RigidBody(model_mesh(map->view(), colliders[collider].scale), mass,
                                         colliders[collider], name));
}

/// From now on the collider's surface counts as deforming, unless lead() throws.
template <typename Lead>
void Solver::lead_surface(std::size_t collider, const Lead& lead) {
    std::optional<DeformingCollider>& surface = deforming_[collider];
    if (surface) return lead(*surface);
    const std::string name = name_of_collider(collider);
    const auto* exact = std::get_if<ExactMap>(&colliders[collider].map.kind);
    if (options.kind() == SolverKind::Jakobsen)
        throw Error(ErrorCode::InvalidOptions,
                    name + " cannot deform under the jakobsen solver; use another solver for this scene");
    if (exact == nullptr || !options.surfaces_collide())
        throw Error(ErrorCode::InvalidOptions,
                    name + (exact == nullptr ? " has no exact map, which a model that deforms needs"
                                             : " cannot deform where only particles collide, since moving "
                                               "faces may pass particles; let surfaces collide"));
    surface.emplace(*exact, name);
    try {
        lead(*surface);
    } catch (...) {
        surface.reset();
        throw;
    }
    attachments_.hold_on_to_surface(collider, colliders[collider], *surface);
}

void Solver::lead_vertices(std::size_t collider, std::span<const Vec3f> vertices_local) {
    lead_surface(collider, [&](DeformingCollider& surface) { surface.lead_to(vertices_local); });
}

void Solver::follow_cache(std::size_t collider, VertexCache cache) {
    lead_surface(collider, [&](DeformingCollider& surface) { surface.follow(std::move(cache)); });
}

bool Solver::all_arrived() const {
    const double time = frame * options.time_step;
    return motions.all_arrived(time, options.rest.speed) && handles_.all_done(time) && teleports_.empty() &&
           std::all_of(deforming_.begin(), deforming_.end(),
                       [&](const auto& collider) { return !collider || collider->has_arrived(time); });
}

std::string Solver::name_of_collider(std::size_t collider) const {
    return name_of(colliders[collider], collider);
}

Residual Solver::residual() const {
    double sum = 0, largest = 0;
    std::size_t count = 0;
    for (const DistanceConstraint& constraint : deformable.constraints) {
        if (constraint.kind != ConstraintKind::Structural || !(constraint.rest_length > 0)) continue;
        const Vec3d across =
            Vec3d(deformable.positions[constraint.b]) - Vec3d(deformable.positions[constraint.a]);
        const double share = std::abs(length(across) / double{constraint.rest_length} - 1);
        sum += share * share;
        largest = std::max(largest, share);
        ++count;
    }
    return count > 0 ? Residual{std::sqrt(sum / static_cast<double>(count)), largest} : Residual{};
}

} // namespace echinus
