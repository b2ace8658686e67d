// A beam bends under its own weight, as far as Timoshenko's theory says or how near to it.
// Arguments: cuboids across its height (4), Poisson's ratio (0.3).

#include <echinus/soft_body.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

using namespace echinus;

int main(int argument_count, char** arguments) try {
    const std::uint32_t segments = argument_count > 1 ? std::atoi(arguments[1]) : 4;
    const double poisson = argument_count > 2 ? std::atof(arguments[2]) : 0.3;
    const double length = 1, height = 0.2, density = 1000, gravity = 10,
                 young = 5e6; // metres, kilograms, pascals

    // From x = 0, where it is held, to x = 1.
    TetrahedralMesh mesh =
        make_solid_box({length, height / 2, height}, {5 * segments, segments / 2, segments});
    SoftBodyOptions material{.density = density, .young_modulus = young, .poisson_ratio = poisson};
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
        mesh.vertices[i].x += 0.5F;
        if (mesh.vertices[i].x < 1e-4F) material.pins.push_back(i);
    }

    // The drag of the air makes the lowest oscillation die away soon.
    const double pace = 3.516 * std::sqrt(young / density) * height / std::sqrt(12.0);
    SimulationOptions options{
        .solver = NewtonOptions{.air_drag = 1.6 * pace, .collision = CollisionMode::Particles},
        .gravity = {0, 0, -gravity}};
    Simulation simulation(make_soft_body(mesh, material), {}, options);
    while (simulation.frame() * options.time_step * pace < 12) simulation.step();

    const auto last = mesh.vertices.size() - 1; // a corner of the free end
    const double sag = mesh.vertices[last].z - simulation.positions()[last].z;
    const double bending = 1.5 * density * gravity / young / (height * height);
    const double shear = density * gravity / young * (12 + 11 * poisson) / 10; // Cowper's coefficient
    std::printf("%zu tetrahedra: the end sinks by %.4f, %.1f %% of what a beam does\n",
                mesh.tetrahedra.size(), sag, 100 * sag / (bending + shear));
} catch (const std::exception& error) { // for example 0 cuboids, or a Poisson's ratio of 0.5
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
