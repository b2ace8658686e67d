// Colliders whose vertices move. Every frame is judged exactly, against the mesh as it is then.

#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/instruction_sets.hpp"
#include "support/kinds_of_simulations.hpp"
#include "support/meshes.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr double kSheetThickness = 0.01;
constexpr double kPi = std::numbers::pi;

SimulationOptions surfaces(bool self = false) {
    return {.solver =
                NewtonOptions{.collision = self ? CollisionMode::SurfacesAndSelf : CollisionMode::Surfaces},
            .thickness = kSheetThickness};
}

/// Where a point of the mesh is at a time.
using DeformationOverTime = std::function<Vec3d(const Vec3d& point, double seconds)>;

TriangleMesh deformed(TriangleMesh mesh, const DeformationOverTime& deform, double seconds) {
    for (Vec3f& v : mesh.vertices) v = Vec3f(deform(Vec3d(v), seconds));
    return mesh;
}

Vec3d breathe(const Vec3d& p, double t) {
    return p * (1 + 0.3 * std::sin(2 * kPi * t));
}
/// About the y axis, more the farther along x.
Vec3d bend(const Vec3d& p, double t) {
    const double angle = 0.9 * std::sin(3 * kPi * t) * p.x;
    return {p.x * std::cos(angle) + p.z * std::sin(angle), p.y,
            p.z * std::cos(angle) - p.x * std::sin(angle)};
}
/// A wave that runs along x.
Vec3d wave(const Vec3d& p, double t) {
    return p + Vec3d{0, 0, 0.06 * std::sin(4 * p.x - 6 * t) - 0.06 * std::sin(4 * p.x)};
}
/// Tops slide over bottoms.
Vec3d shear(const Vec3d& p, double t) {
    return p + Vec3d{0.4 * t * (p.z + 0.05), 0, 0};
}

/// Leads the collider's vertices along, and judges every frame. @return the most pairs in a frame
std::size_t most_pairs(Simulation& simulation, const TriangleMesh& model, const DeformationOverTime& deform,
                       int frame_count) {
    const double dt = simulation.options().time_step;
    std::size_t most = 0;
    for (int i = 1; i <= frame_count; ++i) {
        const TriangleMesh now = deformed(model, deform, i * dt);
        simulation.set_collider_vertices(0, now.vertices);
        simulation.step();
        most = std::max(most, meeting_faces(simulation, {now}).size());
    }
    return most;
}

void expect_nothing_meets_while(const TriangleMesh& model, const DeformationOverTime& deform,
                                Deformable sheet, int frame_count, Collider collider,
                                const SimulationOptions& options) {
    Simulation simulation(std::move(sheet), {std::move(collider)}, options);
    EXPECT_EQ(most_pairs(simulation, model, deform, frame_count), 0u);
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
    EXPECT_EQ(simulation.profile().lost_count, 0u);
    EXPECT_GT(simulation.profile().contact_count, 100u);
    EXPECT_LT(simulation.residual().largest, 0.1); // beside corners that are held
}

void expect_nothing_meets_while(const TriangleMesh& model, const DeformationOverTime& deform,
                                Deformable sheet, int frame_count,
                                const SimulationOptions& options = surfaces()) {
    expect_nothing_meets_while(model, deform, std::move(sheet), frame_count, {.map = ExactMap::build(model)},
                               options);
}

} // namespace

TEST(DeformingCollider, KeepsASheetOffABallThatBreathes) {
    expect_nothing_meets_while(make_sphere(0.4, 24, 12), breathe, sheet_at(0.43, 1.2, 15), 60);
    expect_nothing_meets_while(make_sphere(0.4, 24, 12), breathe, sheet_at(0.43, 1.2, 15), 60,
                               surfaces(true));
}

TEST(DeformingCollider, KeepsASheetOffAPlateThatBends) {
    expect_nothing_meets_while(make_box({1.4, 0.5, 0.06}, 10), bend, sheet_at(0.06, 1, 13), 50);
    expect_nothing_meets_while(make_box({1.4, 0.5, 0.06}, 10), bend, sheet_at(0.06, 1, 13), 50,
                               surfaces(true));
}

TEST(DeformingCollider, KeepsASheetOnAFloorWithRunningWaves) {
    expect_nothing_meets_while(make_box({1.6, 1.2, 0.1}, 16), wave, sheet_at(0.08, 0.9, 19), 50,
                               surfaces(true));
}

TEST(DeformingCollider, KeepsAPinnedSheetOffABallThatGrowsIntoIt) {
    Deformable sheet = sheet_at(0.45, 1, 17);
    for (const std::size_t corner : {0u, 16u, 272u, 288u}) sheet.inverse_masses[corner] = 0;
    expect_nothing_meets_while(
        make_sphere(0.4, 24, 12), [](const Vec3d& p, double t) { return p * (1 + std::min(t, 0.5)); }, sheet,
        60);
}

TEST(DeformingCollider, MayMoveAndBeScaledMeanwhile) {
    const TriangleMesh ball = make_sphere(1, 24, 12);
    Collider collider{.map = ExactMap::build(ball), .pose = {Rotation::about({1, 0, 0}, 0.3), {0, 0, -0.1}}};
    collider.scale = {0.4, -0.5, 0.35};
    collider.linear_velocity = {0.2, 0, 0.1};
    collider.angular_velocity = {0, 0, 3};
    expect_nothing_meets_while(ball, breathe, sheet_at(0.4, 1.2, 19), 40, collider, surfaces());
}

/// Ten thicknesses and more in a frame, which part of the body is beside: it is led as a whole.
TEST(DeformingCollider, LeadsABodyAsAPoseDoesWhenAllVerticesJump) {
    const TriangleMesh ball = make_sphere(0.3, 30, 20);
    const Deformable body =
        make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {4, 4, 4}),
                       {.young_modulus = 1e4, .damping = 0.02, .pose = {{}, {0, 0, 0.41}}});
    SimulationOptions options = surfaces(true);
    options.gravity = {0, 0, 0};
    const auto jump = [](const Vec3d& p, double t) { return p + Vec3d{0, 0, t > 0.04 ? 0.1 : 0}; };
    const auto grow = [](const Vec3d& p, double t) { return p * (t > 0.04 ? 1.3 : 1.0); };
    for (const DeformationOverTime& deform : {DeformationOverTime(jump), DeformationOverTime(grow)}) {
        Simulation simulation(body, colliders_of({ball}), options);
        EXPECT_EQ(most_pairs(simulation, ball, deform, 9), 0u);
        EXPECT_EQ(simulation.profile().unresolved_count, 0u);
        EXPECT_EQ(simulation.profile().lost_count, 0u);
        Simulation cloth(sheet_at(0.31, 1, 17), colliders_of({ball}), surfaces(true));
        EXPECT_EQ(most_pairs(cloth, ball, deform, 9), 0u);
        EXPECT_EQ(cloth.profile().unresolved_count, 0u);
    }
}

TEST(DeformingCollider, TakesASheetAlongByFriction) {
    // The top of the box goes at 0.4 * 0.1 units per second; so does what lies on it.
    const TriangleMesh box = make_box({1.6, 1.6, 0.1}, 4);
    Simulation simulation(sheet_at(0.061, 0.6, 13), {{.map = ExactMap::build(box)}}, surfaces());
    EXPECT_EQ(most_pairs(simulation, box, shear, 120), 0u);
    double way = 0;
    for (const Vec3f& p : simulation.positions()) way += double{p.x};
    EXPECT_NEAR(way / double(simulation.positions().size()), 2 * 0.4 * 0.1, 0.004);
}

TEST(DeformingCollider, LeadsAttachedParticlesBesideTheirFaces) {
    const TriangleMesh box = make_box({1, 1, 1}, 2);
    Deformable sheet = sheet_at(0.6, 0.5, 6);
    std::vector<std::uint32_t> attached;
    for (std::uint32_t i = 0; i < 36; ++i) {
        sheet.inverse_masses[i] = 0;
        sheet.attachments.push_back({i, 0});
    }
    // The whole box turns about x and rises: attached particles do the same, and turn with the pose.
    const auto turn = [](const Vec3d& p, double t) {
        return Rotation::about({1, 0, 0}, t).apply(p) + Vec3d{0, 0, t};
    };
    Simulation simulation(sheet, {{.map = ExactMap::build(box), .angular_velocity = {0, 0, 1}}}, surfaces());
    const double dt = simulation.options().time_step;
    for (int i = 1; i <= 60; ++i) {
        simulation.set_collider_vertices(0, deformed(box, turn, i * dt).vertices);
        simulation.step();
        for (std::size_t p = 0; p < 36; ++p) {
            const Vec3d expected =
                Rotation::about({0, 0, 1}, i * dt).apply(turn(Vec3d(sheet.positions[p]), i * dt));
            ASSERT_NEAR(length(Vec3d(simulation.positions()[p]) - expected), 0, 2e-5) << i;
        }
    }
}

TEST(DeformingCollider, DoesNotLeadWhatIsAttachedToItIntoItself) {
    // A plate folds up along its middle, and with it the sheet above: there its halves would pass each other.
    const TriangleMesh plate = make_box({1.4, 0.5, 0.06}, 10);
    const auto fold = [](const Vec3d& p, double t) {
        const double angle = p.x > 1e-6 ? 1.2 * t : p.x < -1e-6 ? -1.2 * t : 0;
        return Vec3d{p.x * std::cos(angle) - p.z * std::sin(angle), p.y,
                     p.z * std::cos(angle) + p.x * std::sin(angle)};
    };
    Deformable sheet = sheet_at(0.1, 0.9, 13);
    for (std::uint32_t i = 0; i < sheet.particle_count(); ++i) {
        sheet.inverse_masses[i] = 0;
        sheet.attachments.push_back({i, 0});
    }
    Simulation simulation(sheet, {{.map = ExactMap::build(plate)}}, surfaces(true));
    EXPECT_EQ(most_pairs(simulation, plate, fold, 55), 0u);
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
    const double seconds = 55 * simulation.options().time_step;
    std::size_t behind = 0;
    for (std::size_t i = 0; i < sheet.particle_count(); ++i) {
        const Vec3d led = fold(Vec3d(sheet.positions[i]), seconds);
        const double missed = length(Vec3d(simulation.positions()[i]) - led);
        behind += missed > 0.01 ? 1 : 0;
        if (std::abs(sheet.positions[i].x) > 0.3F) EXPECT_LT(missed, 1e-4) << i;
    }
    EXPECT_GT(behind, 0u);
}

TEST(DeformingCollider, PlaysACacheAndRestsNotBeforeItsEnd) {
    const TriangleMesh ball = make_sphere(0.4, 24, 12);
    constexpr int kSamples = 13;
    auto samples = std::make_shared<std::vector<Vec3f>>();
    for (int i = 0; i < kSamples; ++i) {
        const TriangleMesh now = deformed(ball, breathe, i / 24.0);
        samples->insert(samples->end(), now.vertices.begin(), now.vertices.end());
    }
    const VertexCache cache{
        .sample_seconds = 1.0 / 24, .vertex_count = ball.vertices.size(), .samples = samples};
    Simulation played(sheet_at(0.43, 1, 15), {{.map = ExactMap::build(ball)}}, surfaces());
    Simulation led = played;
    played.set_collider_cache(0, cache);
    for (int i = 1; i <= 32; ++i) {
        const TriangleMesh now{vertices_at(cache, i / 60.0), ball.faces};
        led.set_collider_vertices(0, now.vertices);
        led.step();
        played.step();
        ASSERT_EQ(played.state_hash(), led.state_hash()) << i;
        ASSERT_TRUE(meeting_faces(played, {now}).empty()) << i;
        const std::uint64_t expected = ExactMap::build(now).source_hash();
        ASSERT_EQ(std::get<ExactMap>(played.colliders()[0].map.kind).source_hash(), expected);
    }
    // Half way between two samples.
    const std::vector<Vec3f> between = vertices_at(cache, 1.5 / 24);
    const std::size_t n = ball.vertices.size();
    for (std::size_t i = 0; i < n; ++i)
        EXPECT_NEAR(length(between[i] - ((*samples)[n + i] + (*samples)[2 * n + i]) * 0.5F), 0, 1e-6);
}

TEST(DeformingCollider, IsTheSameInACopyAndUnderEveryInstructionSet) {
    const TriangleMesh ball = make_sphere(0.4, 24, 12);
    std::vector<std::uint64_t> hashes;
    const auto run = [&](std::string_view) {
        Simulation simulation(sheet_at(0.43, 1, 15), {{.map = ExactMap::build(ball)}}, surfaces(true));
        most_pairs(simulation, ball, breathe, 15);
        auto copy = std::make_unique<Simulation>(simulation);
        Simulation second = *copy;
        copy.reset();
        for (Simulation* each : {&simulation, &second}) {
            most_pairs(*each, ball, bend, 10);
            hashes.push_back(each->state_hash());
        }
    };
    run("");
    under_each_instruction_set(run);
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(DeformingCollider, DoesNotHoldBackWhatFliesPastIt) {
    // Farther in a frame than lists reach, and too near for the particles' clearances to say that it is far.
    const TriangleMesh ball = make_sphere(0.4, 24, 12);
    const auto tremble = [](const Vec3d& p, double t) { return p * (1 + 0.02 * std::sin(20 * t)); };
    SimulationOptions options = surfaces();
    options.gravity = {};
    options.newton().air_drag = 0;
    const Deformable sheet = sheet_at(0.5, 1.2, 19);
    Simulation simulation(sheet, {{.map = ExactMap::build(ball)}}, options);
    for (std::size_t i = 0; i < sheet.particle_count(); ++i) simulation.set_particle_velocity(i, {12, 0, 0});
    EXPECT_EQ(most_pairs(simulation, ball, tremble, 5), 0u);
    EXPECT_EQ(simulation.profile().truncated_count, 0u);
    for (std::size_t i = 0; i < sheet.particle_count(); ++i)
        EXPECT_NEAR(simulation.deformable().positions[i].x, sheet.positions[i].x + 1, 1e-4);
}

TEST(DeformingCollider, CountsWhatItLeavesNoRoom) {
    // A pinned sheet between the jaws of a comb that shut.
    const TriangleMesh jaws = [] {
        TriangleMesh both = make_box({1, 1, 0.2}, 4);
        const auto count = static_cast<std::uint32_t>(both.vertices.size());
        TriangleMesh upper = both;
        for (Vec3f& v : both.vertices) v.z -= 0.2F;
        for (const Vec3f& v : upper.vertices) both.vertices.push_back(v + Vec3f{0, 0, 0.2F});
        for (const auto& [a, b, c] : upper.faces) both.faces.push_back({a + count, b + count, c + count});
        return both;
    }();
    const auto shut = [](const Vec3d& p, double t) { return p + Vec3d{0, 0, p.z > 0 ? -0.4 * t : 0.4 * t}; };
    Simulation simulation(sheet_at(0, 0.5, 8), {{.map = ExactMap::build(jaws)}}, surfaces());
    const double dt = simulation.options().time_step;
    for (int i = 1; i <= 30 && simulation.profile().unresolved_count == 0; ++i) {
        simulation.set_collider_vertices(0, deformed(jaws, shut, i * dt).vertices);
        simulation.step();
    }
    EXPECT_GT(simulation.profile().unresolved_count, 0u);
}

TEST(DeformingCollider, ThatDeformsToNothingIsNamedWithItsCacheAndTheFrame) {
    const TriangleMesh ball = make_sphere(0.4, 12, 6);
    const std::size_t n = ball.vertices.size();
    const std::vector<Vec3f> one_point(n, Vec3f{0.1F, 0.2F, 0.3F});
    const auto samples = std::make_shared<std::vector<Vec3f>>(ball.vertices);
    samples->insert(samples->end(), one_point.begin(), one_point.end());
    for (const unsigned thread_count : {1u, 2u}) { // a second one builds the maps of frames to come
        SimulationOptions options = surfaces();
        options.thread_count = thread_count;
        Simulation simulation(sheet_at(1, 1, 5), {{.map = ExactMap::build(ball), .name = "the ball"}},
                              options);
        expect_error(ErrorCode::InvalidMesh,
                     "the ball, with the vertices that it was given: all vertices of the mesh",
                     [&] { simulation.set_collider_vertices(0, one_point); });
        simulation.set_collider_cache(
            0, {.sample_seconds = 2.0 / 60, .vertex_count = n, .samples = samples, .name = "walk.pc2"});
        simulation.step();
        expect_error(
            ErrorCode::InvalidMesh,
            "in frame 2: the ball, with the vertices of its vertex cache walk.pc2 at 0.0333333 s: all",
            [&] { simulation.step(); });
    }
}

TEST(DeformingCollider, LeavesAllAsItWasWhereTheMapOfAnotherCannotBeBuilt) {
    KindOfSimulation kind = sheet_on_deforming_balls();
    kind.begin = [](Simulation& s) {
        for (const std::size_t c : {0u, 1u}) s.set_collider_cache(c, breathing_cache());
    };
    for (Vec3f& place : kind.deformable.positions) place.z -= 0.03F;
    VertexCache collapsed = breathing_cache();
    collapsed.samples = std::make_shared<const std::vector<Vec3f>>(collapsed.samples->size());
    for (const unsigned thread_count : {1u, 2u}) {
        Simulation control = kind.make(thread_count), simulation = kind.make(thread_count);
        for (int i = 1; i <= 20; ++i) {
            if (i == 12) {
                const std::vector<std::byte> before = simulation.save_state();
                simulation.set_collider_cache(1, collapsed);
                for (int attempt = 0; attempt < 2; ++attempt)
                    expect_error(ErrorCode::InvalidMesh, "in frame 12: collider 1",
                                 [&] { simulation.step(); });
                simulation.set_collider_cache(1, breathing_cache());
                EXPECT_EQ(simulation.save_state(), before);
            }
            control.step();
            simulation.step();
            ASSERT_EQ(simulation.state_hash(), control.state_hash()) << i;
            const TriangleMesh ball{vertices_at(breathing_cache(), i / 60.0), breathing_ball(0).faces};
            ASSERT_TRUE(meeting_faces(simulation, {ball, ball}).empty()) << i;
        }
        EXPECT_EQ(simulation.save_state(), control.save_state());
        EXPECT_GT(simulation.profile().contact_count, 100u);
    }
}

TEST(DeformingCollider, DoesNotBeginToDeformByWhatIsRefused) {
    const KindOfSimulation kind = sheet_on_deforming_balls();
    Simulation simulation(kind.deformable, kind.colliders, kind.options);
    const std::vector<std::byte> before = simulation.save_state();
    const std::vector<Vec3f> one_point(breathing_cache().vertex_count);
    expect_error(ErrorCode::InvalidMesh, "all vertices",
                 [&] { simulation.set_collider_vertices(0, one_point); });
    expect_error(ErrorCode::InvalidOptions, "no samples", [&] {
        simulation.set_collider_cache(0, {.vertex_count = one_point.size(), .samples = {}});
    });
    EXPECT_EQ(simulation.save_state(), before);
}

TEST(DeformingCollider, RefusesOtherTopologiesAndKeepsWhatItHas) {
    const TriangleMesh ball = make_sphere(0.4, 12, 6);
    Simulation simulation(sheet_at(1, 1, 5), {{.map = ExactMap::build(ball)}}, surfaces());
    const auto refuse = [](const std::string& words, const auto& call) {
        expect_error(ErrorCode::InvalidOptions, words, call);
    };
    const std::string count = std::to_string(ball.vertices.size());
    std::vector<Vec3f> places = ball.vertices;
    places.pop_back();
    refuse("collider 0 has " + count + " vertices, and was given positions for " +
               std::to_string(ball.vertices.size() - 1),
           [&] { simulation.set_collider_vertices(0, places); });
    places = ball.vertices;
    places[3].y = std::numeric_limits<float>::quiet_NaN();
    refuse("the position of vertex 3 is not finite", [&] { simulation.set_collider_vertices(0, places); });
    const auto samples = std::make_shared<std::vector<Vec3f>>(ball.vertices);
    refuse("a cache must belong to the same mesh",
           [&] { simulation.set_collider_cache(0, {.vertex_count = 7, .samples = samples}); });
    refuse("a positive time apart", [&] {
        simulation.set_collider_cache(
            0, {.sample_seconds = 0, .vertex_count = ball.vertices.size(), .samples = samples});
    });
    refuse("has no samples",
           [&] { simulation.set_collider_cache(0, {.vertex_count = ball.vertices.size(), .samples = {}}); });
    const auto bad = std::make_shared<std::vector<Vec3f>>(places);
    refuse("vertex 3 of its vertex cache is not finite in sample 0",
           [&] { simulation.set_collider_cache(0, {.vertex_count = ball.vertices.size(), .samples = bad}); });
    (*bad)[3].y = 1e20F;
    refuse("vertex 3 of its vertex cache is farther than 1e15 from the origin in sample 0",
           [&] { simulation.set_collider_cache(0, {.vertex_count = ball.vertices.size(), .samples = bad}); });
    simulation.step();

    Simulation particles(sheet_at(1, 1, 5), {{.map = ExactMap::build(ball)}}, jakobsen());
    refuse("jakobsen", [&] { particles.set_collider_vertices(0, ball.vertices); });
    ColliderMap with_surface(DistanceMap::build(ball));
    with_surface.surface = ExactMap::build(ball);
    Simulation distances(sheet_at(1, 1, 5), {{.map = with_surface}}, surfaces());
    refuse("has no exact map", [&] { distances.set_collider_vertices(0, ball.vertices); });
}
