// Scenes by which others judge codes of contact: those of IPC (Li et al. 2020, github.com/ipc-sim/IPC), with
// the lengths, materials and motions of their set-ups in github.com/polyfem/polyfem-data. Erleben's obstacles
// come from there; all other shapes are generated. docs/judged_by_others.md says what differs. The y axis is
// up.

#include "support/surface_judge.hpp"

#include <echinus/soft_body.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <numbers>
#include <ostream>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace echinus;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr Vec3d kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};
constexpr double kGravity = 9.81;

RigidTransform turned(const Vec3d& axis, double degrees, const Vec3d& translation = {}) {
    return {Rotation::about(axis, degrees * kPi / 180), translation};
}

RigidTransform at(const Vec3d& translation) {
    return {{}, translation};
}

// ---- Shapes ----

/// The vertices and triangles of an OBJ file that has nothing else.
TriangleMesh erleben(const std::string& name) {
    std::ifstream in(std::string(ECHINUS_TRUTH) + "/erleben/" + name + ".obj");
    EXPECT_TRUE(in) << name;
    TriangleMesh mesh;
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        std::string kind;
        fields >> kind;
        if (kind == "v") {
            Vec3f& v = mesh.vertices.emplace_back();
            fields >> v.x >> v.y >> v.z;
        } else if (kind == "f") {
            Triangle& face = mesh.faces.emplace_back();
            for (std::uint32_t& corner : face) {
                fields >> corner;
                --corner;
            }
        }
    }
    return mesh;
}

/// The inside of a convex surface: tetrahedra between its first vertex and the faces that it does not lie in.
TetrahedralMesh filled(const TriangleMesh& convex) {
    TetrahedralMesh body{convex.vertices, {}};
    const Vec3d apex(convex.vertices[0]);
    for (const auto& [a, b, c] : convex.faces) {
        const auto edge = [&](std::uint32_t v) { return Vec3d(convex.vertices[v]) - apex; };
        if (dot(cross(edge(a), edge(b)), edge(c)) > 1e-6) body.tetrahedra.push_back({a, c, b, 0});
    }
    return body;
}

/// Each tetrahedron divided into eight by the middles of its edges.
TetrahedralMesh divided(const TetrahedralMesh& mesh) {
    TetrahedralMesh fine{mesh.vertices, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto number = static_cast<std::uint32_t>(fine.vertices.size());
        const auto [found, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, number);
        if (is_new) fine.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) * 0.5F);
        return found->second;
    };
    for (const auto& [a, b, c, d] : mesh.tetrahedra) {
        const std::uint32_t ab = middle(a, b), ac = middle(a, c), ad = middle(a, d), bc = middle(b, c),
                            bd = middle(b, d), cd = middle(c, d);
        const std::array<Tetrahedron, 8> parts{{{a, ab, ac, ad},
                                                {ab, b, bc, bd},
                                                {ac, bc, c, cd},
                                                {ad, bd, cd, d},
                                                {ab, cd, ac, ad},
                                                {ab, cd, ad, bd},
                                                {ab, cd, bd, bc},
                                                {ab, cd, bc, ac}}};
        fine.tetrahedra.insert(fine.tetrahedra.end(), parts.begin(), parts.end());
    }
    return fine;
}

TetrahedralMesh cube(double side, std::uint32_t segments) {
    return make_solid_box({side, side, side}, {segments, segments, segments});
}

/// A tetrahedron with a face below and a vertex above the middle of the face.
TetrahedralMesh pyramid() {
    return {{{0, 0.4F, 0}, {0.5F, -0.4F, -0.3F}, {-0.5F, -0.4F, -0.3F}, {0, -0.4F, 0.6F}}, {{1, 2, 3, 0}}};
}

/// A tetrahedron with an edge above, and one below that is perpendicular to it.
TetrahedralMesh crossed_edges() {
    return {{{0.5F, 0.4F, 0}, {-0.5F, 0.4F, 0}, {0, -0.4F, 0.5F}, {0, -0.4F, -0.5F}}, {{0, 1, 3, 2}}};
}

/// A tetrahedron in the corner of three planes.
TetrahedralMesh corner() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
}

/// The tetrahedra whose middles satisfy a condition, and their vertices.
template <typename Keeps>
TetrahedralMesh part_of(const TetrahedralMesh& whole, const Keeps& keeps) {
    TetrahedralMesh part;
    std::map<std::uint32_t, std::uint32_t> numbers;
    for (Tetrahedron tetrahedron : whole.tetrahedra) {
        Vec3d middle;
        for (const std::uint32_t v : tetrahedron) middle += Vec3d(whole.vertices[v]) * 0.25;
        if (!keeps(middle)) continue;
        for (std::uint32_t& v : tetrahedron) {
            const auto number = static_cast<std::uint32_t>(part.vertices.size());
            const auto [found, is_new] = numbers.try_emplace(v, number);
            if (is_new) part.vertices.push_back(whole.vertices[v]);
            v = found->second;
        }
        part.tetrahedra.push_back(tetrahedron);
    }
    return part;
}

/// A table of 1 x 0.75 x 1 m on four legs.
TetrahedralMesh table() {
    return part_of(make_solid_box({1, 0.75, 1}, {6, 6, 6}), [](const Vec3d& p) {
        return p.y > 0.25 || (std::abs(p.x) > 1.0 / 3 && std::abs(p.z) > 1.0 / 3);
    });
}

TetrahedralMesh solid(const TriangleMesh& surface, double size) {
    const ExactMap map = ExactMap::build(surface);
    return tetrahedralize(map, {.size = size}).mesh;
}

TetrahedralMesh torus(double major_radius, double minor_radius, double size) {
    return solid(make_torus(major_radius, minor_radius, 48, 24), size);
}

TetrahedralMesh ball(double radius, double size) {
    return solid(make_sphere(radius, 48, 24), size);
}

/// A square of upright pins a metre apart.
TriangleMesh pins(int count) {
    constexpr float kRadius = 0.05F;
    TriangleMesh all;
    for (int i = 0; i < count * count; ++i) {
        const auto x = static_cast<float>(i % count), z = static_cast<float>(i / count);
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        for (const Vec3f& p : {Vec3f{kRadius, 0, 0}, Vec3f{0, 0, kRadius}, Vec3f{-kRadius, 0, 0},
                               Vec3f{0, 0, -kRadius}, Vec3f{0, 1, 0}})
            all.vertices.push_back(p + Vec3f{x, 0, z});
        for (const auto& [a, b, c] :
             {Triangle{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}, {0, 1, 2}, {0, 2, 3}})
            all.faces.push_back({first + a, first + b, first + c});
    }
    return all;
}

/// A funnel along x whose end is narrower than the torus that is pulled through.
TriangleMesh funnel() {
    constexpr std::array<std::array<double, 2>, 6> kOutline{
        {{-0.5, 0.9}, {0.3, 0.3}, {0.9, 0.3}, {0.9, 0.36}, {0.3, 0.36}, {-0.5, 0.98}}};
    constexpr std::uint32_t kAround = 24, kAlong = kOutline.size();
    TriangleMesh mesh;
    for (std::uint32_t a = 0; a < kAround; ++a)
        for (std::uint32_t k = 0; k < kAlong; ++k) {
            const auto& [x, radius] = kOutline[k];
            mesh.vertices.push_back(Vec3f(turned(kX, 360.0 * a / kAround).rotation.apply({x, radius, 0})));
            const std::uint32_t here = a * kAlong, there = (a + 1) % kAround * kAlong,
                                next = (k + 1) % kAlong;
            mesh.faces.push_back({here + k, here + next, there + next});
            mesh.faces.push_back({here + k, there + next, there + k});
        }
    return mesh;
}

// ---- Scenes ----

/// Soft bodies and models, in a vacuum and without friction unless a scene says otherwise.
struct Scene {
    double seconds = 5;
    SimulationOptions options{.solver = NewtonOptions{.air_drag = 0},
                              .time_step = 0.025,
                              .gravity = kY * -kGravity,
                              .thickness = 0.01,
                              .friction = 0};
    std::vector<Deformable> bodies{};
    std::vector<TriangleMesh> models{};
    std::vector<Collider> colliders{};
    std::map<std::size_t, std::vector<PoseKey>> keyframes{}; ///< by collider

    void add(const TriangleMesh& model, const RigidTransform& pose) {
        models.push_back(model);
        colliders.push_back({.map = ExactMap::build(model), .pose = pose});
    }
    void add_floor(double height) { add(make_box({10, 0.2, 10}, 8), at({0, height - 0.1, 0})); }

    Simulation start() const {
        Simulation simulation(combine(bodies), colliders, options);
        for (const auto& [collider, keys] : keyframes) simulation.set_collider_keyframes(collider, keys);
        return simulation;
    }
};

/// What has become of the bodies of a scene.
class EndState {
  public:
    EndState(const Scene& scene, const Simulation& simulation) : simulation_(simulation) {
        for (const Deformable& body : scene.bodies) begins_.push_back(begins_.back() + body.particle_count());
    }

    const Simulation& simulation() const { return simulation_; }
    double seconds() const { return simulation_.frame() * simulation_.options().time_step; }
    double speed() const { return simulation_.largest_speed(); }
    std::span<const Vec3f> start(std::size_t body) const {
        return of(body, simulation_.deformable().rest_positions);
    }
    std::span<const Vec3f> end(std::size_t body) const { return of(body, simulation_.positions()); }
    double lowest(std::size_t body) const { return double{std::ranges::min(end(body), {}, &Vec3f::y).y}; }
    /// The displacement of a body on average.
    Vec3d displacement(std::size_t body) const {
        Vec3d sum;
        for (std::size_t i = 0; i < end(body).size(); ++i) sum += Vec3d(end(body)[i]) - Vec3d(start(body)[i]);
        return sum * (1 / static_cast<double>(end(body).size()));
    }
    /// How far a particle of a body is at most from where this displacement takes it.
    double deviation(std::size_t body, const Vec3d& displacement) const {
        double largest = 0;
        for (std::size_t i = 0; i < end(body).size(); ++i)
            largest = std::max(largest, length(Vec3d(end(body)[i]) - Vec3d(start(body)[i]) - displacement));
        return largest;
    }

  private:
    const Simulation& simulation_;
    std::vector<std::size_t> begins_{0};

    std::span<const Vec3f> of(std::size_t body, std::span<const Vec3f> all) const {
        return all.subspan(begins_[body], begins_[body + 1] - begins_[body]);
    }
};

Deformable body(const TetrahedralMesh& mesh, double young_modulus, const RigidTransform& pose) {
    return make_soft_body(mesh, {.young_modulus = young_modulus, .pose = pose});
}

/// The distance from models at which bodies begin that touch them in the set-ups.
constexpr double kGap = 0.0101;

/// Held particles follow keys.
template <typename Holds>
void hold(Deformable& body, std::vector<PoseKey> keys, const Holds& holds) {
    Handle handle{.particles = {}, .keys = std::move(keys)};
    for (std::uint32_t i = 0; i < body.positions.size(); ++i)
        if (holds(body.positions[i])) handle.particles.push_back(i);
    body.handles.push_back(handle);
}

// A vertex, an edge or a face meets another.

/// A soft tetrahedron falls on a rigid one.
Scene falls_on(const TetrahedralMesh& falling, const RigidTransform& pose, const TetrahedralMesh& model,
               const RigidTransform& model_pose) {
    Scene scene{.seconds = 1};
    scene.bodies = {body(divided(divided(falling)), 1e5, pose)};
    scene.add(boundary(model), model_pose);
    return scene;
}

Scene vertex_on_face() {
    return falls_on(pyramid(), turned(kZ, 180, {0, 0.5, 0}), pyramid(), turned(kZ, 180, {0, -0.5, 0}));
}

Scene face_on_vertex() {
    return falls_on(pyramid(), at({0, 0.5, 0}), pyramid(), at({0, -0.5, 0}));
}

Scene edge_on_edge() {
    return falls_on(crossed_edges(), at({0, 0.5, 0}), crossed_edges(), at({0, -0.5, 0}));
}

Scene edge_on_parallel_edge() {
    return falls_on(crossed_edges(), turned(kY, 90, {0, 0.5, 0}), crossed_edges(), at({0, -0.5, 0}));
}

Scene vertex_on_vertex() {
    Scene scene = falls_on(corner(), at({0, 1.1, 0}), corner(), at({0, 0.02, 0}));
    scene.seconds = 3;
    scene.add_floor(0);
    return scene;
}

Scene corner_among_cubes() {
    Scene scene;
    scene.bodies = {make_soft_body(divided(divided(corner())),
                                   {.young_modulus = 1e5, .pose = at({0.03, 0.6, 0.03}), .scale = 0.94})};
    for (const Vec3d& place : {Vec3d{-0.5, 0, 0.5}, Vec3d{0.5, 0, -0.5}, Vec3d{1.5, 0, 0.5}})
        scene.add(make_box({1, 1, 1}), at(place));
    scene.add_floor(-0.5);
    return scene;
}

// Erleben's scenes.

/// A spike or a wedge upside down, its tip at a height.
Deformable pointed(const std::string& name, double tip, SoftBodyOptions options = {.young_modulus = 1e6}) {
    options.pose = turned(kZ, 180, {0, tip + 3, 0});
    return make_soft_body(divided(divided(filled(erleben(name)))), options);
}

Scene point_on(const std::string& falling, const std::string& model) {
    Scene scene{.seconds = 1.25};
    scene.bodies = {pointed(falling, kGap)};
    scene.add(erleben(model), at({0, -3, 0}));
    return scene;
}

Scene cube_on(const std::string& model, double seconds) {
    Scene scene{.seconds = seconds};
    scene.bodies = {body(cube(1, 2), 1e6, at({0, 0.05, 0}))};
    scene.add(erleben(model), at({0, -1, 0}));
    return scene;
}

/// The base of a spike or wedge, which is on top, goes along x.
void lead_by_base(Deformable& body, double speed, double seconds) {
    const float top = std::ranges::max(body.positions, {}, &Vec3f::y).y;
    hold(body, {{0, {}}, {seconds, at(kX * (speed * seconds))}},
         [&](const Vec3f& p) { return p.y > top - 1e-3F; });
}

Scene point_out_of(const std::string& name, const std::string& model, double seconds) {
    Scene scene{.seconds = seconds};
    scene.bodies = {pointed(name, -1 + kGap)};
    lead_by_base(scene.bodies[0], 1, seconds);
    scene.add(erleben(model), at({0, -1, 0}));
    return scene;
}

/// A steel point slides along a plane, closer to it than the thickness.
Scene sliding(const std::string& name, double speed) {
    Scene scene{.seconds = 1};
    scene.bodies = {
        pointed(name, -1 + kGap / 2, {.density = 7750, .young_modulus = 2e11, .poisson_ratio = 0.3})};
    for (Vec3f& p : scene.bodies[0].positions) p.x -= static_cast<float>(0.49 * speed);
    lead_by_base(scene.bodies[0], speed, scene.seconds);
    scene.add_floor(-1);
    return scene;
}

// Friction and stacks.

/// One on the other, whose base is held.
Scene two_cubes() {
    Scene scene{.seconds = 1};
    for (const double height : {0.0, 1.025})
        scene.bodies.push_back(body(cube(1, 4), 5e4, at({0, height, 0})));
    hold(scene.bodies[0], {}, [](const Vec3f& p) { return p.y < -0.499F; });
    return scene;
}

/// Five, which are so soft that the stack buckles under its own weight.
Scene five_cubes() {
    Scene scene;
    for (int i = 0; i < 5; ++i) scene.bodies.push_back(body(cube(0.2, 2), 1e5, at({0, 0.205 * i, 0})));
    scene.add_floor(-0.315);
    return scene;
}

Scene table_on_slope() {
    Scene scene;
    scene.options.friction = 0.15;
    const RigidTransform slope = turned(kZ, -10);
    const auto on_slope = [&](const Vec3d& p) { return RigidTransform{slope.rotation, slope.to_world(p)}; };
    scene.bodies = {body(table(), 1e7, on_slope({-3.5, 0.375 + kGap, 0}))};
    scene.add(make_box({10, 0.2, 10}), on_slope({0, -0.1, 0}));
    return scene;
}

Scene house_of_cards() {
    Scene scene;
    scene.options.friction = 0.9;
    scene.options.thickness = 0.003;
    const auto add_card = [&](double x, double y, double degrees, double width) {
        scene.bodies.push_back(
            body(make_solid_box({width, 0.01, width}, {6, 1, 6}), 1e8, turned(kZ, degrees, {x, y, 0})));
    };
    for (int i = 0; i < 4; ++i) add_card(0.515 * i, 0, i % 2 == 0 ? 60 : -60, 1);
    add_card(0.78, 0.445, 0, 1.1);
    for (int i = 1; i < 3; ++i) add_card(0.515 * i, 0.89, i % 2 == 0 ? -60 : 60, 1);
    for (const Vec3d& place : {Vec3d{0.2, 6, -0.2}, Vec3d{0.5, 9, -0.3}})
        scene.bodies.push_back(body(cube(0.4, 2), 1e8, at(place)));
    scene.add_floor(-0.445);
    return scene;
}

// Knives, pins and twists.

Scene mat_on_knives() {
    Scene scene{.seconds = 4};
    scene.options.time_step = 0.04;
    scene.options.thickness = 0.005;
    scene.bodies = {
        body(make_solid_box({1.2, 0.024, 1.2}, {20, 1, 20}), 2e4, turned(kZ, 0.05, {0.5, 1, 0.1}))};
    for (int i = 1; i < 10; ++i) {
        const TriangleMesh knife{{{0, 0.2F, -0.8F}, {0, 0.2F, 0.8F}, {0, -0.4F, 0}}, {{0, 1, 2}}};
        scene.add(knife, at({0.1 * i, 0, 0.1}));
    }
    return scene;
}

Scene ball_on_pins() {
    Scene scene{.seconds = 4};
    scene.options.time_step = 0.04;
    scene.options.thickness = 0.02;
    scene.bodies = {body(ball(2, 0.6), 1e5, at({4, 4, 4}))};
    scene.add(pins(9), {});
    return scene;
}

/// The ends along x turn against each other.
void twist(Deformable& body) {
    for (const double side : {-1.0, 1.0}) {
        std::vector<PoseKey> keys;
        for (int quarter = 0; quarter < 5; ++quarter)
            keys.push_back({quarter * 1.25, turned(kX, -90 * side * quarter)}); // 0.4 pi per second
        hold(body, keys, [&](const Vec3f& p) { return double{p.x} * side > 0.499; });
    }
}

Scene twisted_mat() {
    Scene scene{.seconds = 4.4};
    scene.options.gravity = {};
    scene.options.time_step = 0.04;
    scene.options.thickness = 0.005;
    scene.bodies = {body(make_solid_box({1, 1, 0.02}, {16, 16, 1}), 2e4, {})};
    twist(scene.bodies[0]);
    return scene;
}

Scene twisted_rods() {
    Scene scene{.seconds = 4.4};
    scene.options.gravity = {};
    scene.options.thickness = 0.005;
    for (const double y : {-0.1, 0.1})
        for (const double z : {-0.1, 0.1}) {
            scene.bodies.push_back(body(make_solid_box({1, 0.1, 0.1}, {12, 2, 2}), 1e4, at({0, y, z})));
            twist(scene.bodies.back());
        }
    return scene;
}

// Impact, a funnel and walls.

Scene ball_shot_at_ball() {
    Scene scene{.seconds = 1};
    scene.options.gravity = {};
    scene.options.time_step = 0.01;
    const TetrahedralMesh mesh = ball(1, 0.4);
    scene.bodies = {make_soft_body(mesh, {.young_modulus = 1e4, .poisson_ratio = 0.45}),
                    make_soft_body(mesh, {.density = 8000,
                                          .young_modulus = 1e7,
                                          .poisson_ratio = 0.3,
                                          .pose = at({-1.6, 0, 0}),
                                          .scale = 0.3})};
    scene.bodies[1].velocities.assign(mesh.vertices.size(), {10, 0, 0});
    return scene;
}

Scene torus_through_funnel() {
    Scene scene{.seconds = 8};
    scene.options.gravity = {};
    scene.options.time_step = 0.04;
    scene.bodies = {body(torus(0.35, 0.1, 0.09), 1e4, at({-0.75, 0, 0}))};
    const float front = std::ranges::max(scene.bodies[0].positions, {}, &Vec3f::x).x;
    hold(scene.bodies[0], {{0, {}}, {8, at({4, 0, 0})}}, [&](const Vec3f& p) { return p.x > front - 0.03F; });
    scene.add(funnel(), {});
    return scene;
}

/// Six walls close from a cube of two metres to one of 0.8 m, and open again.
Scene trash_compactor() {
    Scene scene{.seconds = 1.9};
    scene.options.gravity = {};
    scene.options.time_step = 0.01;
    scene.bodies = {body(ball(0.4, 0.2), 1e4, at({-0.48, 0, 0})),
                    body(make_solid_box({1, 0.04, 1}, {10, 1, 10}), 1e4, turned(kZ, 90, {0.04, 0, 0})),
                    body(torus(0.35, 0.12, 0.12), 1e4, turned(kY, 90, {0.4, 0, 0}))};
    for (const Vec3d& to : {kX, kX * -1, kY, kY * -1, kZ, kZ * -1}) {
        const Vec3d size{to.x != 0 ? 0.1 : 3, to.y != 0 ? 0.1 : 3, to.z != 0 ? 0.1 : 3};
        scene.keyframes[scene.colliders.size()] = {
            {0, at(to * 1.05)}, {0.95, at(to * 0.45)}, {1.9, at(to * 1.05)}};
        scene.add(make_box(size, 4), at(to * 1.05));
    }
    return scene;
}

// ---- What is demanded ----

/// Particles on the surface are finite, and inside of no model.
void expect_all_outside(const Simulation& simulation) {
    for (const Triangle& face : simulation.deformable().faces)
        for (const std::uint32_t particle : face) {
            const Vec3f& p = simulation.positions()[particle];
            ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << particle;
            for (const Collider& collider : simulation.colliders())
                ASSERT_FALSE(contains(collider, p)) << particle << " " << p.x << " " << p.y << " " << p.z;
        }
}

/// Of all frames.
void expect_apart(Simulation& simulation, const Scene& scene) {
    const double frame_count = std::round(scene.seconds / scene.options.time_step);
    while (simulation.frame() < frame_count) {
        simulation.step();
        ASSERT_EQ(test::meeting_faces(simulation, scene.models).size(), 0u)
            << "in frame " << simulation.frame();
        ASSERT_NO_FATAL_FAILURE(expect_all_outside(simulation)) << "in frame " << simulation.frame();
    }
    EXPECT_GT(simulation.profile().contact_count, 0u);
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
}

// The states at the end.

/// In its place but for what it has sunk.
void expect_in_place(const EndState& end, std::size_t body, double sideways) {
    const Vec3d displacement = end.displacement(body);
    EXPECT_LT(std::hypot(displacement.x, displacement.z), sideways) << "body " << body;
}

/// Balanced on a point or an edge it may stay or fall beside it, no faster than freely.
void stays_or_falls_beside(const EndState& end) {
    EXPECT_GT(end.displacement(0).y, -kGravity / 2 * end.seconds() * end.seconds());
}

void stands_on_face(const EndState& end) {
    expect_in_place(end, 0, 0.1);
    EXPECT_GT(end.lowest(0), -0.1);
}

void lies_across_edge(const EndState& end) {
    expect_in_place(end, 0, 0.05);
    EXPECT_GT(end.displacement(0).y, -0.4);
}

void lies_on_floor(const EndState& end) {
    EXPECT_NEAR(end.lowest(0), -0.5, 0.01);
}

void stays_on_top(const EndState& end) {
    expect_in_place(end, 0, 0.5);
    EXPECT_NEAR(end.lowest(0), -0.5, 0.01);
}

/// The point has followed the base.
void is_out(const EndState& end, double metres, double bound) {
    EXPECT_LT(end.deviation(0, kX * metres), bound);
}

/// Out of the crack and past the block, which ends at 1 m; it still swings.
void is_past_block(const EndState& end) {
    for (const Vec3f& p : end.end(0)) EXPECT_GT(p.x, 1);
}

void has_slid(const EndState& end, double metres) {
    EXPECT_LT(end.deviation(0, kX * metres), 1e-3);
}

void lies_on_the_other(const EndState& end) {
    expect_in_place(end, 1, 0.02);
    EXPECT_GT(end.lowest(1), 0.3);
}

/// On the floor, or beyond its border.
void lie_about(const EndState& end) {
    for (const Vec3f& p : end.simulation().positions())
        EXPECT_TRUE(p.y > -0.315F || std::max(std::abs(p.x), std::abs(p.z)) > 5)
            << p.x << " " << p.y << " " << p.z;
}

/// 3.2 m by Coulomb's law from rest.
void slides_down(const EndState& end) {
    EXPECT_NEAR(length(end.displacement(0)), 3.2, 0.4);
}

/// The lower storey bears the cubes that have fallen on it.
void stands_below(const EndState& end) {
    for (std::size_t card = 0; card < 5; ++card) {
        expect_in_place(end, card, 0.05);
        EXPECT_LT(end.deviation(card, end.displacement(card)), 0.05) << "card " << card;
    }
}

void lies_on_knives(const EndState& end) {
    EXPECT_GT(end.displacement(0).y, -0.9);
    EXPECT_LT(end.speed(), 0.5);
}

void lies_on_pins(const EndState& end) {
    expect_in_place(end, 0, 1);
    EXPECT_GT(end.displacement(0).y, -3);
}

/// Both ends, against each other.
void ends_have_turned(const EndState& end) {
    const Deformable& all = end.simulation().deformable();
    for (const Handle& handle : all.handles) {
        const RigidTransform pose = pose_at(handle.keys, end.seconds());
        for (const std::uint32_t i : handle.particles)
            EXPECT_LT(length(Vec3d(all.positions[i]) - pose.to_world(Vec3d(all.rest_positions[i]))), 1e-3)
                << i;
    }
}

/// The larger ball has received momentum from the smaller one, and neither has lost any.
void have_collided(const EndState& end) {
    const Deformable& all = end.simulation().deformable();
    double momentum = 0, mass_of_small = 0, of_small = 0;
    const std::size_t first = end.end(0).size();
    for (std::size_t i = 0; i < all.particle_count(); ++i) {
        const double mass = 1 / double{all.inverse_masses[i]}, part = mass * double{all.velocities[i].x};
        momentum += part;
        if (i < first) continue;
        mass_of_small += mass;
        of_small += part;
    }
    EXPECT_NEAR(momentum, 10 * mass_of_small, 0.1 * mass_of_small);
    EXPECT_LT(of_small, 5 * mass_of_small);
}

void is_through(const EndState& end) {
    for (const Vec3f& p : end.end(0)) EXPECT_GT(p.x, 0.9F);
    EXPECT_LT(end.deviation(0, kX * 4), 0.1); // it has its shape again
}

void are_between_walls(const EndState& end) {
    for (const Vec3f& p : end.simulation().positions())
        EXPECT_LT(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1.0F);
}

struct PublicScene {
    const char* name;
    Scene (*make)();
    void (*expect_end)(const EndState&);

    friend std::ostream& operator<<(std::ostream& out, const PublicScene& scene) { return out << scene.name; }
};

const std::array<PublicScene, 26> kScenes{{
    {"vertex_on_face", vertex_on_face, stands_on_face},
    {"face_on_vertex", face_on_vertex, stays_or_falls_beside},
    {"edge_on_edge", edge_on_edge, lies_across_edge},
    {"edge_on_parallel_edge", edge_on_parallel_edge, stays_or_falls_beside},
    {"vertex_on_vertex", vertex_on_vertex, stays_or_falls_beside},
    {"corner_among_cubes", corner_among_cubes, lies_on_floor},
    {"spike_on_spike", [] { return point_on("spike", "spike"); }, stays_or_falls_beside},
    {"spike_on_wedge", [] { return point_on("spike", "wedge"); }, stays_or_falls_beside},
    {"wedge_on_wedge", [] { return point_on("wedge", "wedge"); }, stays_or_falls_beside},
    {"spike_out_of_crack", [] { return point_out_of("spike", "crack", 5); },
     [](const EndState& end) { is_out(end, 5, 0.2); }},
    {"spike_out_of_hole", [] { return point_out_of("spike", "hole", 5); },
     [](const EndState& end) { is_out(end, 5, 0.2); }},
    {"wedge_out_of_crack", [] { return point_out_of("wedge", "crack", 6); }, is_past_block},
    {"sliding_spike", [] { return sliding("spike", 10); }, [](const EndState& end) { has_slid(end, 10); }},
    {"sliding_wedge", [] { return sliding("wedge", -10); }, [](const EndState& end) { has_slid(end, -10); }},
    {"cube_on_cliff", [] { return cube_on("cliff", 2.5); }, stays_on_top},
    {"two_cubes", two_cubes, lies_on_the_other},
    {"five_cubes", five_cubes, lie_about},
    {"table_on_slope", table_on_slope, slides_down},
    {"house_of_cards", house_of_cards, stands_below},
    {"mat_on_knives", mat_on_knives, lies_on_knives},
    {"ball_on_pins", ball_on_pins, lies_on_pins},
    {"twisted_mat", twisted_mat, ends_have_turned},
    {"twisted_rods", twisted_rods, ends_have_turned},
    {"ball_shot_at_ball", ball_shot_at_ball, have_collided},
    {"torus_through_funnel", torus_through_funnel, is_through},
    {"trash_compactor", trash_compactor, are_between_walls},
}};

class PublicScenes : public testing::TestWithParam<PublicScene> {};

} // namespace

TEST_P(PublicScenes, KeepAllFacesApartAndEndAsTheyShould) {
    const auto begin = std::chrono::steady_clock::now();
    const Scene scene = GetParam().make();
    Simulation simulation = scene.start();
    ASSERT_NO_FATAL_FAILURE(expect_apart(simulation, scene));
    GetParam().expect_end({scene, simulation});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::printf("| %s | %zu | %zu | %u | %.1f |\n", GetParam().name, simulation.positions().size(),
                simulation.deformable().faces.size(), simulation.frame(), seconds.count());
}

INSTANTIATE_TEST_SUITE_P(Of, PublicScenes, testing::ValuesIn(kScenes),
                         [](const auto& run) { return std::string(run.param.name); });
