#pragma once

#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>
#include <echinus/tetrahedra.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus::test {

/// A brick of count^3 unit cubes, each cut into six tetrahedra around its diagonal (Kuhn's).
inline TetrahedralMesh make_brick(std::uint32_t count) {
    const auto number = [&](const std::array<std::uint32_t, 3>& p) {
        return (p[2] * (count + 1) + p[1]) * (count + 1) + p[0];
    };
    TetrahedralMesh brick;
    for (std::uint32_t z = 0; z <= count; ++z)
        for (std::uint32_t y = 0; y <= count; ++y)
            for (std::uint32_t x = 0; x <= count; ++x)
                brick.vertices.emplace_back(static_cast<float>(x), static_cast<float>(y),
                                            static_cast<float>(z));
    const std::array<std::array<std::size_t, 3>, 6> orders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (std::uint32_t cube = 0; cube < count * count * count; ++cube)
        for (std::size_t way = 0; way < 6; ++way) {
            std::array<std::uint32_t, 3> p{cube % count, cube / count % count, cube / count / count};
            Tetrahedron corners{number(p), 0, 0, 0};
            for (std::size_t step = 0; step < 3; ++step) {
                ++p[orders[way][step]];
                corners[step + 1] = number(p);
            }
            if (way >= 3) std::swap(corners[2], corners[3]); // an odd order of the axes
            brick.tetrahedra.push_back(corners);
        }
    return brick;
}

} // namespace echinus::test

/// Soft bodies, and what their elements are like, computed anew in double precision.
namespace echinus::test {

/// Particles are within 1e-4 of the box's side at this place along x.
inline std::vector<std::uint32_t> vertices_at_x(const TetrahedralMesh& mesh, float x) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
        if (std::fabs(mesh.vertices[i].x - x) < 1e-4F) found.push_back(i);
    return found;
}

/// Columns of F.
inline std::array<Vec3d, 3> deformation(const ElasticTetrahedron& tetrahedron,
                                        std::span<const Vec3f> positions) {
    const auto edge = [&](std::size_t k) {
        return Vec3d(positions[tetrahedron.particles[k + 1]]) - Vec3d(positions[tetrahedron.particles[0]]);
    };
    std::array<Vec3d, 3> f;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d gradient(tetrahedron.gradients[k]);
        f[0] += edge(k) * gradient.x;
        f[1] += edge(k) * gradient.y;
        f[2] += edge(k) * gradient.z;
    }
    return f;
}

/// Of the volume at rest; negative where it is inside out.
inline double volume_ratio(const ElasticTetrahedron& tetrahedron, std::span<const Vec3f> positions) {
    const auto f = deformation(tetrahedron, positions);
    return dot(cross(f[0], f[1]), f[2]);
}

inline double volume_of(std::span<const ElasticTetrahedron> tetrahedra, std::span<const Vec3f> positions) {
    double sum = 0;
    for (const ElasticTetrahedron& tetrahedron : tetrahedra)
        sum += volume_ratio(tetrahedron, positions) * double{tetrahedron.volume};
    return sum;
}

inline double least_volume_ratio(const Deformable& body, std::span<const Vec3f> positions) {
    double least = 1e30;
    for (const ElasticTetrahedron& tetrahedron : body.tetrahedra)
        least = std::min(least, volume_ratio(tetrahedron, positions));
    return least;
}

/// The stable Neo-Hookean energy as Macklin and Mueller 2021 write it, less that at rest.
inline double elastic_energy(const ElasticTetrahedron& tetrahedron, std::span<const Vec3f> positions) {
    const auto f = deformation(tetrahedron, positions);
    const double mu{tetrahedron.mu}, l = mu + double{tetrahedron.lambda};
    const double square = dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2]);
    const double hydrostatic = dot(cross(f[0], f[1]), f[2]) - 1 - mu / l;
    return double{tetrahedron.volume} *
           (mu / 2 * (square - 3) + l / 2 * hydrostatic * hydrostatic - mu * mu / l / 2);
}

/// Of motion and of elasticity.
inline double energy(const Simulation& simulation) {
    const Deformable& body = simulation.deformable();
    double sum = 0;
    for (std::size_t i = 0; i < body.particle_count(); ++i) {
        if (body.inverse_masses[i] == 0) continue;
        const Vec3d velocity(body.velocities[i]);
        sum += dot(velocity, velocity) / double{body.inverse_masses[i]} / 2;
    }
    for (const ElasticTetrahedron& tetrahedron : body.tetrahedra)
        sum += elastic_energy(tetrahedron, body.positions);
    return sum;
}

} // namespace echinus::test
