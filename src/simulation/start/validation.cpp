#include "simulation/start/validation.hpp"

#include "collider/frame_change.hpp"
#include "files/text.hpp"
#include "mesh/local_frame.hpp"
#include "simulation/deformables/closed_pieces.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <variant>

namespace echinus {

namespace {

[[noreturn]] void fail(const std::string& sentence) {
    throw Error(ErrorCode::InvalidOptions, sentence);
}

double length(const Rotation& r) {
    return std::sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z);
}

std::string as_text(const Rotation& r) {
    return std::string("[") + number_text(r.w) + ", " + number_text(r.x) + ", " + number_text(r.y) + ", " +
           number_text(r.z) + "]";
}

} // namespace

void refuse_mesh(const std::string& sentence) {
    throw Error(ErrorCode::InvalidMesh, sentence);
}

void require_within(const char* name, double value, double least, double most) {
    if (value >= least && value <= most) return;
    fail(std::string(name) + " is " + number_text(value) + "; it must lie in [" + number_text(least) + ", " +
         number_text(most) + "]");
}

void require_within(const char* name, const std::optional<double>& value, double least, double most) {
    if (value) require_within(name, *value, least, most);
}

void require_within(const char* name, std::span<const double> values, double least, double most) {
    for (const double value : values) require_within(name, value, least, most);
}

void require_default(const char* name, bool is_default, const char* solver) {
    if (!is_default)
        fail(std::string("simulation option ") + name + " is set, and only the " + solver +
             " solver has it; leave it out, or choose that solver");
}

void require_option(bool condition, const std::string& sentence) {
    if (!condition) fail(sentence);
}

void require_valid(const RigidTransform& pose, const std::string& owner) {
    if (!is_finite(Vec3f(pose.translation)))
        fail(owner + " has a translation that is not finite, or too large for a float");
    // More than rounding a unit quaternion to floats changes its length. Written so that it is false for NaN.
    constexpr double kTolerance = 1e-4;
    const double size = length(pose.rotation);
    if (!(size >= 1 - kTolerance && size <= 1 + kTolerance))
        fail(owner + " has the rotation " + as_text(pose.rotation) + ", a quaternion of length " +
             number_text(size) + "; it must be 1: cos(a / 2) and the unit axis times sin(a / 2) turn by a");
}

void require_valid(const SimulationOptions& options) {
    require_ranges(options);
    if (!is_finite(options.gravity)) fail("simulation option gravity is not finite");
    if (!is_finite(options.wind)) fail("simulation option wind is not finite");
    if (options.wind != Vec3d{} && options.wind_rate == 0)
        fail("simulation option wind_rate is 0, so the wind has no effect; set the rate, per "
             "second, at which the cloth takes on its velocity");
    const auto* newton = std::get_if<NewtonOptions>(&options.solver);
    if (newton != nullptr && newton->collision > CollisionMode::SurfacesAndSelf)
        fail("simulation option collision is none of the modes");
    if (newton != nullptr && newton->untangle && !options.surfaces_collide())
        fail("simulation option untangle needs the collision of surfaces, which requires an initial state "
             "without intersections; set collision to surfaces or surfaces_and_self");
}

namespace {

/// The same bound as for models: distances, areas and volumes of points within it are still floats.
bool is_within_reach(const Vec3f& position) {
    constexpr float kFarthest = 1e15F;
    return std::max({std::fabs(position.x), std::fabs(position.y), std::fabs(position.z)}) <= kFarthest;
}

void require_valid(const ElasticTetrahedron& tetrahedron, std::size_t particle_count,
                   const std::string& name) {
    std::array corners = tetrahedron.particles;
    std::sort(corners.begin(), corners.end());
    if (corners.back() >= particle_count ||
        std::adjacent_find(corners.begin(), corners.end()) != corners.end())
        fail(name + " needs four different particles of " + std::to_string(particle_count));
    const auto is_in = [](float value, float least) { return value >= least && std::isfinite(value); };
    const auto& [at_b, at_c, at_d] = tetrahedron.gradients;
    const double determinant = dot(Vec3d(at_b), cross(Vec3d(at_c), Vec3d(at_d)));
    if (!std::isfinite(determinant) || determinant == 0 || !(tetrahedron.volume > 0) ||
        !(tetrahedron.mu > 0) || !is_in(tetrahedron.volume, 0) || !is_in(tetrahedron.mu, 0) ||
        !is_in(tetrahedron.lambda, 0) || !is_in(tetrahedron.damping, 0))
        fail(name +
             " has a rest shape, a stiffness or a damping out of range; make_soft_body() computes them");
}

} // namespace

void require_valid(const Deformable& deformable) {
    const std::size_t count = deformable.particle_count();
    if (count == 0) fail("the deformable has no particles");
    const bool is_at_rest = deformable.velocities.empty();
    if ((!is_at_rest && deformable.velocities.size() != count) || deformable.inverse_masses.size() != count)
        fail("the deformable has " + std::to_string(count) + " positions, " +
             std::to_string(deformable.velocities.size()) + " velocities and " +
             std::to_string(deformable.inverse_masses.size()) +
             " inverse masses; it needs the same number of each, or no velocities");
    for (std::size_t i = 0; i < count; ++i) {
        const float inverse_mass = deformable.inverse_masses[i];
        if (!is_finite(deformable.positions[i]) || (!is_at_rest && !is_finite(deformable.velocities[i])) ||
            !(inverse_mass >= 0) || !std::isfinite(inverse_mass))
            fail("particle " + std::to_string(i) +
                 " has a position or a velocity that is not finite or an inverse mass that is negative or "
                 "not finite");
        if (!is_within_reach(deformable.positions[i]))
            fail("particle " + std::to_string(i) + " begins farther than 1e15 from the origin along an axis");
    }
    const std::vector<Vec3f>& rest = deformable.rest_positions;
    if (!rest.empty() && rest.size() != count)
        fail("the deformable has " + std::to_string(count) + " positions and " + std::to_string(rest.size()) +
             " rest positions; it needs the same number, or none if it begins at rest");
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (!is_finite(rest[i]) || !is_within_reach(rest[i]))
            fail("particle " + std::to_string(i) +
                 " has a rest position that is not finite, or farther than 1e15 from the origin along an "
                 "axis");
    for (std::size_t i = 0; i < deformable.constraints.size(); ++i) {
        const DistanceConstraint& constraint = deformable.constraints[i];
        if (constraint.a >= count || constraint.b >= count || constraint.a == constraint.b)
            fail("constraint " + std::to_string(i) + " joins particles " + std::to_string(constraint.a) +
                 " and " + std::to_string(constraint.b) + "; it needs two different ones of " +
                 std::to_string(count));
        if (!(constraint.rest_length >= 0) || !std::isfinite(constraint.rest_length) ||
            static_cast<std::size_t>(constraint.kind) >= kConstraintKindCount)
            fail("constraint " + std::to_string(i) + " has a rest length or a kind out of range");
    }
    for (std::size_t i = 0; i < deformable.tetrahedra.size(); ++i)
        require_valid(deformable.tetrahedra[i], count, "tetrahedron " + std::to_string(i));
    for (std::size_t i = 0; i < deformable.faces.size(); ++i)
        for (const std::uint32_t particle : deformable.faces[i])
            if (particle >= count)
                fail("face " + std::to_string(i) + " refers to particle " + std::to_string(particle) +
                     "; the last one is " + std::to_string(count - 1));
}

namespace {

/// Positions are floats. Does gravity move a particle so little in a frame that rounding dominates?
bool rounding_decides(const Deformable& deformable, const SimulationOptions& options) {
    constexpr double kFewDigits = 5; // rounding changes gravity by a tenth
    float largest = 0;
    for (const Vec3f& p : deformable.positions)
        largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    const double digit = double{largest} * std::numeric_limits<float>::epsilon();
    const double fall = length(options.gravity) * options.time_step * options.time_step;
    return fall > 0 && fall < kFewDigits * digit;
}

void require_jakobsen(const Deformable& deformable, const SimulationOptions& options) {
    const auto refuse = [](bool condition, const char* cause) {
        require_option(!condition, std::string(cause) + ", or use the newton solver");
    };
    refuse(!deformable.tetrahedra.empty(),
           "the deformable has tetrahedra, which the jakobsen solver does not support; leave them out");
    refuse(!deformable.handles.empty(), "the deformable has handles, which the jakobsen solver does not "
                                        "support; pin or attach the particles");
    refuse(rounding_decides(deformable, options),
           "the deformable begins so far from the origin, or time_step is so small, that in a frame of the "
           "jakobsen solver gravity moves particles by little more than a float's last digit; begin nearer");
}

} // namespace

void require_solver(const Deformable& deformable, const SimulationOptions& options) {
    if (options.kind() == SolverKind::Jakobsen) return require_jakobsen(deformable, options);
    require_option(
        !(options.newton().pressure > 0) || !closed_pieces(deformable).empty(),
        "simulation option pressure is positive, and no piece of the cloth is closed; close one, or "
        "leave the pressure out");
}

namespace {

/// @param name  of the item that refers to them
void require_there(const std::string& name, std::uint32_t particle, std::uint32_t collider,
                   std::size_t particle_count, std::size_t collider_count) {
    if (particle >= particle_count)
        fail(name + ": the last particle is " + std::to_string(particle_count - 1));
    if (collider >= collider_count)
        fail(name + " refers to collider " + std::to_string(collider) + " of " +
             std::to_string(collider_count) + ", numbered from 0");
}

} // namespace

void require_valid_attachments(const Deformable& deformable, std::size_t collider_count) {
    std::vector<bool> is_attached(deformable.particle_count(), false);
    for (std::size_t i = 0; i < deformable.attachments.size(); ++i) {
        const auto& [particle, collider] = deformable.attachments[i];
        const std::string name =
            "attachment " + std::to_string(i) + " of particle " + std::to_string(particle);
        require_there(name, particle, collider, deformable.particle_count(), collider_count);
        if (deformable.inverse_masses[particle] != 0)
            fail(name + ": an attached particle must be pinned, with the inverse mass 0");
        if (is_attached[particle]) fail(name + " is not its first; a particle has at most one");
        is_attached[particle] = true;
    }
}

void require_valid_filters(const Deformable& deformable, std::size_t collider_count) {
    for (std::size_t i = 0; i < deformable.filters.size(); ++i) {
        const auto& [particle, collider] = deformable.filters[i];
        const std::string name = "filter " + std::to_string(i) + " of particle " + std::to_string(particle);
        require_there(name, particle, collider, deformable.particle_count(), collider_count);
    }
}

void require_valid(const std::vector<PoseKey>& keys, const std::string& owner) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const std::string name = owner + ": keyframe " + std::to_string(i);
        require_valid(keys[i].pose, name);
        if (!std::isfinite(keys[i].time)) fail(name + " has a time that is not finite");
        if (i > 0 && !(keys[i].time > keys[i - 1].time))
            fail(name + " is at " + std::to_string(keys[i].time) +
                 " s, not later than the one before it, at " + std::to_string(keys[i - 1].time) +
                 " s; times must ascend");
    }
}

void require_valid_handles(const Deformable& deformable) {
    std::vector<bool> is_held(deformable.particle_count());
    for (std::size_t h = 0; h < deformable.handles.size(); ++h) {
        const Handle& handle = deformable.handles[h];
        const std::string name = "handle " + std::to_string(h);
        require_valid(handle.keys, name);
        if (handle.particles.empty()) fail(name + " holds no particles");
        if (std::isnan(handle.release_time)) fail(name + " has a release time that is not a number");
        for (const std::uint32_t particle : handle.particles) {
            const std::string of_particle = name + " of particle " + std::to_string(particle);
            if (particle >= deformable.particle_count())
                fail(of_particle + ": the last one is " + std::to_string(deformable.particle_count() - 1));
            if (deformable.inverse_masses[particle] == 0)
                fail(of_particle + ": it is pinned or attached already");
            if (is_held[particle]) fail(of_particle + " is not its first; a particle has at most one");
            is_held[particle] = true;
        }
    }
}

namespace {

void require_valid(const Collider& collider, const SimulationOptions& options, const std::string& name) {
    for (const double scale : {collider.scale.x, collider.scale.y, collider.scale.z})
        if (static_cast<float>(scale) == 0 || !std::isfinite(static_cast<float>(scale)))
            fail(name + " has a scale of " + number_text(scale) +
                 "; it must be finite and not 0, also as a float");
    require_valid(collider.pose, name);
    if (!is_finite(collider.linear_velocity) || !is_finite(collider.angular_velocity))
        fail(name + " has a velocity that is not finite");
    const auto* custom = std::get_if<std::shared_ptr<const CustomMap>>(&collider.map.kind);
    if (custom != nullptr && *custom == nullptr) fail(name + " has a custom map that is a null pointer");
    require_no_origin(origin_of(collider.map), name);
    const auto* exact = std::get_if<ExactMap>(&collider.map.kind);
    if (!options.surfaces_collide() && exact != nullptr && !exact->view().border.empty() &&
        !options.allow_open_colliders)
        fail(name + " has the exact map of an open mesh, with " +
             std::to_string(exact->view().border.size()) +
             " border edges, where particles get in; close the mesh (repair() closes some), use a distance "
             "map, " +
             (options.kind() == SolverKind::Newton ? "let surfaces collide, which needs no inside, " : "") +
             "or set allow_open_colliders and lose particles");
}

} // namespace

std::string name_of(const VertexCache& cache) {
    std::string name = "its vertex cache";
    if (!cache.name.empty()) name += " " + cache.name;
    return name;
}

void require_valid(const VertexCache& cache, std::size_t vertex_count, const std::string& owner) {
    const std::string name = name_of(cache);
    if (!std::isfinite(cache.start_time) || !std::isfinite(cache.sample_seconds) ||
        !(cache.sample_seconds > 0))
        fail(owner + ": the times of " + name + " are not finite, or the samples not a positive time apart");
    if (cache.vertex_count != vertex_count)
        fail(owner + " has " + std::to_string(vertex_count) + " vertices, and " + name + " " +
             std::to_string(cache.vertex_count) + "; a cache must belong to the same mesh");
    if (cache.samples == nullptr || cache.samples->empty() || cache.samples->size() % vertex_count != 0)
        fail(owner + ": " + name + " has no samples, or the last one is not complete");
    const auto bad = std::find_if(cache.samples->begin(), cache.samples->end(),
                                  [](const Vec3f& p) { return !is_finite(p) || !is_within_reach(p); });
    if (bad != cache.samples->end())
        fail(owner + ": vertex " +
             std::to_string(static_cast<std::size_t>(bad - cache.samples->begin()) % vertex_count) + " of " +
             name +
             (is_finite(*bad) ? " is farther than 1e15 from the origin in sample "
                              : " is not finite in sample ") +
             std::to_string(static_cast<std::size_t>(bad - cache.samples->begin()) / vertex_count));
}

void require_valid(const std::vector<Collider>& colliders, const SimulationOptions& options) {
    for (std::size_t i = 0; i < colliders.size(); ++i)
        require_valid(colliders[i], options, name_of(colliders[i], i));
}

} // namespace echinus
