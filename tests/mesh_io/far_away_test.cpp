// Files whose coordinates floats cannot hold, such as those in the coordinates of a country.

#include "mesh_io/readers.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <sstream>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

class FarAwayFiles : public TemporaryFolderTest {};

/// Written without the library: a cube of 1 x 0.9 x 0.8 in UTM coordinates with two decimals.
const std::vector<std::array<std::string, 3>> kCorners{
    {"448262.25", "5411932.40", "112.30"}, {"448263.25", "5411932.40", "112.30"},
    {"448263.25", "5411933.30", "112.30"}, {"448262.25", "5411933.30", "112.30"},
    {"448262.25", "5411932.40", "113.10"}, {"448263.25", "5411932.40", "113.10"},
    {"448263.25", "5411933.30", "113.10"}, {"448262.25", "5411933.30", "113.10"}};
const std::vector<Triangle> kFaces{{0, 3, 2}, {0, 2, 1}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                   {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};

std::string vertex_lines(const std::string& keyword) {
    std::string text;
    for (const auto& [x, y, z] : kCorners) text += keyword + x + " " + y + " " + z + "\n";
    return text;
}

std::string face_lines(const std::string& keyword, std::uint32_t first) {
    std::string text;
    for (const auto& [a, b, c] : kFaces)
        text += keyword + std::to_string(a + first) + " " + std::to_string(b + first) + " " +
                std::to_string(c + first) + "\n";
    return text;
}

std::string text_stl() {
    std::string text = "solid cube\n";
    for (const Triangle& face : kFaces) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::uint32_t corner : face) {
            const auto& [x, y, z] = kCorners[corner];
            text += "vertex " + x + " " + y + " " + z + "\n";
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid cube\n";
}

template <typename Number>
std::string bytes_of_number(Number number) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    return {bytes.data(), bytes.size()};
}

template <typename Number>
std::string binary_ply(const std::string& type) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty " + type +
                        " x\nproperty " + type + " y\nproperty " + type +
                        " z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& corner : kCorners)
        for (const std::string& word : corner) bytes += bytes_of_number(static_cast<Number>(std::stod(word)));
    for (const Triangle& face : kFaces) {
        bytes += '\3';
        for (const std::uint32_t corner : face) bytes += bytes_of_number(corner);
    }
    return bytes;
}

void expect_same(const TriangleMesh& a, const TriangleMesh& b) {
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.faces, b.faces);
    EXPECT_EQ(a.origin, b.origin);
}

} // namespace

TEST_F(FarAwayFiles, OfEveryFormatThatHoldsTheShapeAreReadInDouble) {
    const std::string counts = "8 12 0\n", ply = "ply\nformat ascii 1.0\nelement vertex 8\n";
    const std::vector<fs::path> files{
        write("cube.obj", vertex_lines("v ") + face_lines("f ", 1)),
        write("cube.off", "OFF\n" + counts + vertex_lines("") + face_lines("3 ", 0)),
        write("cube.ply", ply + "property double x\nproperty double y\nproperty double z\n" +
                              "element face 12\nproperty list uchar int vertex_indices\nend_header\n" +
                              vertex_lines("") + face_lines("3 ", 0)),
        write("binary.ply", binary_ply<double>("double")), write("cube.stl", text_stl())};
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        const TriangleMesh mesh = read_mesh(file);
        const MeshReport report = inspect(mesh);
        EXPECT_TRUE(report.closed);
        EXPECT_EQ(report.vertex_count, 8U);
        EXPECT_NEAR(report.signed_volume, 0.72, 1e-6);
        EXPECT_EQ(report.rounding_step, 0);
        const Vec3d centre = report.bounding_sphere.centre + mesh.origin;
        EXPECT_NEAR(centre.x, 448262.75, 1e-6);
        EXPECT_NEAR(centre.y, 5411932.85, 1e-6);
        EXPECT_NEAR(centre.z, 112.7, 1e-6);
    }
}

TEST_F(FarAwayFiles, ThatHoldFloatsOnlySayByHowMuchTheyRound) {
    const MeshReport report = inspect(read_mesh(write("cube.ply", binary_ply<float>("float"))));
    EXPECT_EQ(report.rounding_step, 0.5);
}

TEST_F(FarAwayFiles, AreWrittenInEveryFormatSoThatTheyReadBackToTheSameMesh) {
    for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl"})
        for (const TriangleMesh& shape : shapes_far_away())
            for (const Vec3d& place : places_far_away()) {
                SCOPED_TRACE(name);
                // STL orders vertices by face.
                const TriangleMesh mesh = weld(local_mesh(positions_at(shape, place), shape.faces));
                write_mesh(path(name), mesh);
                const TriangleMesh read = read_mesh(path(name));
                EXPECT_EQ(read.origin, mesh.origin);
                ASSERT_EQ(read.faces.size(), mesh.faces.size());
                for (std::size_t face = 0; face < mesh.faces.size(); ++face)
                    for (std::size_t corner = 0; corner < 3; ++corner)
                        EXPECT_EQ(read.vertices[read.faces[face][corner]],
                                  mesh.vertices[mesh.faces[face][corner]]);
            }
}

TEST_F(FarAwayFiles, KeepTheirDecimals) {
    const TriangleMesh mesh = read_mesh(write("cube.obj", vertex_lines("v ") + face_lines("f ", 1)));
    write_mesh(path("again.obj"), mesh);
    EXPECT_NE(content_of(path("again.obj")).find("\nv 448263.25 5411932.4 112.3\n"), std::string::npos);
}

TEST_F(FarAwayFiles, KeepTheirEdges) {
    const fs::path file = write("threads.obj", vertex_lines("v ") + "f 1 2 3\nl 3 7\n");
    const MeshAndEdges read = read_mesh_and_edges(file);
    EXPECT_NE(read.mesh.origin, Vec3d{});
    ASSERT_EQ(read.edges.size(), 1U);
    const auto [a, b] = read.edges[0];
    EXPECT_NEAR(length(read.mesh.vertices[a] - read.mesh.vertices[b]), 0.8, 1e-6);
    write_mesh_and_edges(path("again.obj"), read);
    const MeshAndEdges again = read_mesh_and_edges(path("again.obj"));
    expect_same(again.mesh, read.mesh);
    EXPECT_EQ(again.edges, read.edges);
}

TEST_F(FarAwayFiles, OfTetrahedraAreReadInDoubleAndWrittenSoThatTheyReadBack) {
    const TetrahedralMesh box = make_solid_box({1, 0.9, 0.8}, {2, 2, 2});
    for (const Vec3d& place : places_far_away()) {
        std::vector<Vec3d> positions;
        for (const Vec3f& vertex : box.vertices) positions.push_back(Vec3d(vertex) + place);
        const TetrahedralMesh far = local_body(positions, box.tetrahedra);
        EXPECT_NE(far.origin, Vec3d{});
        for (const char* name : {"a.msh", "a.vtk"}) {
            write_tetrahedra(path(name), far);
            const TetrahedraFile file = read_tetrahedra(path(name));
            EXPECT_EQ(file.turned_tetrahedra, 0U);
            EXPECT_EQ(file.mesh.origin, far.origin);
            EXPECT_EQ(file.mesh.vertices, far.vertices);
            EXPECT_EQ(file.mesh.tetrahedra, far.tetrahedra);
        }
        // TetGen's pair, by hand.
        std::ostringstream nodes, elements;
        nodes << std::setprecision(17) << positions.size() << " 3 0 0\n";
        for (std::size_t i = 0; i < positions.size(); ++i)
            nodes << i << ' ' << positions[i].x << ' ' << positions[i].y << ' ' << positions[i].z << '\n';
        elements << box.tetrahedra.size() << " 4 0\n";
        for (std::size_t i = 0; i < box.tetrahedra.size(); ++i) {
            elements << i;
            for (const std::uint32_t corner : box.tetrahedra[i]) elements << ' ' << corner;
            elements << '\n';
        }
        write("a.node", nodes.str());
        const TetrahedralMesh read = read_tetrahedra(write("a.ele", elements.str())).mesh;
        EXPECT_EQ(read.origin, far.origin);
        EXPECT_EQ(read.vertices, far.vertices);
    }
}

TEST_F(FarAwayFiles, AreNoModelsOfVertexCaches) {
    const fs::path file = write("cube.obj", vertex_lines("v ") + face_lines("f ", 1));
    fs::create_directories(path("frames"));
    fs::copy_file(file, path("frames") / "0.obj");
    const std::string words = "is located around (448263, 5.41193e+06, 112.5)";
    expect_error(ErrorCode::InvalidMesh, words,
                 [&] { read_vertex_cache(path("frames"), read_mesh(file), 24); });
    TriangleMesh near = read_mesh(file);
    near.origin = {};
    expect_error(ErrorCode::InvalidMesh, "0.obj: the model " + words,
                 [&] { read_vertex_cache(path("frames"), near, 24); });
}
