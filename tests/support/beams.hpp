#pragma once

#include "support/soft_bodies.hpp"

#include <echinus/soft_body.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

/// Bars and beams of length 1 that are held at one end, beside what the theory of elasticity says.
namespace echinus::test {

struct Beam {
    std::uint32_t segments = 4; ///< across its height
    double poisson_ratio = 0.3;
    double slenderness = 5; ///< length over height; its width is half its height where it bends
    /// density * gravity * length / Young's modulus: twice the strain of a bar that hangs, on the average.
    double strain = 0.02;
    /// How far a wave goes in a substep, in segments: the smaller, the less is left of what one relaxation
    /// leaves undone, and the coarser are forces rounded.
    double courant_number = 0.5;
    std::uint32_t iterations = 1;
};

struct Settled {
    double deflection, expected; ///< of the free end
    double volume_ratio;         ///< of what it has at rest
    std::size_t tetrahedron_count;
};

/// @param down  along x for a bar, across for a beam
/// @param pace  the lowest frequency, radians per second; drag makes it die away fastest
inline Settled settle(const Beam& beam, const Vec3d& down, std::uint32_t segments_across, double pace,
                      double expected) {
    constexpr double kDensity = 1000, kGravity = 10;
    const double height = 1 / beam.slenderness, spacing = height / beam.segments;
    const auto along = static_cast<std::uint32_t>(std::lround(1 / spacing));
    TetrahedralMesh mesh =
        make_solid_box({1, segments_across * spacing, height}, {along, segments_across, beam.segments});
    for (Vec3f& vertex : mesh.vertices) vertex.x += 0.5F;
    const double young = kDensity * kGravity / beam.strain;
    const Deformable body = make_soft_body(mesh, {.density = kDensity,
                                                  .young_modulus = young,
                                                  .poisson_ratio = beam.poisson_ratio,
                                                  .pins = vertices_at_x(mesh, 0)});
    const double speed = std::sqrt(young / kDensity);
    SimulationOptions options{.solver = SolverKind::Xpbd,
                              .iteration_count = beam.iterations,
                              .substep_count = 10,
                              .gravity = down * kGravity};
    options.time_step = beam.courant_number * spacing / speed * options.substep_count;
    options.drag = std::min(0.9, 1.6 * pace * speed * options.time_step);
    Simulation simulation(body, {}, options);
    while (simulation.frame() * options.time_step * pace * speed < 12) simulation.step();
    Settled settled{0, expected * beam.strain, 0, body.tetrahedra.size()};
    const auto end = vertices_at_x(mesh, 1);
    for (const std::uint32_t i : end)
        settled.deflection += dot(Vec3d(simulation.positions()[i]) - Vec3d(mesh.vertices[i]), down) /
                              static_cast<double>(end.size());
    settled.volume_ratio =
        volume_of(body.tetrahedra, simulation.positions()) / volume_of(body.tetrahedra, body.positions);
    return settled;
}

/// A bar that hangs from one end gets longer by density gravity length^2 / (2 E).
inline Settled hang_bar(Beam beam) {
    beam.slenderness = 8;
    return settle(beam, {1, 0, 0}, beam.segments, std::numbers::pi / 2, 0.5);
}

/// A beam that is fixed at one end and bends under its own weight: that of Bernoulli, and of Timoshenko for
/// its shear, with Cowper's coefficient of a rectangle.
inline Settled bend_cantilever(Beam beam) {
    beam.strain = 2e-3;
    const double height = 1 / beam.slenderness, nu = beam.poisson_ratio;
    const double shear_coefficient = 10 * (1 + nu) / (12 + 11 * nu);
    const double bending = 1.5 / (height * height), shear = (1 + nu) / shear_coefficient;
    return settle(beam, {0, 0, -1}, std::max(1U, beam.segments / 2), 3.516 * height / std::sqrt(12.0),
                  bending + shear);
}

} // namespace echinus::test
