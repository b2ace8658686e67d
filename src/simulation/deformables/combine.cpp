// Makes deformables from other deformables.

#include "simulation/start/validation.hpp"

#include <echinus/error.hpp>
#include <echinus/soft_body.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace echinus {

namespace {

template <typename Item>
void append(std::vector<Item>& to, const std::vector<Item>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// An index beyond the particles of its part would refer to a particle of the next part.
void require_part(const Deformable& part, std::size_t number, std::size_t particles_before) {
    const std::string name = "part " + std::to_string(number) + " of the combined parts: ";
    try {
        require_valid(part);
    } catch (const Error& error) {
        throw Error(error.code(), name + error.what());
    }
    for (const Attachment& attachment : part.attachments)
        require_option(attachment.particle < part.particle_count(),
                       name + "an attachment refers to particle " + std::to_string(attachment.particle) +
                           "; the last one is " + std::to_string(part.particle_count() - 1));
    for (const Handle& handle : part.handles)
        for (const std::uint32_t particle : handle.particles)
            require_option(particle < part.particle_count(),
                           name + "a handle refers to particle " + std::to_string(particle) +
                               "; the last one is " + std::to_string(part.particle_count() - 1));
    for (const CollisionFilter& filter : part.filters)
        require_option(filter.particle < part.particle_count(),
                       name + "a filter refers to particle " + std::to_string(filter.particle) +
                           "; the last one is " + std::to_string(part.particle_count() - 1));
    require_option(part.particle_count() <= std::numeric_limits<std::uint32_t>::max() - particles_before,
                   name + "it would have particles beyond number 4294967295");
}

void append(Deformable& to, const Deformable& part) {
    const auto first = static_cast<std::uint32_t>(to.particle_count());
    if (!to.rest_positions.empty() || !part.rest_positions.empty()) {
        if (to.rest_positions.empty()) to.rest_positions = to.positions;
        append(to.rest_positions, part.rest_positions.empty() ? part.positions : part.rest_positions);
    }
    append(to.positions, part.positions);
    if (!to.velocities.empty() || !part.velocities.empty()) {
        to.velocities.resize(first);
        append(to.velocities, part.velocities);
        to.velocities.resize(to.particle_count());
    }
    append(to.inverse_masses, part.inverse_masses);
    for (DistanceConstraint constraint : part.constraints) {
        constraint.a += first;
        constraint.b += first;
        to.constraints.push_back(constraint);
    }
    for (Triangle face : part.faces) {
        for (std::uint32_t& corner : face) corner += first;
        to.faces.push_back(face);
    }
    for (Attachment attachment : part.attachments) {
        attachment.particle += first;
        to.attachments.push_back(attachment);
    }
    for (Handle handle : part.handles) {
        for (std::uint32_t& particle : handle.particles) particle += first;
        to.handles.push_back(std::move(handle));
    }
    for (CollisionFilter filter : part.filters) {
        filter.particle += first;
        to.filters.push_back(filter);
    }
    for (ElasticTetrahedron tetrahedron : part.tetrahedra) {
        for (std::uint32_t& corner : tetrahedron.particles) corner += first;
        to.tetrahedra.push_back(tetrahedron);
    }
}

} // namespace

Deformable combine(std::span<const Deformable> parts) {
    Deformable all;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        require_part(parts[i], i, all.particle_count());
        append(all, parts[i]);
    }
    return all;
}

Deformable with_masses_times(double factor, Deformable deformable) {
    require_option(std::isfinite(factor) && factor > 0, "masses are to be multiplied by " +
                                                            std::to_string(factor) +
                                                            "; the factor must be finite and positive");
    for (float& inverse_mass : deformable.inverse_masses)
        inverse_mass = static_cast<float>(double{inverse_mass} / factor);
    return deformable;
}

Deformable passing_through(std::uint32_t collider, Deformable deformable) {
    for (std::uint32_t particle = 0; particle < deformable.particle_count(); ++particle)
        deformable.filters.push_back({particle, collider});
    return deformable;
}

std::vector<std::uint8_t> let_through(const Deformable& deformable, std::size_t collider) {
    std::vector<std::uint8_t> passes;
    for (const CollisionFilter& filter : deformable.filters) {
        if (filter.collider != collider || filter.particle >= deformable.particle_count()) continue;
        passes.resize(deformable.particle_count());
        passes[filter.particle] = 1;
    }
    return passes;
}

} // namespace echinus
