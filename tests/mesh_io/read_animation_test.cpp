#include "mesh_io/gltf_text.hpp"
#include "mesh_io/point_cache.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

const fs::path kModels = "/usr/share/assimp/models"; // of Debian's assimp-testmodels

/// A bar of two boxes' height along y whose upper half a second bone, at (0, 1, 0), leads. The middle ring
/// has half of its weight on either bone.
struct Bar {
    std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 1,
                                 0, 0, 1, 1, 0, 2, 0, 1, 2, 0, 0, 2, 1};
    std::vector<float> weights; ///< 4 of each vertex
    std::vector<float> times{0, 1, 2};
    std::vector<float> rotations; ///< x, y, z, w of the upper bone: a turn about z
    std::string mesh_node = R"({"mesh":0,"skin":0})";
    std::string skins = R"("skins":[{"joints":[1,2],"inverseBindMatrices":3}],)";
    std::string path = "rotation";
    std::string animations; ///< in place of the one above
    std::map<std::string, std::string> replacements;
    std::function<void(GltfText&)> add; ///< accessors from number 7 on

    Bar() {
        for (int vertex = 0; vertex < 9; ++vertex) {
            const float upper = vertex < 3 ? 0.0F : vertex < 6 ? 0.5F : 1.0F;
            for (const float weight : {1 - upper, upper, 0.0F, 0.0F}) weights.push_back(weight);
        }
        for (const double angle : {0.0, 0.5, 2.0})
            for (const double component : {0.0, 0.0, std::sin(angle / 2), std::cos(angle / 2)})
                rotations.push_back(static_cast<float>(component));
    }

    std::string text() const {
        GltfText file;
        std::vector<std::uint16_t> joints, indices;
        for (int vertex = 0; vertex < 9; ++vertex)
            for (const std::uint16_t joint : {0, 1, 0, 0}) joints.push_back(joint);
        for (const std::uint16_t ring : {0, 3})
            for (std::uint16_t i = 0; i < 3; ++i)
                for (const int corner : {ring + i, ring + (i + 1) % 3, ring + 3 + i})
                    indices.push_back(static_cast<std::uint16_t>(corner));
        std::vector<float> inverse_binds(32);
        for (const std::size_t i : {0, 5, 10, 15, 16, 21, 26, 31}) inverse_binds[i] = 1;
        inverse_binds[29] = -1; // the second bone is at y = 1
        file.add(positions, 3);
        file.add(joints, 4);
        file.add(weights, 4);
        file.add(inverse_binds, 16);
        file.add(times);
        file.add(rotations, path == "rotation" ? 4 : path == "weights" ? 1 : 3);
        file.add(indices);
        if (add) add(file);
        const std::string one =
            R"({"name":"bend","samplers":[{"input":4,"output":5}],"channels":[{"sampler":0,)"
            R"("target":{"node":2,"path":")" +
            path + R"("}}]})";
        file.scenes = R"([{"nodes":[0,1]}])";
        file.nodes =
            "[" + mesh_node + R"(,{"name":"lower","children":[2]},{"name":"upper","translation":[0,1,0]}])";
        file.meshes =
            R"([{"name":"bar","primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2},)"
            R"("indices":6}]}])";
        file.more = R"(,"scene":0,)" + skins + R"("animations":[)" +
                    (animations.empty()    ? one
                     : animations == "two" ? one + "," + one
                                           : "") +
                    "]";
        std::string json = file.text();
        for (const auto& [from, to] : replacements) json.replace(json.find(from), from.size(), to);
        return json;
    }
};

/// Where skinning by the sum of weights leads a vertex of the bar, when the upper bone is turned by an angle.
Vec3d bent(const Vec3f& p, double upper_weight, double angle) {
    const Vec3d rest{p.x, p.y, p.z};
    const Vec3d turned = Rotation::about({0, 0, 1}, angle).apply(rest - Vec3d{0, 1, 0}) + Vec3d{0, 1, 0};
    return rest * (1 - upper_weight) + turned * upper_weight;
}

class ReadAnimation : public TemporaryFolderTest {
  protected:
    VertexCache read(const Bar& bar, double frames_per_second = 4, const std::string& animation = {}) const {
        const fs::path file = write("bar.gltf", bar.text());
        return read_vertex_cache(file, read_mesh(file), frames_per_second, animation);
    }
    void expect_refused(ErrorCode code, const std::string& words, const Bar& bar) const {
        expect_error(code, path("bar.gltf").string() + ": ", [&] { read(bar); });
        expect_error(code, words, [&] { read(bar); });
    }
};

} // namespace

TEST_F(ReadAnimation, ASkinOfTwoBonesBendsAsTheSumOfItsWeightsSays) {
    const VertexCache cache = read({});
    const TriangleMesh mesh = read_mesh(path("bar.gltf"));
    ASSERT_EQ(mesh.vertices.size(), 9U);
    EXPECT_EQ(cache.sample_count(), 9U);
    EXPECT_NEAR(cache.end_time(), 2, 1e-12);
    for (const double time : {0.0, 0.25, 1.0, 1.5, 2.0}) {
        const double angle = time <= 1 ? 0.5 * time : 0.5 + 1.5 * (time - 1);
        const std::vector<Vec3f> vertices = vertices_at(cache, time);
        for (std::size_t i = 0; i < 9; ++i) {
            const Vec3d expected = bent(mesh.vertices[i], mesh.vertices[i].y / 2, angle);
            EXPECT_NEAR(length(Vec3d(vertices[i]) - expected), 0, 1e-6) << "vertex " << i << " at " << time;
        }
    }
}

TEST_F(ReadAnimation, TheVerticesAreThoseOfReadMeshAlsoWhereSomeAreEqualOrUnused) {
    Bar bar;
    for (const std::size_t k : {0U, 1U, 2U})
        bar.positions[9 + k] = bar.positions[k]; // one place, two vertices
    const VertexCache cache = read(bar);
    const TriangleMesh mesh = read_mesh(path("bar.gltf"));
    ASSERT_EQ(mesh.vertices.size(), 8U);
    ASSERT_EQ(cache.vertex_count, 8U);
    EXPECT_EQ(vertices_at(cache, 0), mesh.vertices);
}

TEST_F(ReadAnimation, AMeshWithoutBonesMovesWithItsNode) {
    Bar bar;
    bar.skins = "";
    bar.mesh_node = R"({"name":"other"})";
    bar.replacements[R"("name":"upper",)"] = R"("name":"upper","mesh":0,)";
    bar.path = "translation";
    bar.rotations = {0, 1, 0, 0, 1, 3, 2, 1, 3};
    const VertexCache cache = read(bar, 2);
    const TriangleMesh mesh = read_mesh(path("bar.gltf"));
    EXPECT_EQ(vertices_at(cache, 0), mesh.vertices);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(vertices_at(cache, 0.5)[i], mesh.vertices[i] + Vec3f(0, 0, 1.5F));
        EXPECT_EQ(vertices_at(cache, 9)[i], mesh.vertices[i] + Vec3f(2, 0, 3));
    }
}

TEST_F(ReadAnimation, OfSeveralAnimationsOneIsNamed) {
    Bar bar;
    bar.animations = "two";
    bar.replacements[R"(},{"name":"bend")"] = R"(},{"name":"other")";
    expect_error(ErrorCode::InvalidMesh, "has 2 animations; say which: 'bend', 'other'", [&] { read(bar); });
    expect_error(ErrorCode::InvalidMesh, "no animation 'third'", [&] { read(bar, 4, "third"); });
    EXPECT_EQ(read(bar, 4, "other").sample_count(), 9U);
}

TEST_F(ReadAnimation, WhatCannotBeFollowedIsRefusedWithItsReason) {
    const auto with = [](auto&& change) {
        Bar bar;
        change(bar);
        return bar;
    };
    expect_refused(ErrorCode::InvalidMesh, "keys out of order: of the rotations of the node 'upper', key 2",
                   with([](Bar& bar) {
                       bar.times = {0, 2, 1};
                   }));
    expect_refused(ErrorCode::InvalidMesh, "key 1 of the rotations of the node 'upper' is not finite",
                   with([](Bar& bar) { bar.rotations[4] = std::numeric_limits<float>::quiet_NaN(); }));
    expect_refused(ErrorCode::InvalidMesh, "key 0 of the rotations of the node 'upper' is not finite",
                   with([](Bar& bar) { bar.times[0] = -std::numeric_limits<float>::infinity(); }));
    expect_refused(ErrorCode::InvalidMesh, "the animation moves no vertex", with([](Bar& bar) {
                       bar.skins = "";
                       bar.mesh_node = R"({"mesh":0})";
                   }));
    expect_refused(ErrorCode::InvalidMesh, "the file has no animation; export it with one",
                   with([](Bar& bar) { bar.animations = "none"; }));
    expect_refused(ErrorCode::InvalidMesh, "vertex 4 of meshes[0] ('bar') has no bone",
                   with([](Bar& bar) { bar.weights[16] = bar.weights[17] = 0; }));
    expect_refused(ErrorCode::InvalidMesh, "has a channel with 3 values for 2 keys", with([](Bar& bar) {
                       bar.times = {0, 1};
                   }));
    expect_refused(ErrorCode::InvalidMesh, "WEIGHTS_0 has 8 entries, but needs 9",
                   with([](Bar& bar) { bar.weights.resize(32); }));
    expect_refused(ErrorCode::InvalidMesh, "skins[0].inverseBindMatrices has 2 entries, but needs 3",
                   with([](Bar& bar) { bar.replacements["[1,2]"] = "[1,2,0]"; }));
    expect_refused(ErrorCode::InvalidMesh, "nodes[2] is animated and has a matrix", with([](Bar& bar) {
                       bar.replacements[R"("translation":[0,1,0])"] =
                           R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,1,0,1])";
                   }));
    expect_refused(ErrorCode::InvalidMesh, "animations[0] has two channels for the same thing",
                   with([](Bar& bar) {
                       bar.replacements[R"("channels":[)"] =
                           R"("channels":[{"sampler":0,"target":{"node":2,"path":"rotation"}},)";
                   }));
}

TEST_F(ReadAnimation, WeightsMayBeWholeNumbersInSeveralSetsAndBindMatricesMayBeMissing) {
    const VertexCache expected = read({});
    // The same bar: its upper bone in a second set, weights in bytes, and bones bound at the origin to a mesh
    // that stands there, too.
    Bar bar;
    bar.skins = R"("skins":[{"joints":[1,2]}],)";
    bar.replacements[R"("JOINTS_0":1,"WEIGHTS_0":2)"] =
        R"("JOINTS_0":7,"WEIGHTS_0":8,"JOINTS_1":9,"WEIGHTS_1":10)";
    bar.replacements[R"("translation":[0,1,0])"] = R"("translation":[0,0,0])";
    bar.add = [](GltfText& file) {
        std::vector<std::uint8_t> first, first_weights, second, second_weights;
        for (int vertex = 0; vertex < 9; ++vertex) {
            const int upper = vertex < 3 ? 0 : vertex < 6 ? 100 : 200; // of 200: sums are made to be 1
            for (int k = 0; k < 4; ++k) {
                first.push_back(0);
                first_weights.push_back(static_cast<std::uint8_t>(k == 2 ? 200 - upper : 0));
                second.push_back(static_cast<std::uint8_t>(k == 1 ? 1 : 0));
                second_weights.push_back(static_cast<std::uint8_t>(k == 1 ? upper : 0));
            }
        }
        file.add(first, 4);
        file.add(first_weights, 4, R"(,"normalized":true)");
        file.add(second, 4);
        file.add(second_weights, 4, R"(,"normalized":true)");
    };
    const VertexCache cache = read(bar);
    const std::vector<Vec3f> rest = vertices_at(cache, 0), end = vertices_at(cache, 2);
    EXPECT_EQ(rest, vertices_at(expected, 0));
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const Vec3d p(rest[i]), turned = Rotation::about({0, 0, 1}, 2).apply(p);
        const double upper = i < 3 ? 0 : i < 6 ? 0.5 : 1;
        EXPECT_NEAR(length(Vec3d(end[i]) - p * (1 - upper) - turned * upper), 0, 1e-6);
    }
}

TEST_F(ReadAnimation, MorphsGoFromWeightToWeightAndRestAtThoseOfTheMesh) {
    Bar bar;
    bar.skins = "";
    bar.path = "weights";
    bar.rotations = {0, 1, 0.5F}; // the weights at 0, 1 and 2 s
    bar.mesh_node = R"({"name":"other"})";
    bar.replacements[R"("name":"upper",)"] = R"("name":"upper","mesh":0,)";
    bar.replacements[R"("indices":6)"] = R"("targets":[{"POSITION":7}],"indices":6)";
    bar.replacements[R"({"name":"bar")"] = R"({"weights":[0.25],"name":"bar")";
    bar.add = [](GltfText& file) {
        std::vector<float> up;
        for (int vertex = 0; vertex < 9; ++vertex) up.insert(up.end(), {0, 0, 4});
        file.add(up, 3);
    };
    const VertexCache cache = read(bar);
    const std::vector<Vec3f> rest = read_mesh(path("bar.gltf")).vertices; // raised by 1
    for (const auto& [time, weight] :
         {std::pair{0.0, 0.0F}, {0.5, 0.5F}, {1.0, 1.0F}, {1.5, 0.75F}, {2.0, 0.5F}})
        for (std::size_t i = 0; i < rest.size(); ++i)
            EXPECT_EQ(vertices_at(cache, time)[i], rest[i] + Vec3f(0, 0, 4 * weight - 1)) << time;
}

TEST_F(ReadAnimation, OfAnotherModelOrOfTooManyPositionsIsRefused) {
    const fs::path file = write("bar.gltf", Bar().text());
    expect_error(ErrorCode::InvalidMesh, "bar.gltf: has other faces than the model: 6 of 9 vertices", [&] {
        read_vertex_cache(file, make_box({1, 1, 1}, 1), 24);
    });
    expect_error(ErrorCode::InvalidMesh, "at most 268435456 positions are kept",
                 [&] { read_vertex_cache(file, read_mesh(file), 1e8); });
}

TEST_F(ReadAnimation, SpoiltBytesAreRefusedOrGiveAWholeCache) {
    const std::string whole = Bar().text();
    const TriangleMesh mesh = read_mesh(write("bar.gltf", whole));
    std::mt19937 random(1);
    std::size_t taken = 0;
    for (int round = 0; round < 300; ++round) {
        std::string spoilt = whole;
        for (unsigned i = 0, count = 1 + random() % 3; i < count; ++i) {
            char& c = spoilt[random() % spoilt.size()];
            c = c >= '0' && c <= '9' ? static_cast<char>('0' + random() % 10) : static_cast<char>(random());
        }
        const fs::path file = write("spoilt.gltf", spoilt);
        try {
            const VertexCache cache = read_vertex_cache(file, mesh, 4);
            EXPECT_EQ(cache.samples->size(), cache.sample_count() * mesh.vertices.size());
            ++taken;
        } catch (const Error& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ": ")) << error.what();
        }
    }
    EXPECT_GT(taken, 0U);
}

TEST_F(ReadAnimation, TheSampleModelsMove) {
    const fs::path skin = kModels / "glTF2/simple_skin/simple_skin.gltf";
    const fs::path morph = kModels / "glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf";
    if (!fs::exists(skin) || !fs::exists(morph))
        GTEST_SKIP() << "Debian's assimp-testmodels is not installed";
    for (const fs::path& file : {skin, morph}) {
        SCOPED_TRACE(file);
        const TriangleMesh mesh = read_mesh(file);
        const VertexCache cache = read_vertex_cache(file, mesh, 30);
        EXPECT_EQ(cache.vertex_count, mesh.vertices.size());
        EXPECT_GT(cache.sample_count(), 60U);
        EXPECT_NE(vertices_at(cache, 1), vertices_at(cache, 0));
    }
}

namespace {

TriangleMesh ball(float radius) {
    return make_sphere(double{radius}, 12, 6);
}

class VertexCacheFiles : public TemporaryFolderTest {
  protected:
    /// A ball that grows, in three samples.
    std::filesystem::path write_pc2(std::size_t point_count, std::uint32_t frames_per_sample) {
        const std::filesystem::path file = path("grow.pc2");
        PointCacheWriter writer(file, point_count, frames_per_sample);
        for (const float radius : {1.0F, 1.5F, 3.0F}) {
            std::vector<Vec3f> points = ball(radius).vertices;
            points.resize(point_count);
            writer.add(points);
        }
        writer.commit();
        return file;
    }

    TriangleMesh mesh_ = ball(1);
};

} // namespace

TEST_F(VertexCacheFiles, APointCacheHasItsSamplesAtItsFrames) {
    const VertexCache cache = read_vertex_cache(write_pc2(mesh_.vertices.size(), 2), mesh_, 30);
    EXPECT_EQ(cache.sample_count(), 3u);
    EXPECT_TRUE(cache.name.ends_with(".pc2"));
    EXPECT_NEAR(cache.end_time(), 4.0 / 30, 1e-12);
    EXPECT_EQ(vertices_at(cache, 0), mesh_.vertices);
    EXPECT_EQ(vertices_at(cache, 1), ball(3).vertices);
    const std::vector<Vec3f> between = vertices_at(cache, 3.0 / 30);
    for (std::size_t i = 0; i < between.size(); ++i)
        EXPECT_NEAR(length(between[i] - mesh_.vertices[i] * 2.25F), 0, 1e-5);
}

TEST_F(VertexCacheFiles, APointCacheThatIsShortenedIsRefusedWhereItEnds) {
    const std::filesystem::path file = write_pc2(mesh_.vertices.size(), 1);
    const PointCacheReader reader(file);
    std::filesystem::resize_file(file, 32 + 2 * sizeof(Vec3f) * mesh_.vertices.size());
    EXPECT_EQ(reader.positions(1), ball(1.5F).vertices);
    expect_error(ErrorCode::Damaged, "grow.pc2: was shortened while it was read: sample 2",
                 [&] { reader.positions(2); });
}

TEST_F(VertexCacheFiles, AFolderHasOneMeshForEachFrameByName) {
    const std::filesystem::path folder = path("frames");
    std::filesystem::create_directory(folder);
    write_mesh(folder / "f_0002.obj", ball(3));
    write_mesh(folder / "f_0000.obj", ball(1));
    write_mesh(folder / "f_0001.obj", ball(2));
    const VertexCache cache = read_vertex_cache(folder, mesh_, 24);
    EXPECT_EQ(cache.sample_count(), 3u);
    EXPECT_NEAR(cache.end_time(), 2.0 / 24, 1e-12);
    EXPECT_EQ(vertices_at(cache, 1.0 / 24), ball(2).vertices);

    write_mesh(folder / "f_0003.obj", make_sphere(1, 12, 7));
    expect_error(ErrorCode::InvalidMesh, "f_0003.obj: has other faces than the model",
                 [&] { read_vertex_cache(folder, mesh_, 24); });
    std::filesystem::create_directory(path("none"));
    expect_error(ErrorCode::InvalidMesh, "has no OBJ files",
                 [&] { read_vertex_cache(path("none"), mesh_, 24); });
}

TEST_F(VertexCacheFiles, OfAnotherMeshAreRefused) {
    const std::string count = std::to_string(mesh_.vertices.size());
    expect_error(ErrorCode::InvalidMesh, "has 7 points, but the model has " + count + " vertices",
                 [&] { read_vertex_cache(write_pc2(7, 1), mesh_, 24); });
    expect_error(ErrorCode::Unreadable, "nothing.pc2",
                 [&] { read_vertex_cache(path("nothing.pc2"), mesh_, 24); });
}
