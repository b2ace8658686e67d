#include "border.hpp"
#include "handles.hpp"
#include "options.hpp"

#include <echinus/error.hpp>
#include <echinus/soft_body.hpp>

#include <array>
#include <cstring>
#include <type_traits>

namespace echinus::c {

ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_deformable_arrays, filter_count);
template <>
inline constexpr std::size_t kFirstSize<echinus_deformable_arrays> = offsetof(echinus_deformable_arrays,
                                                                              tetrahedra);

static_assert(ECHINUS_CONSTRAINT_SHEAR == static_cast<int>(ConstraintKind::Shear) &&
              ECHINUS_CONSTRAINT_BENDING == static_cast<int>(ConstraintKind::Bending) &&
              ECHINUS_CONSTRAINT_KIND_COUNT == kConstraintKindCount);
static_assert(sizeof(echinus_distance_constraint) == sizeof(DistanceConstraint) &&
              offsetof(echinus_distance_constraint, b) == offsetof(DistanceConstraint, b) &&
              offsetof(echinus_distance_constraint, rest_length) ==
                  offsetof(DistanceConstraint, rest_length) &&
              offsetof(echinus_distance_constraint, kind) == offsetof(DistanceConstraint, kind));
static_assert(sizeof(echinus_attachment) == sizeof(Attachment) &&
              offsetof(echinus_attachment, collider) == offsetof(Attachment, collider));
static_assert(sizeof(echinus_collision_filter) == sizeof(CollisionFilter) &&
              offsetof(echinus_collision_filter, collider) == offsetof(CollisionFilter, collider));
static_assert(sizeof(echinus_elastic_tetrahedron) == sizeof(ElasticTetrahedron) &&
              offsetof(echinus_elastic_tetrahedron, gradients) == offsetof(ElasticTetrahedron, gradients) &&
              offsetof(echinus_elastic_tetrahedron, volume) == offsetof(ElasticTetrahedron, volume) &&
              offsetof(echinus_elastic_tetrahedron, mu) == offsetof(ElasticTetrahedron, mu) &&
              offsetof(echinus_elastic_tetrahedron, lambda) == offsetof(ElasticTetrahedron, lambda) &&
              offsetof(echinus_elastic_tetrahedron, damping) == offsetof(ElasticTetrahedron, damping));

echinus_deformable_arrays arrays_of(const Deformable& deformable) {
    echinus_deformable_arrays arrays{};
    arrays.particle_count = deformable.particle_count();
    arrays.positions = reinterpret_cast<const float*>(deformable.positions.data());
    arrays.velocities = deformable.velocities.empty()
                            ? nullptr
                            : reinterpret_cast<const float*>(deformable.velocities.data());
    arrays.inverse_masses = deformable.inverse_masses.data();
    arrays.constraints = reinterpret_cast<const echinus_distance_constraint*>(deformable.constraints.data());
    arrays.constraint_count = deformable.constraints.size();
    arrays.faces = reinterpret_cast<const std::uint32_t*>(deformable.faces.data());
    arrays.face_count = deformable.faces.size();
    arrays.attachments = reinterpret_cast<const echinus_attachment*>(deformable.attachments.data());
    arrays.attachment_count = deformable.attachments.size();
    arrays.tetrahedra = reinterpret_cast<const echinus_elastic_tetrahedron*>(deformable.tetrahedra.data());
    arrays.tetrahedron_count = deformable.tetrahedra.size();
    arrays.filters = reinterpret_cast<const echinus_collision_filter*>(deformable.filters.data());
    arrays.filter_count = deformable.filters.size();
    return arrays;
}

namespace {

/// C++ values from C values that have the same layout in memory.
template <typename T, typename Given>
std::vector<T> copy_of(const Given* first, std::size_t count, const char* name) {
    static_assert(sizeof(T) == sizeof(Given) && std::is_trivially_copyable_v<T>);
    const std::span<const Given> values = values_at(first, count, name);
    std::vector<T> result(values.size());
    if (!values.empty()) std::memcpy(static_cast<void*>(result.data()), values.data(), values.size_bytes());
    return result;
}

std::vector<DistanceConstraint> constraints_from(std::span<const echinus_distance_constraint> constraints) {
    std::vector<DistanceConstraint> result;
    for (const echinus_distance_constraint& constraint : constraints) {
        if (constraint.kind >= kConstraintKindCount)
            throw WrongArgument("constraint " + std::to_string(result.size()) + " is of kind " +
                                std::to_string(constraint.kind) + "; expected 0 to 2");
        result.push_back({constraint.a, constraint.b, constraint.rest_length,
                          static_cast<ConstraintKind>(constraint.kind)});
    }
    return result;
}

Deformable deformable_from(const echinus_deformable_arrays& arrays) {
    const std::size_t count = arrays.particle_count;
    const std::vector<Vec3f> positions = points_from(arrays.positions, count, 0, "positions");
    return {
        .positions = positions,
        .velocities = arrays.velocities == nullptr ? std::vector<Vec3f>()
                                                   : points_from(arrays.velocities, count, 0, "velocities"),
        .inverse_masses = arrays.inverse_masses == nullptr
                              ? std::vector<float>(count, 1.0F)
                              : copy_of<float>(arrays.inverse_masses, count, "inverse_masses"),
        .constraints =
            constraints_from(values_at(arrays.constraints, arrays.constraint_count, "constraints")),
        .faces = faces_from(arrays.faces, arrays.face_count, "faces"),
        .attachments = copy_of<Attachment>(arrays.attachments, arrays.attachment_count, "attachments"),
        .tetrahedra = copy_of<ElasticTetrahedron>(arrays.tetrahedra, arrays.tetrahedron_count, "tetrahedra"),
        .filters = copy_of<CollisionFilter>(arrays.filters, arrays.filter_count, "filters"),
    };
}

/// Refuses an index beyond the part's vertices, which would refer to the next part.
/// @throws Error InvalidOptions
void require_own_particles(const Deformable& part, std::size_t number) {
    const auto require_there = [&](std::uint32_t particle, const char* what) {
        if (particle >= part.particle_count())
            throw Error(ErrorCode::InvalidOptions, "part " + std::to_string(number) + ": " + what +
                                                       " refers to particle " + std::to_string(particle) +
                                                       " of " + std::to_string(part.particle_count()));
    };
    for (const DistanceConstraint& s : part.constraints)
        for (const std::uint32_t particle : {s.a, s.b}) require_there(particle, "a distance constraint");
    for (const Triangle& face : part.faces)
        for (const std::uint32_t particle : face) require_there(particle, "a face");
    for (const Attachment& a : part.attachments) require_there(a.particle, "an attachment");
    for (const CollisionFilter& f : part.filters) require_there(f.particle, "a filter");
    for (const ElasticTetrahedron& t : part.tetrahedra)
        for (const std::uint32_t particle : t.particles) require_there(particle, "a tetrahedron");
}

Deformable combined(std::span<const echinus_deformable* const> parts) {
    std::vector<Deformable> copies;
    for (const echinus_deformable* part : parts) {
        copies.push_back(at(part, "a part").value);
        require_own_particles(copies.back(), copies.size() - 1);
    }
    return combine(copies);
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_deformable_create(const echinus_deformable_arrays* arrays,
                                         echinus_deformable** deformable) {
    return make(__func__, deformable,
                [&] { return deformable_from(read_struct(arrays, echinus_deformable_arrays{}, "arrays")); });
}

echinus_status echinus_deformable_cloth(const echinus_cloth_options* options,
                                        echinus_deformable** deformable) {
    return make(__func__, deformable, [&] { return make_cloth(options_from(options)); });
}

echinus_status echinus_deformable_cloth_of_mesh(const echinus_mesh* mesh,
                                                const echinus_mesh_cloth_options* options,
                                                echinus_deformable** deformable) {
    return make(__func__, deformable,
                [&] { return make_cloth(at(mesh, "mesh").value, options_from(options)); });
}

echinus_status echinus_deformable_soft_body(const echinus_tetrahedra* body,
                                            const echinus_soft_body_options* options,
                                            echinus_deformable** deformable) {
    return make(__func__, deformable,
                [&] { return make_soft_body(at(body, "body").value, options_from(options)); });
}

echinus_status echinus_deformable_combine(const echinus_deformable* const* parts, size_t part_count,
                                          echinus_deformable** deformable) {
    return make(__func__, deformable, [&] { return combined(values_at(parts, part_count, "parts")); });
}
echinus_status echinus_deformable_with_masses_times(const echinus_deformable* deformable, double factor,
                                                    echinus_deformable** result) {
    return make(__func__, result,
                [&] { return with_masses_times(factor, at(deformable, "deformable").value); });
}
echinus_status echinus_deformable_passing_through(const echinus_deformable* deformable, uint32_t collider,
                                                  echinus_deformable** result) {
    return make(__func__, result,
                [&] { return passing_through(collider, at(deformable, "deformable").value); });
}

echinus_status echinus_deformable_read(const echinus_deformable* deformable,
                                       echinus_deformable_arrays* arrays) {
    return guarded(__func__,
                   [&] { write_struct(arrays, arrays_of(at(deformable, "deformable").value), "arrays"); });
}

void echinus_deformable_destroy(echinus_deformable* deformable) {
    delete deformable;
}
