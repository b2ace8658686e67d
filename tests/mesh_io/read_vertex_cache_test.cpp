#include "mesh_io/point_cache.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::test;

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
