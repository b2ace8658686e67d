// A cloth falls on a ball and comes to rest; brute force then counts the particles inside.

#include <echinus/echinus.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>

int main() try {
    using namespace echinus;
    constexpr std::uint32_t kFrameLimit = 3000;

    const TriangleMesh ball = make_sphere(1.0, 60, 30);
    ClothOptions sheet{.column_count = 20, .row_count = 20, .width = 2.4, .height = 2.4};
    sheet.pose.translation = {0, 0, 1.1};

    Simulation simulation(make_cloth(sheet), {Collider{.map = ExactMap::build(ball)}}, {.thickness = 0.01});
    while (!simulation.at_rest() && simulation.frame() < kFrameLimit) simulation.step();

    const auto inside_count = std::ranges::count_if(
        simulation.positions(), [&](const Vec3f& point) { return winding_number(ball, Vec3d(point)) > 0.5; });
    std::printf("%s after %u frames; %td of %zu particles inside the ball\n",
                simulation.at_rest() ? "at rest" : "still moving", simulation.frame(), inside_count,
                simulation.positions().size());
} catch (const std::exception& error) { // for example a cloth that flies apart: ErrorCode::Diverged
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
