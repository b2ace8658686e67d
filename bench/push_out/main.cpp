// Both push-outs on a leg of the horse: particles just below its surface, and a cloth that falls across it.
// Prints the tables of docs/push_out.md.
//
//   echinus_push_out models/horse.3ds scenes/leg.json scenes/leg_distance.json

#include <echinus/collider.hpp>
#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

using namespace echinus;

namespace {

/// The part of a foreleg between knee and hoof, and the way that it runs, in the horse's frame.
bool on_leg(const Vec3f& p) {
    return p.x > -0.2F && p.x < 0.0F && p.y > -0.64F && p.y < -0.42F && p.z > 0.1F;
}
const Vec3d kLegAxis = Vec3d{0.033, 0.2, 0.002} * (1 / length(Vec3d{0.033, 0.2, 0.002}));

struct Mean {
    double sum = 0, largest = 0;
    std::size_t count = 0;

    void add(double value) {
        sum += value;
        largest = std::max(largest, value);
        ++count;
    }
    double mean() const { return count == 0 ? 0 : sum / static_cast<double>(count); }
};

/// Particles on the leg's surface, moved inwards by up to a hundredth of R.
std::vector<Vec3f> particles_below_surface(const TriangleMesh& mesh, const ExactMap& judge) {
    std::mt19937 engine(20261121);
    std::uniform_real_distribution<float> share(0, 1);
    std::vector<Vec3f> particles;
    while (particles.size() < 20'000) {
        const Triangle& face = mesh.faces[engine() % mesh.faces.size()];
        const Vec3f a = mesh.vertices[face[0]];
        const Vec3f ab = mesh.vertices[face[1]] - a;
        const Vec3f ac = mesh.vertices[face[2]] - a;
        const Vec3f normal = cross(ab, ac);
        const float u = share(engine);
        const float v = share(engine) * (1 - u);
        const float depth = 0.01F * judge.view().radius * share(engine);
        if (length(normal) == 0) continue;
        const Vec3f p = a + ab * u + ac * v - normal * (depth / length(normal));
        if (on_leg(p) && contains(judge, p)) particles.push_back(p);
    }
    return particles;
}

struct PushFigures {
    Mean length, excess, along;
};

PushFigures push_of(const Collider& collider, const std::vector<Vec3f>& particles, const ExactMap& judge) {
    PushFigures figures;
    for (const Vec3f& p : particles) {
        const Contact found = contact(collider, p);
        if (!found.inside) continue; // the distance map errs for some
        const Vec3d push = Vec3d(found.point) - Vec3d(p);
        figures.length.add(length(push));
        figures.excess.add(length(push) / std::max<double>(contact(judge, p).depth, 1e-6));
        figures.along.add(std::fabs(dot(push, kLegAxis)));
    }
    return figures;
}

struct RunFigures {
    std::uint32_t frames = 0;
    bool rested = false;
    Mean depth_in_motion; ///< of particles inside at the end of any frame
    Mean depth_at_rest;
    double slip_along = 0; ///< of the cloth's middle
};

Mean depths_of(const Simulation& simulation, const ExactMap& judge) {
    Mean depths;
    for (const Vec3f& p : simulation.positions()) {
        const Contact found = contact(judge, p);
        if (found.inside) depths.add(found.depth);
    }
    return depths;
}

Vec3d middle(const Simulation& simulation) {
    Vec3d sum;
    for (const Vec3f& p : simulation.positions()) sum += Vec3d(p);
    return sum * (1.0 / static_cast<double>(simulation.positions().size()));
}

RunFigures run(const Scene& scene, const AnyMap& map, const ExactMap& judge) {
    Simulation simulation = make_simulation(scene, map);
    const Vec3d start = middle(simulation);
    RunFigures figures;
    while (!simulation.at_rest() && simulation.frame() < scene.frame_limit) {
        simulation.step();
        const Mean depths = depths_of(simulation, judge);
        figures.depth_in_motion.sum += depths.sum;
        figures.depth_in_motion.count += depths.count;
        figures.depth_in_motion.largest = std::max(figures.depth_in_motion.largest, depths.largest);
    }
    figures.frames = simulation.frame();
    figures.rested = simulation.at_rest();
    figures.depth_at_rest = depths_of(simulation, judge);
    figures.slip_along = dot(middle(simulation) - start, kLegAxis);
    return figures;
}

void print_tables(const TriangleMesh& mesh, const Scene (&scenes)[2]) {
    const ExactMap judge = ExactMap::build(mesh);
    const double radius = judge.view().radius;
    const std::vector<Vec3f> particles = particles_below_surface(mesh, judge);
    PushFigures push[2];
    RunFigures runs[2];
    for (int k = 0; k < 2; ++k) {
        const AnyMap map = build_map(mesh, scenes[k].map);
        push[k] = push_of(make_collider(scenes[k], map), particles, judge);
        runs[k] = run(scenes[k], map, judge);
    }
    const auto row = [](const char* what, const std::string& exact, const std::string& radial) {
        fmt::print("| {} | {} | {} |\n", what, exact, radial);
    };
    const auto both = [&](const char* what, const auto& figure) { row(what, figure(0), figure(1)); };
    const auto in_radii = [&](double l) { return fmt::format("{:.5f}", l / radius); };
    fmt::print("| one particle, {} of them | exact | distance |\n|---|---|---|\n", particles.size());
    both("found inside", [&](int k) { return fmt::format("{}", push[k].length.count); });
    both("push, mean, R", [&](int k) { return in_radii(push[k].length.mean()); });
    both("push, longest, R", [&](int k) { return in_radii(push[k].length.largest); });
    both("push / true depth, mean", [&](int k) { return fmt::format("{:.2f}", push[k].excess.mean()); });
    both("push along the leg, mean, R", [&](int k) { return in_radii(push[k].along.mean()); });
    both("push along the leg, longest, R", [&](int k) { return in_radii(push[k].along.largest); });
    fmt::print("\n| the cloth | exact | distance |\n|---|---|---|\n");
    both("frames to rest",
         [&](int k) { return runs[k].rested ? fmt::format("{}", runs[k].frames) : "never"; });
    both("inside, particles times frames",
         [&](int k) { return fmt::format("{}", runs[k].depth_in_motion.count); });
    both("of them, mean depth, R", [&](int k) { return in_radii(runs[k].depth_in_motion.mean()); });
    both("of them, worst depth, R", [&](int k) { return in_radii(runs[k].depth_in_motion.largest); });
    both("inside at rest", [&](int k) { return fmt::format("{}", runs[k].depth_at_rest.count); });
    both("worst depth at rest, R", [&](int k) { return in_radii(runs[k].depth_at_rest.largest); });
    both("the cloth slid along the leg, R", [&](int k) { return in_radii(runs[k].slip_along); });
}

} // namespace

int main(int count, char** words) {
    if (count != 4) {
        fmt::print(stderr, "usage: echinus_push_out MODEL EXACT_SCENE DISTANCE_SCENE\n");
        return 2;
    }
    try {
        const Scene scenes[2] = {read_scene(words[2]), read_scene(words[3])};
        print_tables(repair(read_mesh(words[1]), scenes[0].repair).mesh, scenes);
    } catch (const Error& error) {
        fmt::print(stderr, "echinus_push_out: {}\n", error.what());
        return 1;
    }
}
