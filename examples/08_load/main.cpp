// A ball falls on a cloth that is held along its border: the loop of a host that has a solver for rigid
// bodies of its own. In each frame the host hands the velocities of the ball over, Echinus solves for the
// ball and the cloth together, and the host takes the velocities back.

#include <echinus/echinus.hpp>

#include <cstdint>
#include <cstdio>
#include <exception>

int main() try {
    using namespace echinus;
    constexpr double kMass = 0.3; // of the ball, kg; the cloth has 0.8
    constexpr std::uint32_t kFrameCount = 360, kMeasuredFrom = 300;

    ClothOptions sheet{.column_count = 20, .row_count = 20, .width = 2, .height = 2};
    for (std::uint32_t i = 0; i < 20; ++i)
        for (const std::uint32_t pin : {i, 19 * 20 + i, 20 * i, 20 * i + 19}) sheet.pins.push_back(pin);
    Collider ball{.map = ExactMap::build(make_sphere(0.3, 40, 20))};
    ball.pose.translation = {0, 0, 0.8};
    SimulationOptions options;
    options.newton().collision = CollisionMode::Surfaces;
    options.thickness = 0.01;
    Simulation simulation(make_cloth(sheet), {ball}, options);

    Vec3d velocity, angular_velocity, mean_force;
    for (std::uint32_t frame = 0; frame < kFrameCount; ++frame) {
        // Here the forces, contacts and joints of the host change the velocities; gravity acts in the step.
        simulation.set_collider_velocity(0, velocity, angular_velocity);
        simulation.set_collider_free(0, kMass);
        simulation.step();
        velocity = simulation.colliders()[0].linear_velocity;
        angular_velocity = simulation.colliders()[0].angular_velocity;
        if (frame >= kMeasuredFrom)
            mean_force += simulation.load_on(0).force * (1.0 / (kFrameCount - kMeasuredFrom));
    }
    std::printf("the ball hangs in the cloth at height %.1f, which bears %.0f %% of its weight\n",
                simulation.colliders()[0].pose.translation.z, 100 * mean_force.z / (kMass * 9.81));
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
