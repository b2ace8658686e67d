// Soft bodies, several parts in one simulation, and colliders that move and deform: in C as in C++, bit for
// bit.

#include "handles.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

using namespace echinus;
using namespace echinus::test;

namespace {

const Vec3d kSize{0.4, 0.4, 0.4};
const TriangleMesh kBall = make_sphere(0.3, 16, 8);

TetrahedralMesh block() {
    return make_solid_box(kSize, {2, 2, 2});
}
CTetrahedra c_block() {
    const std::uint32_t segments[3] = {2, 2, 2};
    CTetrahedra body;
    expect_ok(echinus_tetrahedra_box(Numbers(kSize), segments, out(body)));
    return body;
}

SoftBodyOptions body_options() {
    SoftBodyOptions options{.density = 500,
                            .young_modulus = 2e4,
                            .poisson_ratio = 0.3,
                            .damping = 0.01,
                            .scale = 1.1,
                            .pins = {3},
                            .attachments = {{.particle = 5, .collider = 0}}};
    options.pose.translation = {0, 0, 0.6};
    return options;
}

CDeformable c_soft_body() {
    echinus_soft_body_options options;
    echinus_soft_body_options_init(&options, sizeof options);
    const std::uint32_t pins[1] = {3};
    const echinus_attachment attachments[1] = {{.particle = 5, .collider = 0}};
    options.density = 500;
    options.young_modulus = 2e4;
    options.poisson_ratio = 0.3;
    options.damping = 0.01;
    options.scale = 1.1;
    options.pose.translation[2] = 0.6;
    options.pins = pins;
    options.pin_count = 1;
    options.attachments = attachments;
    options.attachment_count = 1;
    CDeformable body;
    expect_ok(echinus_deformable_soft_body(c_block().get(), &options, out(body)));
    return body;
}

CDeformable c_sheet() {
    echinus_cloth_options options;
    echinus_cloth_options_init(&options, sizeof options);
    options.column_count = options.row_count = 8;
    options.pose.translation[2] = 1;
    CDeformable sheet;
    expect_ok(echinus_deformable_cloth(&options, out(sheet)));
    return sheet;
}
Deformable sheet() {
    ClothOptions options{.column_count = 8, .row_count = 8};
    options.pose.translation.z = 1;
    return make_cloth(options);
}

/// The same block over the same ball, in C and in C++.
struct BodyPair {
    BodyPair() : BodyPair(c_soft_body(), make_soft_body(block(), body_options())) {}
    BodyPair(const CDeformable& c_deformable, Deformable deformable)
        : by_cpp(std::move(deformable), {{.map = ExactMap::build(kBall)}}, {}) {
        const CMap map = c_map(c_mesh_of(kBall));
        echinus_simulation_options options;
        echinus_simulation_options_init(&options, sizeof options);
        options.collision = ECHINUS_COLLISION_SURFACES_AND_SELF;
        echinus_collider collider;
        echinus_collider_init(&collider, sizeof collider, map.get());
        expect_ok(echinus_simulation_create(c_deformable.get(), &collider, 1, &options, out(in_c)));
    }

    void expect_same_after(int frame_count) {
        for (int i = 0; i < frame_count; ++i) {
            expect_ok(echinus_simulation_step(in_c.get()));
            by_cpp.step();
        }
        EXPECT_EQ(echinus_simulation_state_hash(in_c.get()), by_cpp.state_hash());
        double force[3], torque[3];
        expect_ok(echinus_simulation_load_on(in_c.get(), 0, force, torque));
        EXPECT_EQ((Vec3d{force[0], force[1], force[2]}), by_cpp.load_on(0).force);
        EXPECT_EQ((Vec3d{torque[0], torque[1], torque[2]}), by_cpp.load_on(0).torque);
    }

    CSimulation in_c;
    Simulation by_cpp;
};

TEST(CSoftBodies, GoOnFromASavedStateWithTheSameBits) {
    BodyPair pair;
    pair.expect_same_after(10);
    CArray state;
    expect_ok(echinus_simulation_save_state(pair.in_c.get(), out(state)));
    const auto bytes = values_of<std::byte>(state);
    EXPECT_TRUE(same_bits(bytes, std::span<const std::byte>(pair.by_cpp.save_state())));
    pair.expect_same_after(10);
    CSimulation again;
    expect_ok(echinus_simulation_restored(pair.in_c.get(), bytes.data(), bytes.size(), out(again)));
    EXPECT_EQ(echinus_simulation_frame(again.get()), 10U);
    for (int i = 0; i < 10; ++i) expect_ok(echinus_simulation_step(again.get()));
    EXPECT_EQ(echinus_simulation_state_hash(again.get()), pair.by_cpp.state_hash());

    expect_refused(echinus_simulation_restored(pair.in_c.get(), bytes.data(), bytes.size() - 1, out(again)),
                   ECHINUS_DAMAGED, "the saved state");
    EXPECT_EQ(again, nullptr);
    pair.expect_same_after(1);
}

TEST(CSoftBodies, GoThroughTheirArraysUnchanged) {
    const Deformable expected = make_soft_body(block(), body_options());
    const CDeformable body = c_soft_body();
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    expect_ok(echinus_deformable_read(body.get(), &arrays));
    ASSERT_EQ(arrays.tetrahedron_count, expected.tetrahedra.size());
    EXPECT_EQ(std::memcmp(arrays.tetrahedra, expected.tetrahedra.data(),
                          expected.tetrahedra.size() * sizeof(ElasticTetrahedron)),
              0);
    CDeformable again;
    expect_ok(echinus_deformable_create(&arrays, out(again)));
    BodyPair(again, expected).expect_same_after(10);
}

TEST(CSoftBodies, AreCombinedWithClothAsInCpp) {
    const Deformable expected[2] = {with_masses_times(0.01, sheet()),
                                    make_soft_body(block(), body_options())};
    CDeformable light, both;
    expect_ok(echinus_deformable_with_masses_times(c_sheet().get(), 0.01, out(light)));
    const CDeformable body = c_soft_body();
    const echinus_deformable* const parts[2] = {light.get(), body.get()};
    expect_ok(echinus_deformable_combine(parts, 2, out(both)));
    BodyPair(both, combine(expected)).expect_same_after(30);
}

TEST(CSoftBodies, PassThroughAColliderAsInCpp) {
    const Deformable expected = passing_through(0, sheet());
    CDeformable through, again;
    expect_ok(echinus_deformable_passing_through(c_sheet().get(), 0, out(through)));
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    expect_ok(echinus_deformable_read(through.get(), &arrays));
    ASSERT_EQ(arrays.filter_count, expected.particle_count());
    EXPECT_EQ(arrays.filters[1].particle, 1U);
    expect_ok(echinus_deformable_create(&arrays, out(again)));
    BodyPair(again, expected).expect_same_after(30);
}

TEST(CSoftBodies, PartsNameTheirOwnParticlesOnly) {
    const float positions[6] = {0, 0, 0, 1, 0, 0};
    const echinus_distance_constraint constraint{
        .a = 0, .b = UINT32_MAX, .rest_length = 1, .kind = ECHINUS_CONSTRAINT_STRUCTURAL, .reserved = {}};
    echinus_deformable_arrays arrays{};
    arrays.size = sizeof arrays;
    arrays.particle_count = 2;
    arrays.positions = positions;
    arrays.constraints = &constraint;
    arrays.constraint_count = 1;
    CDeformable wrong, both;
    expect_ok(echinus_deformable_create(&arrays, out(wrong)));
    const CDeformable right = c_sheet();
    const echinus_deformable* parts[2] = {right.get(), wrong.get()};
    expect_refused(echinus_deformable_combine(parts, 2, out(both)), ECHINUS_INVALID_OPTIONS,
                   "part 1: a distance constraint refers to particle 4294967295 of 2");
    parts[0] = nullptr;
    expect_refused(echinus_deformable_combine(parts, 2, out(both)), ECHINUS_INVALID_ARGUMENT,
                   "a part is NULL");
}

// ---- Colliders

TEST(CColliders, FollowKeyframesAsInCpp) {
    BodyPair pair;
    const echinus_pose_key keys[2] = {
        {.time = 0, .pose = {.rotation = {1, 0, 0, 0}, .translation = {0, 0, 0}}},
        {.time = 0.1, .pose = {.rotation = {0.8, 0.6, 0, 0}, .translation = {0, 0, 0.1}}}};
    const std::vector<PoseKey> expected{{0, {}}, {0.1, {{0.8, 0.6, 0, 0}, {0, 0, 0.1}}}};
    expect_ok(echinus_simulation_set_collider_keyframes(pair.in_c.get(), 0, keys, 2));
    pair.by_cpp.set_collider_keyframes(0, expected);
    pair.expect_same_after(20);

    echinus_pose pose;
    expect_ok(echinus_pose_at(keys, 2, 0.03, &pose));
    const RigidTransform there = pose_at(expected, 0.03);
    EXPECT_EQ(pose.translation[2], there.translation.z);
    EXPECT_EQ(pose.rotation[1], there.rotation.x);
    expect_ok(echinus_simulation_set_collider_keyframes(pair.in_c.get(), 0, nullptr, 0));
    pair.by_cpp.set_collider_keyframes(0, {});
    pair.expect_same_after(3);
}

TEST(CColliders, RefuseKeysThatHaveNoMeaning) {
    BodyPair pair;
    echinus_pose_key keys[2] = {{.time = 1, .pose = {.rotation = {1, 0, 0, 0}, .translation = {}}},
                                {.time = 1, .pose = {.rotation = {1, 0, 0, 0}, .translation = {}}}};
    const auto set = [&](std::size_t index, std::size_t count) {
        return echinus_simulation_set_collider_keyframes(pair.in_c.get(), index, keys, count);
    };
    echinus_pose pose;
    expect_refused(set(0, 2), ECHINUS_INVALID_OPTIONS, "keyframe 1");
    expect_refused(echinus_pose_at(keys, 2, 0, &pose), ECHINUS_INVALID_ARGUMENT, "key 1");
    expect_refused(echinus_pose_at(keys, 0, 0, &pose), ECHINUS_INVALID_ARGUMENT, "there is no key");
    keys[0].pose.rotation[0] = 2;
    expect_refused(set(0, 1), ECHINUS_INVALID_OPTIONS, "a quaternion of length 2");
    pair.expect_same_after(3);
}

std::vector<Vec3f> grown(float factor) {
    std::vector<Vec3f> vertices = kBall.vertices;
    for (Vec3f& v : vertices) v = v * factor;
    return vertices;
}

TEST(CColliders, DeformAsInCpp) {
    BodyPair pair;
    echinus_collider before{};
    before.size = sizeof before;
    for (const float factor : {1.02F, 1.04F, 1.06F}) {
        const std::vector<Vec3f> vertices = grown(factor);
        expect_ok(echinus_simulation_set_collider_vertices(pair.in_c.get(), 0, &vertices.data()->x,
                                                           vertices.size(), 0));
        pair.by_cpp.set_collider_vertices(0, vertices);
        pair.expect_same_after(2);
    }
    // A reading then gives the collider as it is: a point that only the larger ball has.
    expect_ok(echinus_simulation_read_collider(pair.in_c.get(), 0, &before));
    const float point[3] = {0, 0, -0.31F};
    std::uint8_t inside = 0;
    expect_ok(echinus_collider_contains(&before, point, 1, 0, 1, &inside));
    EXPECT_EQ(inside, 1);

    pair.expect_same_after(2);
}

TEST(CColliders, FollowAVertexCacheAsInCpp) {
    std::vector<Vec3f> samples;
    for (const float factor : {1.0F, 1.1F, 1.0F})
        for (const Vec3f& v : grown(factor)) samples.push_back(v);
    CVertexCache cache;
    expect_ok(echinus_vertex_cache_create(&samples.data()->x, 3, kBall.vertices.size(), 0, 0.05, out(cache)));
    const VertexCache expected{.start_time = 0,
                               .sample_seconds = 0.05,
                               .vertex_count = kBall.vertices.size(),
                               .samples = std::make_shared<const std::vector<Vec3f>>(samples)};
    echinus_vertex_cache_info info{};
    info.size = sizeof info;
    expect_ok(echinus_vertex_cache_describe(cache.get(), &info));
    EXPECT_EQ(info.sample_count, 3U);
    EXPECT_EQ(info.vertex_count, kBall.vertices.size());
    EXPECT_EQ(info.sample_seconds, 0.05);
    EXPECT_EQ(std::memcmp(info.samples, samples.data(), samples.size() * sizeof(Vec3f)), 0);
    std::vector<Vec3f> there(kBall.vertices.size());
    expect_ok(echinus_vertex_cache_at(cache.get(), 0.03, &there.data()->x));
    EXPECT_EQ(there, vertices_at(expected, 0.03));

    BodyPair pair;
    expect_ok(echinus_simulation_set_collider_cache(pair.in_c.get(), 0, cache.get()));
    cache.reset();
    pair.by_cpp.set_collider_cache(0, expected);
    pair.expect_same_after(20);
}

TEST(CVertexCaches, ThatHaveNoMeaningAreRefused) {
    const float samples[6] = {};
    CVertexCache cache;
    const auto create = [&](std::size_t sample_count, std::size_t vertex_count, double start, double step) {
        return echinus_vertex_cache_create(samples, sample_count, vertex_count, start, step, out(cache));
    };
    expect_ok(create(2, 1, 0, 1));
    BodyPair pair;
    expect_refused(echinus_simulation_set_collider_cache(pair.in_c.get(), 0, cache.get()),
                   ECHINUS_INVALID_OPTIONS, "vert");
    expect_refused(create(0, 1, 0, 1), ECHINUS_INVALID_ARGUMENT, "samples");
    expect_refused(create(1, 0, 0, 1), ECHINUS_INVALID_ARGUMENT, "samples");
    for (const double step : {0.0, -1.0, HUGE_VAL})
        expect_refused(create(1, 1, 0, step), ECHINUS_INVALID_ARGUMENT, "sample_seconds");
    EXPECT_EQ(cache, nullptr);
}

// ---- Files and scenes

class CSoftBodyScenes : public TemporaryFolderTest {
  protected:
    void SetUp() override {
        TemporaryFolderTest::SetUp();
        write_mesh(path("ball.obj"), kBall);
        std::filesystem::create_directories(path("cache"));
        for (const int number : {0, 1, 2})
            write_mesh(path("cache/" + std::to_string(number) + ".obj"),
                       {grown(1 + 0.05F * static_cast<float>(number)), kBall.faces});
    }
};

TEST_F(CSoftBodyScenes, AreReadWithTheirFiles) {
    const CMesh ball = c_mesh_of(kBall);
    CVertexCache cache;
    expect_ok(echinus_vertex_cache_read(path("cache").string().c_str(), ball.get(), 24, out(cache)));
    std::vector<Vec3f> last(kBall.vertices.size());
    expect_ok(echinus_vertex_cache_at(cache.get(), 9, &last.data()->x));
    EXPECT_EQ(last, grown(1.1F));
    expect_refused(echinus_vertex_cache_read(path("cache").string().c_str(), c_torus().get(), 24, out(cache)),
                   ECHINUS_INVALID_MESH, "cache");
    expect_refused(echinus_vertex_cache_read(path("cache").string().c_str(), ball.get(), 0, out(cache)),
                   ECHINUS_INVALID_ARGUMENT, "frames_per_second");

    expect_ok(echinus_tetrahedra_write(c_block().get(), path("block.msh").string().c_str()));
    const std::string scene_text =
        R"({"colliders": [{"model": {"box": {"size": [4, 4, 1]}}, "position": [0, 0, -2]},
            {"model": "ball.obj", "cache": "cache"}],
        "cloth": {"size": [1, 1], "particles": [8, 8], "position": [0, 0, 1.2], "density": 0.2},
        "bodies": [{"mesh": "block.msh", "position": [0, 0, 0.6]},
            {"mesh": "ball.obj", "element": 0.2, "position": [1, 0, 0]}]})";
    CScene scene;
    CSimulation simulation;
    expect_ok(echinus_scene_read(write("scene.json", scene_text).string().c_str(), out(scene)));
    expect_ok(echinus_simulation_from_scene(scene.get(), nullptr, 0, 1, out(simulation)));
    EXPECT_EQ(echinus_simulation_collider_count(simulation.get()), 2U);
    EXPECT_GT(echinus_simulation_particle_count(simulation.get()), 64U + 27);
    for (int i = 0; i < 24; ++i) expect_ok(echinus_simulation_step(simulation.get()));
    // Led by the cache, for a tenth of a second.
    echinus_collider collider{};
    collider.size = sizeof collider;
    expect_ok(echinus_simulation_read_collider(simulation.get(), 1, &collider));
    const float point[3] = {0, 0, -0.32F};
    std::uint8_t inside = 0;
    expect_ok(echinus_collider_contains(&collider, point, 1, 0, 1, &inside));
    EXPECT_EQ(inside, 1);
}

} // namespace
