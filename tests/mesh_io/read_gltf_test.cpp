#include "mesh_io/exported_files.hpp"
#include "mesh_io/gltf_text.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

constexpr ExportedKind kGlb{"glb2", ".glb"};
constexpr ExportedKind kGltf{"gltf2", ".gltf"};

const TriangleMesh kBoxInGltf = make_box({1, 2, 3}, 2);

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), with);
}

/// A file of the box in one node.
GltfText box_file(const std::string& more_of_primitive = "", const std::string& more_attributes = "") {
    GltfText file;
    file.meshes =
        R"([{"primitives":[{)" + file.add_mesh(kBoxInGltf, more_attributes) + more_of_primitive + "}]}]";
    return file;
}

std::vector<float> flat(const std::vector<Vec3f>& vertices) {
    std::vector<float> numbers;
    for (const Vec3f& p : vertices) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    return numbers;
}

/// The tetrahedron with corners at the origin and on the axes, of volume 1/6.
const std::vector<Vec3f> kTriangleCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<std::uint32_t> kTriangleFaces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

template <typename Index>
GltfText tetrahedron(Index last_corner = 3) {
    std::vector<Index> corners(kTriangleFaces.begin(), kTriangleFaces.end());
    corners.back() = last_corner;
    GltfText file;
    const std::string positions = std::to_string(file.add(flat(kTriangleCorners), 3));
    file.meshes = R"([{"primitives":[{"attributes":{"POSITION":)" + positions + R"(},"indices":)" +
                  std::to_string(file.add(corners)) + "}]}]";
    return file;
}

std::vector<GltfText> tetrahedra(std::uint8_t last_corner) {
    return {tetrahedron<std::uint8_t>(last_corner), tetrahedron<std::uint16_t>(last_corner),
            tetrahedron<std::uint32_t>(last_corner)};
}

class ReadGltf : public TemporaryFolderTest {
  protected:
    TriangleMesh read(const GltfText& file) const { return read_mesh(write("a.gltf", file.text())); }

    std::string exported(const ExportedKind& kind) const {
        const fs::path file = path(std::string("exported") + kind.ending);
        export_with_assimp(file, kBoxInGltf, kind);
        return content_of(file);
    }

    void expect_refused(ErrorCode code, const std::string& words, const std::string& name,
                        const std::string& content) const {
        const fs::path file = write(name, content);
        expect_error(code, file.string() + ": ", [&] { read_mesh(file); });
        expect_error(code, words, [&] { read_mesh(file); });
    }
    void expect_refused(ErrorCode code, const std::string& words, const GltfText& file) const {
        expect_refused(code, words, "a.gltf", file.text());
    }
};

} // namespace

// ---- Nodes and scenes ----

TEST_F(ReadGltf, AppliesTheTransformsOfNodes) {
    if (!can_export()) GTEST_SKIP() << kCannotExport;
    // Turned by a quarter about z, twice as large along x, and moved.
    const Placement placement{0, -1, 0, 10, 2, 0, 0, 20, 0, 0, 1, 30};
    TriangleMesh expected = kBoxInGltf;
    for (Vec3f& p : expected.vertices) p = {10 - p.y, 20 + 2 * p.x, 30 + p.z};
    for (const ExportedKind& kind : {kGlb, kGltf}) {
        const fs::path file = path(std::string("placed") + kind.ending);
        export_with_assimp(file, kBoxInGltf, kind, placement);
        expect_same_faces(read_mesh(file), expected);
    }
}

TEST_F(ReadGltf, ComposesTranslationRotationAndScaleDownTheTree) {
    GltfText file = box_file();
    file.nodes = R"([{"translation":[10,20,30],"children":[1]},)"
                 R"({"rotation":[0,0,0.70710678118654752,0.70710678118654752],"scale":[2,1,1],"mesh":0}])";
    TriangleMesh expected = kBoxInGltf;
    for (Vec3f& p : expected.vertices) p = {10 - p.y, 20 + 2 * p.x, 30 + p.z};
    expect_same_faces(read(file), expected, 1e-6);
}

TEST_F(ReadGltf, KeepsFacesOutwardUnderAMirroringTransform) {
    if (!can_export()) GTEST_SKIP() << kCannotExport;
    const Placement mirror{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    export_with_assimp(path("mirror.glb"), kBoxInGltf, kGlb, mirror);
    const MeshReport report = inspect(read_mesh(path("mirror.glb")));
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(report.signed_volume, 6, 1e-6);
}

TEST_F(ReadGltf, ShowsTheSceneThatTheFileNames) {
    GltfText file = box_file();
    file.nodes = R"([{"mesh":0},{"mesh":0,"translation":[9,0,0]},{"mesh":0,"translation":[0,9,0]}])";
    file.scenes = R"([{"nodes":[0]},{"nodes":[2,1]}])";
    expect_same_faces(read(file), kBoxInGltf); // the first, where none is named
    file.more = R"(,"scene":1)";
    expect_same_faces(read(file),
                      joined({translated(kBoxInGltf, {0, 9, 0}), translated(kBoxInGltf, {9, 0, 0})}));
    file.more = "";
    file.scenes = "[]"; // all of them
    EXPECT_EQ(read(file).faces.size(), 3 * kBoxInGltf.faces.size());
}

TEST_F(ReadGltf, ReadsAChainOfAHundredThousandNodes) {
    GltfText file = box_file();
    file.nodes = "[";
    constexpr int kLength = 100'000;
    for (int i = 1; i < kLength; ++i)
        file.nodes +=
            R"({"translation":[1,0,0],"childre\u006e":[)" + std::to_string(i) + "]},"; // of any spelling
    file.nodes += R"({"mesh":0}])";
    expect_same_faces(read(file), translated(kBoxInGltf, {kLength - 1, 0, 0}), 0.01);
}

TEST_F(ReadGltf, RefusesNodesThatFormNoTree) {
    GltfText file = box_file();
    const auto expect_no_tree = [&](const std::string& nodes, const std::string& scene) {
        file.nodes = nodes;
        file.scenes = R"([{"nodes":)" + scene + "}]";
        expect_refused(ErrorCode::InvalidMesh, "has two parents, or is its own ancestor", file);
    };
    expect_no_tree(R"([{"mesh":0,"children":[1]},{"children":[0]}])", "[0]");
    expect_no_tree(R"([{"mesh":0,"children":[0]}])", "[0]");
    expect_no_tree(R"([{"children":[2]},{"children":[2]},{"mesh":0}])", "[0,1]");
    expect_no_tree(R"([{"mesh":0}])", "[0,0]");
    file.nodes = R"([{"mesh":0,"children":[7]}])";
    expect_refused(ErrorCode::InvalidMesh, "nodes[0].children[0] is 7, but there are 1 nodes", file);
    file.nodes = R"([{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0.5,0,0,0,1]}])";
    expect_refused(ErrorCode::InvalidMesh, "nodes[0].matrix has a last row other than 0 0 0 1", file);
}

// ---- Skins, morphs, copies ----

namespace {

/// The box under two bones, both with a part in each vertex.
/// @param bones  nodes 1 and 2
GltfText skinned_box(const std::string& mesh_node, const std::string& bones, const std::string& skin) {
    GltfText file;
    std::vector<std::uint8_t> joints, weights;
    for (std::size_t i = 0; i < kBoxInGltf.vertices.size(); ++i) {
        const auto upper = static_cast<std::uint8_t>(i % 256);
        for (const int joint : {0, 1, 0, 0}) joints.push_back(static_cast<std::uint8_t>(joint));
        for (const int weight : {255 - upper, int{upper}, 0, 0})
            weights.push_back(static_cast<std::uint8_t>(weight));
    }
    const std::string attributes = R"(,"JOINTS_0":)" + std::to_string(file.add(joints, 4)) +
                                   R"(,"WEIGHTS_0":)" +
                                   std::to_string(file.add(weights, 4, R"(,"normalized":true)"));
    file.meshes = R"([{"primitives":[{)" + file.add_mesh(kBoxInGltf, attributes) + "}]}]";
    file.nodes = "[" + mesh_node + "," + bones + "]";
    file.scenes = R"([{"nodes":[0,1]}])";
    file.more = R"(,"skins":[)" + skin + "]";
    return file;
}

} // namespace

TEST_F(ReadGltf, BonesLeadASkinAndNotTheNodeOfItsMesh) {
    const std::string mesh_node = R"({"mesh":0,"skin":0,"scale":[100,100,100],"translation":[9,9,9]})";
    expect_same_faces(read(skinned_box(mesh_node, R"({"children":[2]},{})", R"({"joints":[1,2]})")),
                      kBoxInGltf);
    TriangleMesh larger = kBoxInGltf;
    for (Vec3f& p : larger.vertices) p = {2 * p.x + 1, 2 * p.y, 2 * p.z};
    expect_same_faces(
        read(skinned_box(mesh_node, R"({"children":[2],"scale":[2,2,2],"translation":[1,0,0]},{})",
                         R"({"joints":[1,2]})")),
        larger, 1e-6);
    // Each vertex between where one bone leads it and where the other does.
    const TriangleMesh parted =
        read(skinned_box(mesh_node, R"({"children":[2]},{"translation":[0,0,10]})", R"({"joints":[1,2]})"));
    TriangleMesh expected = kBoxInGltf;
    for (std::size_t i = 0; i < expected.vertices.size(); ++i)
        expected.vertices[i].z += 10 * static_cast<float>(i) / 255;
    expect_same_faces(parted, expected, 1e-5);
}

TEST_F(ReadGltf, BonesThatStandWhereTheyWereBoundLeaveVerticesAsTheyAreInTheFile) {
    // The inverse of a turn about z and a move by numbers that floats round, as exporters write it.
    GltfText file =
        skinned_box(R"({"mesh":0,"skin":0})",
                    R"({"children":[2],"translation":[0.1,0.7,-3.3],"rotation":[0,0,0.19866933,0.98006658]},)"
                    R"({"translation":[0.3,1.9,0.7]})",
                    R"({"joints":[1,2],"inverseBindMatrices":MATRICES})");
    const double c = std::cos(0.4), s = std::sin(0.4);
    std::vector<float> matrices;
    for (const Vec3d& origin : {Vec3d{0, 0, 0}, Vec3d{0.3, 1.9, 0.7}}) {
        const Vec3d translated = Vec3d{-0.1 * c - 0.7 * s, 0.1 * s - 0.7 * c, 3.3} - origin;
        for (const double number : {c, -s, 0.0, 0.0, s, c, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, translated.x,
                                    translated.y, translated.z, 1.0})
            matrices.push_back(static_cast<float>(number));
    }
    const std::size_t accessor = file.add(matrices, 16);
    file.more = replaced(file.more, "MATRICES", std::to_string(accessor));
    expect_same_faces(read(file), kBoxInGltf);
    EXPECT_TRUE(inspect(read(file)).closed);
}

TEST_F(ReadGltf, ASkinUnderAMirroredSkeletonKeepsItsFacesOutward) {
    const TriangleMesh mesh = read(skinned_box(
        R"({"mesh":0,"skin":0})", R"({"children":[2],"scale":[-1,1,1]},{})", R"({"joints":[1,2]})"));
    EXPECT_TRUE(inspect(mesh).closed);
    EXPECT_NEAR(inspect(mesh).signed_volume, 6, 1e-6);
}

TEST_F(ReadGltf, RefusesASkinThatDoesNotFitItsMesh) {
    const std::string node = R"({"mesh":0,"skin":0})", bones = R"({"children":[2]},{})";
    expect_refused(ErrorCode::InvalidMesh, "has 1 joints, but meshes[0] refers to joint 1, numbered from 0",
                   skinned_box(node, bones, R"({"joints":[1]})"));
    expect_refused(ErrorCode::InvalidMesh, "skins[0].joints[1] is 9, but there are 3 nodes",
                   skinned_box(node, bones, R"({"joints":[1,9]})"));
    GltfText alone = box_file("", R"(,"JOINTS_0":0)");
    expect_refused(ErrorCode::InvalidMesh, "has no WEIGHTS_0 beside it", alone);
}

TEST_F(ReadGltf, MorphsByTheWeightsOfTheMeshOrThoseOfTheNode) {
    GltfText file;
    std::vector<Vec3f> up(kBoxInGltf.vertices.size(), Vec3f{0, 0, 2}), along;
    for (const Vec3f& p : kBoxInGltf.vertices) along.push_back({p.x, 0, 0});
    const std::string primitive = file.add_mesh(kBoxInGltf);
    file.meshes = R"([{"weights":[0.5,0],"primitives":[{)" + primitive + R"(,"targets":[{"POSITION":)" +
                  std::to_string(file.add(flat(up), 3)) + R"(},{"POSITION":)" +
                  std::to_string(file.add(flat(along), 3)) + "}]}]}]";
    expect_same_faces(read(file), translated(kBoxInGltf, {0, 0, 1}));
    file.nodes = R"([{"mesh":0,"weights":[0,1]}])";
    TriangleMesh wide = kBoxInGltf;
    for (Vec3f& p : wide.vertices) p.x *= 2;
    expect_same_faces(read(file), wide);
    file.nodes = R"([{"mesh":0,"weights":[1]}])";
    expect_refused(ErrorCode::InvalidMesh, "nodes[0].weights has 1 weights for 2 morph targets", file);
}

TEST_F(ReadGltf, CopiesAMeshForEachOfItsInstances) {
    GltfText file = box_file();
    const std::string positions =
        std::to_string(file.add(std::vector<float>{0, 0, 0, 10, 0, 0, 0, 10, 0}, 3));
    const std::string scales = std::to_string(file.add(std::vector<float>{1, 1, 1, -1, 1, 1, 2, 2, 2}, 3));
    file.nodes = R"([{"mesh":0,"translation":[0,0,5],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":)"
                 R"({"TRANSLATION":)" +
                 positions + R"(,"SCALE":)" + scales + "}}}}]";
    file.more = R"(,"extensionsRequired":["EXT_mesh_gpu_instancing"])";
    const TriangleMesh mesh = read(file);
    EXPECT_EQ(mesh.faces.size(), 3 * kBoxInGltf.faces.size());
    EXPECT_TRUE(inspect(mesh).closed);
    EXPECT_NEAR(inspect(mesh).signed_volume, 6 + 6 + 6 * 8, 1e-4);
    EXPECT_EQ(inspect(mesh).component_count, 3U);
}

// ---- Accessors ----

TEST_F(ReadGltf, TakesIndicesOfEveryTypeFromEveryKindOfBuffer) {
    for (const GltfText& file : tetrahedra(3)) {
        SCOPED_TRACE(file.accessors);
        write("beside.bin", file.binary);
        for (const auto& [name, content] :
             {std::pair{"a.gltf", file.json(R"("uri":"beside.bin")")}, std::pair{"a.gltf", file.text()},
              std::pair{"a.glb", file.glb()}, std::pair{"a.glb", file.glb(false)}}) {
            const MeshReport report = inspect(read_mesh(write(name, content)));
            EXPECT_TRUE(report.closed);
            EXPECT_NEAR(report.signed_volume, 1.0 / 6, 1e-9);
        }
    }
}

TEST_F(ReadGltf, ReadsAGlbFileWhosePaddingIsNotCountedOrIsOfZeros) {
    const GltfText file = tetrahedron<std::uint16_t>();
    std::string glb = file.glb();
    const std::size_t json_length = file.json("").size();
    const std::string padding((4 - json_length % 4) % 4, '\0');
    ASSERT_FALSE(padding.empty());
    for (std::size_t i = 0; i < padding.size(); ++i) glb[20 + json_length + i] = '\0';
    EXPECT_EQ(read_mesh(write("zeros.glb", glb)).faces.size(), 4U);
    const std::string length = bytes_of(static_cast<std::uint32_t>(json_length));
    EXPECT_EQ(read_mesh(write("short.glb", glb.replace(12, 4, length))).faces.size(), 4U);
}

TEST_F(ReadGltf, FindsBuffersWhoseNamesAreWrittenWithPercentSigns) {
    const GltfText file = tetrahedron<std::uint16_t>();
    write("my b\xC3\xA4r.bin", file.binary);
    EXPECT_EQ(read_mesh(write("a.gltf", file.json(R"("uri":"my%20b%C3%a4r.bin")"))).faces.size(), 4U);
    EXPECT_EQ(read_mesh(write("a.gltf", file.json("\"uri\":\"my b\xC3\xA4r.bin\""))).faces.size(), 4U);
    write("50%41.bin", file.binary); // a name that looks written so
    EXPECT_EQ(read_mesh(write("a.gltf", file.json(R"("uri":"50%41.bin")"))).faces.size(), 4U);
}

TEST_F(ReadGltf, TakesDataThatArePercentEncoded) {
    const GltfText file = tetrahedron<std::uint8_t>();
    std::string data;
    for (const char byte : file.binary) {
        const auto value = static_cast<unsigned char>(byte);
        data += std::string("%") + "0123456789abcdef"[value >> 4U] + "0123456789ABCDEF"[value & 15U];
    }
    EXPECT_EQ(read_mesh(write("a.gltf", file.json(R"("uri":"data:,)" + data + "\""))).faces.size(), 4U);
}

TEST_F(ReadGltf, ReadsFromSeveralBuffers) {
    const std::string positions = bytes_of(flat(kTriangleCorners)), corners = bytes_of(kTriangleFaces);
    write("positions.bin", positions);
    write("corners.bin", "skip" + corners + "and more");
    const auto length = [](const std::string& bytes) { return std::to_string(bytes.size()); };
    const fs::path file = write(
        "a.gltf",
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":)"
        R"([{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,)"
        R"("count":4,"type":"VEC3"},{"bufferView":1,"byteOffset":4,"componentType":5125,"count":12,"type":)"
        R"("SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":)" +
            length(positions) + R"(},{"buffer":1,"byteLength":)" + std::to_string(4 + corners.size()) +
            R"(}],"buffers":[{"uri":"positions.bin","byteLength":)" + length(positions) +
            R"(},{"uri":"corners.bin","byteLength":)" + std::to_string(4 + corners.size()) + "}]}");
    EXPECT_NEAR(inspect(read_mesh(file)).signed_volume, 1.0 / 6, 1e-9);
}

TEST_F(ReadGltf, ReadsPositionsInWholeNumbers) {
    GltfText file;
    std::vector<std::int16_t> positions; // interleaved: three numbers in eight bytes
    for (const Vec3f& p : kTriangleCorners)
        for (const float number : {p.x, p.y, p.z, 77.0F})
            positions.push_back(static_cast<std::int16_t>(4 * number));
    const std::size_t view = file.add_view(bytes_of(positions));
    file.views.insert(file.views.size() - 1, R"(,"byteStride":8)");
    const std::size_t accessor = file.add_accessor(R"("bufferView":)" + std::to_string(view) +
                                                   R"(,"componentType":5122,"count":4,"type":"VEC3")");
    const std::string indices = std::to_string(file.add(kTriangleFaces));
    file.meshes = R"([{"primitives":[{"attributes":{"POSITION":)" + std::to_string(accessor) +
                  R"(},"indices":)" + indices + "}]}]";
    file.nodes = R"([{"mesh":0,"scale":[0.5,0.5,0.5]}])";
    file.more = R"(,"extensionsRequired":["KHR_mesh_quantization"])";
    EXPECT_NEAR(inspect(read(file)).signed_volume, 8.0 / 6, 1e-9);
}

TEST_F(ReadGltf, TakesNormalizedNumbersForFractions) {
    const auto volume = [&](const auto& positions) {
        GltfText file;
        const std::string accessor = std::to_string(file.add(positions, 3, R"(,"normalized":true)"));
        file.meshes = R"([{"primitives":[{"attributes":{"POSITION":)" + accessor + R"(},"indices":)" +
                      std::to_string(file.add(kTriangleFaces)) + "}]}]";
        return inspect(read(file)).signed_volume;
    };
    EXPECT_NEAR(volume(std::vector<std::uint8_t>{0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255}), 1.0 / 6, 1e-9);
    EXPECT_NEAR(volume(std::vector<std::uint16_t>{0, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0, 65535}), 1.0 / 6,
                1e-9);
    // -128 and -127 stand for -1.
    EXPECT_NEAR(volume(std::vector<std::int8_t>{0, 0, 0, -128, 0, 0, 0, -127, 0, 0, 0, 127}), 1.0 / 6, 1e-9);
    EXPECT_NEAR(volume(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 0, 32767}), 1.0 / 6,
                1e-9);
}

TEST_F(ReadGltf, ReplacesTheElementsOfASparseAccessor) {
    // With a view, in which the last corner is elsewhere, and without one, where all are zero.
    for (const bool has_view : {true, false}) {
        GltfText file;
        std::vector<Vec3f> corners = kTriangleCorners;
        corners[3] = {5, 5, 5};
        const std::vector<std::uint16_t> elements =
            has_view ? std::vector<std::uint16_t>{3} : std::vector<std::uint16_t>{1, 2, 3};
        std::vector<Vec3f> values;
        for (const std::uint16_t element : elements) values.push_back(kTriangleCorners[element]);
        const std::string dense = std::to_string(file.add_view(bytes_of(flat(corners))));
        const std::string at = std::to_string(file.add_view(bytes_of(elements)));
        const std::string with = std::to_string(file.add_view(bytes_of(flat(values))));
        const std::size_t accessor =
            file.add_accessor((has_view ? R"("bufferView":)" + dense + "," : "") +
                              R"("componentType":5126,"count":4,"type":"VEC3","sparse":{"count":)" +
                              std::to_string(elements.size()) + R"(,"indices":{"bufferView":)" + at +
                              R"(,"componentType":5123},"values":{"bufferView":)" + with + "}}");
        const std::string indices = std::to_string(file.add(kTriangleFaces));
        file.meshes = R"([{"primitives":[{"attributes":{"POSITION":)" + std::to_string(accessor) +
                      R"(},"indices":)" + indices + "}]}]";
        EXPECT_NEAR(inspect(read(file)).signed_volume, 1.0 / 6, 1e-9);
        file.accessors = replaced(file.accessors, R"("count":4)", R"("count":3)");
        expect_refused(ErrorCode::InvalidMesh, "must ascend, and be less than 3", file);
    }
}

TEST_F(ReadGltf, ReadsStripsFansAndListsWithoutIndices) {
    const auto volume = [&](const std::vector<std::uint32_t>& order, int mode) {
        GltfText file;
        std::vector<Vec3f> positions;
        for (const std::uint32_t vertex : order) positions.push_back(kTriangleCorners[vertex]);
        file.meshes = R"([{"primitives":[{"mode":)" + std::to_string(mode) + R"(,"attributes":{"POSITION":)" +
                      std::to_string(file.add(flat(positions), 3)) + "}}]}]";
        const MeshReport report = inspect(read(file));
        EXPECT_EQ(report.face_count, 4U);
        EXPECT_TRUE(report.closed);
        return report.signed_volume;
    };
    EXPECT_NEAR(volume(kTriangleFaces, 4), 1.0 / 6, 1e-9);
    EXPECT_NEAR(volume({0, 2, 1, 3, 0, 2}, 5), 1.0 / 6, 1e-9);
    // Corners that stand twice have no triangles; each one more turns the others over.
    EXPECT_NEAR(volume({0, 0, 2, 1, 3, 0, 2, 2}, 5), -1.0 / 6, 1e-9);
    EXPECT_NEAR(volume({0, 0, 0, 2, 1, 3, 0, 2}, 5), 1.0 / 6, 1e-9);
    // A fan around a corner, and one that closes it.
    GltfText fans;
    const std::string positions = std::to_string(fans.add(flat(kTriangleCorners), 3));
    const std::string around = std::to_string(fans.add(std::vector<std::uint8_t>{3, 0, 1, 2, 0}));
    const std::string below = std::to_string(fans.add(std::vector<std::uint8_t>{0, 2, 1}));
    fans.meshes = R"([{"primitives":[{"mode":6,"attributes":{"POSITION":)" + positions + R"(},"indices":)" +
                  around + R"(},{"mode":6,"attributes":{"POSITION":)" + positions + R"(},"indices":)" +
                  below + "}]}]";
    EXPECT_TRUE(inspect(read(fans)).closed);
    EXPECT_NEAR(inspect(read(fans)).signed_volume, 1.0 / 6, 1e-9);
}

TEST_F(ReadGltf, LeavesPointsOutAndKeepsLinesApart) {
    GltfText file;
    const std::string positions = std::to_string(file.add(flat(kTriangleCorners), 3));
    const auto primitive = [&](int mode) {
        return R"({"mode":)" + std::to_string(mode) + R"(,"attributes":{"POSITION":)" + positions + "}}";
    };
    file.meshes = "[{\"primitives\":[" + primitive(0) + "," + primitive(1) + "," + primitive(2) + "," +
                  primitive(3) + "]}]";
    expect_refused(ErrorCode::InvalidMesh, "the file has no faces", file);
    const MeshAndEdges drawn = read_mesh_and_edges(path("a.gltf"));
    EXPECT_EQ(drawn.edges.size(), 2U + 4U + 3U);
    file.meshes = "[{\"primitives\":[" + primitive(0) + "]}]";
    expect_error(ErrorCode::InvalidMesh, "neither faces nor lines",
                 [&] { read_mesh_and_edges(write("a.gltf", file.text())); });
}

TEST_F(ReadGltf, ManyPrimitivesThatShareVerticesAreNoMoreWorkThanTheirFaces) {
    // Copies of all vertices for each primitive would take 2 * 10^9 of them.
    constexpr std::uint32_t kVertexCount = 100'000, kPrimitiveCount = 20'000;
    GltfText file;
    std::vector<float> positions;
    for (std::uint32_t i = 0; i < 3 * kVertexCount; ++i)
        positions.push_back(static_cast<float>(i * 7919 % 10007));
    const std::string shared = std::to_string(file.add(positions, 3));
    const std::string targets = std::to_string(file.add(positions, 3));
    file.meshes = R"([{"weights":[0],"primitives":[)";
    const std::size_t view = file.add_view(bytes_of(std::vector<std::uint16_t>{5, 50000, 65000}));
    for (std::uint32_t i = 0; i < kPrimitiveCount; ++i) {
        const std::size_t indices = file.add_accessor(R"("bufferView":)" + std::to_string(view) +
                                                      R"(,"componentType":5123,"count":3,"type":"SCALAR")");
        file.meshes += (i == 0 ? "" : ",") + std::string(R"({"attributes":{"POSITION":)") + shared +
                       R"(},"targets":[{"POSITION":)" + targets + R"(}],"indices":)" +
                       std::to_string(indices) + "}";
    }
    file.meshes += "]}]";
    const TriangleMesh mesh = read(file);
    EXPECT_EQ(mesh.faces.size(), kPrimitiveCount);
    EXPECT_EQ(mesh.vertices.size(), 3U);
}

// ---- Files that are refused ----

TEST_F(ReadGltf, RefusesAFaceThatRefersToAMissingVertex) {
    const std::string words =
        "a face of meshes[0] refers to vertex 4, but there are 4 vertices, numbered from 0";
    for (const GltfText& file : tetrahedra(4)) {
        SCOPED_TRACE(file.accessors);
        write("beside.bin", file.binary);
        expect_refused(ErrorCode::InvalidMesh, words, "a.gltf", file.json(R"("uri":"beside.bin")"));
        expect_refused(ErrorCode::InvalidMesh, words, "a.gltf", file.text());
        expect_refused(ErrorCode::InvalidMesh, words, "a.glb", file.glb());
    }
}

TEST_F(ReadGltf, RefusesWhatReachesBeyondItsBuffer) {
    const GltfText whole = tetrahedron<std::uint16_t>();
    const auto expect_damaged = [&](const std::string& what, const std::string& with,
                                    const std::string& words) {
        SCOPED_TRACE(with);
        expect_refused(ErrorCode::Damaged, words, "a.gltf", replaced(whole.text(), what, with));
    };
    expect_damaged(R"("count":4)", R"("count":5)", "more than the 48 bytes of bufferViews[0]");
    expect_damaged(R"("count":4)", R"("count":4294967295)", "more than the 48 bytes of bufferViews[0]");
    expect_damaged(R"("count":4)", R"("byteOffset":9007199254740992,"count":4)", "more than the 48 bytes");
    expect_damaged(R"("byteLength":48)", R"("byteLength":480)",
                   "bufferViews[0] ends at byte 480 of a buffer of 72");
    expect_damaged(R"("byteOffset":48)", R"("byteOffset":9007199254740992)", "bufferViews[1] ends at byte");
    expect_damaged(R"("byteLength":48)", R"("byteLength":48,"byteStride":9007199254740992)",
                   "more than the 48 bytes");
    expect_damaged(R"("byteLength":72)", R"("byteLength":73)", "buffers[0] has 72 bytes, but declares 73");
    expect_damaged("base64,AA", "base64,?A", "buffers[0] has the character '?', which is not base64");
}

TEST_F(ReadGltf, RefusesNumbersThatMakeNoSense) {
    const GltfText whole = tetrahedron<std::uint16_t>();
    const auto expect_invalid = [&](const std::string& what, const std::string& with,
                                    const std::string& words) {
        SCOPED_TRACE(with);
        expect_refused(ErrorCode::InvalidMesh, words, "a.gltf", replaced(whole.text(), what, with));
    };
    expect_invalid(R"("count":4)", R"("count":-4)",
                   "accessors[0].count is not a whole number from 0 to 2^53");
    expect_invalid(R"("count":4)", R"("count":4.5)", "accessors[0].count is not a whole number");
    expect_invalid(R"("count":4)", R"("count":1e300)", "accessors[0].count is not a whole number");
    expect_invalid(R"("count":4)", R"("count":"4")", "accessors[0].count is not a number");
    expect_invalid(R"(,"count":4)", "", "accessors[0].count is missing");
    expect_invalid(R"("count":12)", R"("count":11)",
                   "meshes[0].primitives[0] has 11 corners, not a multiple of 3");
    expect_invalid("5126", "5124", "accessors[0].componentType is not a component type of glTF");
    expect_invalid("VEC3", "VEC5", "accessors[0].type is not an accessor type of glTF");
    expect_invalid("VEC3", "SCALAR", "has elements of 1 numbers in place of 3");
    expect_invalid("5123", "5122",
                   "meshes[0].primitives[0].indices has numbers of a type that is not allowed for indices");
    expect_invalid(R"("indices":1)", R"("indices":2)", "indices is 2, but there are 2 accessors");
    expect_invalid(R"("mesh":0)", R"("mesh":true)", "nodes[0].mesh is not a number");
    expect_invalid(R"([{"mesh":0}])", R"({"mesh":0})", "nodes is not an array");
    expect_invalid(R"("indices")", R"("mode":7,"indices")", "mode is 7, which is not a mode of glTF");
    expect_invalid(R"("byteLength":48)", R"("byteLength":48,"byteStride":4)", "is shorter than an element");
    // An accessor without a view is full of zeros, however many it says there are.
    expect_invalid(R"("bufferView":1,"componentType":5123,"count":12)",
                   R"("componentType":5123,"count":4294967295)", "the file names the same data so often");
}

TEST_F(ReadGltf, RefusesASmallFileOfWhichAHugeMeshWouldBeMade) {
    GltfText file = box_file();
    file.scenes = R"([{"nodes":[)";
    file.nodes = "[";
    const std::size_t accessor =
        file.add_accessor(R"("componentType":5125,"count":30000,"type":"SCALAR")"); // zeros
    file.meshes =
        R"([{"primitives":[{"attributes":{"POSITION":0},"indices":)" + std::to_string(accessor) + "}]}]";
    for (int i = 0; i < 10'000; ++i) {
        file.nodes += i == 0 ? R"({"mesh":0})" : R"(,{"mesh":0})";
        file.scenes += (i == 0 ? "" : ",") + std::to_string(i);
    }
    file.nodes += "]";
    file.scenes += "]}]";
    expect_refused(ErrorCode::InvalidMesh, "the file names the same data so often", file);
}

TEST_F(ReadGltf, NoticesThatAFileIsShorterThanItSays) {
    if (!can_export()) GTEST_SKIP() << kCannotExport;
    const std::string glb = exported(kGlb);
    expect_refused(ErrorCode::Damaged, "the file says that it has", "cut.glb", glb.substr(0, glb.size() - 1));
    expect_refused(ErrorCode::Damaged, "the file says that it has", "long.glb", glb + "x");
    expect_refused(ErrorCode::Damaged, "the file ends at byte 10", "head.glb", glb.substr(0, 10));
    const std::string gltf = exported(kGltf);
    expect_refused(ErrorCode::Damaged, "the JSON is malformed at byte", "cut.gltf",
                   gltf.substr(0, gltf.size() - 5));
}

TEST_F(ReadGltf, RefusesAFileWithoutItsBuffer) {
    if (!can_export()) GTEST_SKIP() << kCannotExport;
    const std::string gltf = exported(kGltf);
    fs::remove(path("exported.bin"));
    expect_refused(ErrorCode::Unreadable, "buffers[0] is in the file exported.bin, which is not there",
                   "alone.gltf", gltf);
    for (const std::string far : {"https://example.org/a.bin", "/etc/hostname", "%2Fetc/hostname"})
        expect_refused(ErrorCode::Unreadable, "only files named by their path from this one are read",
                       "far.gltf", replaced(gltf, "exported.bin", far));
    expect_refused(ErrorCode::Damaged, "buffers[0] has no bytes", "none.gltf",
                   tetrahedron<std::uint8_t>().json(""));
}

TEST_F(ReadGltf, DoesNotOpenABufferThatIsNoOrdinaryFile) {
    if (!can_export()) GTEST_SKIP() << kCannotExport;
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "this system has no /dev/zero";
    fs::create_symlink("/dev/zero", path("endless.bin"));
    expect_refused(ErrorCode::Unreadable, "is not a regular file", "endless.gltf",
                   replaced(exported(kGltf), "exported.bin", "endless.bin"));
}

TEST_F(ReadGltf, RefusesCoordinatesThatAreNotFinite) {
    if (!can_export()) GTEST_SKIP() << kCannotExport;
    std::string glb = exported(kGlb);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::size_t buffer = glb.find(std::string("BIN\0", 4)) + 4; // positions come first
    ASSERT_LT(buffer, glb.size());
    std::memcpy(glb.data() + buffer, &nan, sizeof(nan));
    expect_refused(ErrorCode::InvalidMesh, "has the vertex 0, which is not finite", "nan.glb", glb);
    GltfText far = box_file();
    far.nodes = R"([{"mesh":0,"scale":[1e300,1,1]}])";
    expect_refused(ErrorCode::InvalidMesh, "a vertex of meshes[0] is not finite after its transformation",
                   far);
}

TEST_F(ReadGltf, RefusesJsonThatIsNoneOrAmbiguous) {
    const std::string json = tetrahedron<std::uint32_t>().text();
    const auto expect_damaged = [&](const std::string& words, const std::string& text) {
        expect_refused(ErrorCode::Damaged, words, "a.gltf", text);
    };
    expect_damaged("the JSON is malformed at byte 2", "{" + std::string(2'000'000, '['));
    expect_damaged("the JSON has too many nested brackets",
                   replaced(json, R"({"asset")",
                            R"({"extras":)" + std::string(2'000'000, '[') + std::string(2'000'000, ']') +
                                R"(,"asset")"));
    expect_damaged("export the file again, as UTF-8",
                   replaced(json, R"({"mesh":0})", "{\"name\":\"\xE9\",\"mesh\":0}"));
    expect_damaged("a number that is too large", replaced(json, R"("count":4)", R"("count":1e999)"));
    for (const std::string key : {"meshes", "accessors", "bufferViews", "buffers"})
        expect_damaged("the key '" + key + "' is given twice",
                       json.substr(0, json.size() - 1) + ",\"" + key + "\":[]}");
    EXPECT_EQ(read_mesh(write("marked.gltf", "\xEF\xBB\xBF" + json)).faces.size(), 4U);
}

TEST_F(ReadGltf, RefusesRequiredExtensionsThatItDoesNotReadByTheirNames) {
    GltfText file = box_file();
    for (const std::string extension :
         {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "ACME_faces_inside_out"}) {
        file.more = R"(,"extensionsRequired":[")" + extension + "\"]";
        expect_refused(ErrorCode::WrongFormat, "the file requires the extension " + extension, file);
        file.more = R"(,"extensionsUsed":[")" + extension + "\"]"; // and does without
        expect_same_faces(read(file), kBoxInGltf);
    }
    file.more = R"(,"extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"])";
    expect_same_faces(read(file), kBoxInGltf);
    GltfText compressed = tetrahedron<std::uint16_t>();
    compressed.accessors = replaced(compressed.accessors, R"("bufferView":0,)", "");
    compressed.meshes = replaced(compressed.meshes, R"("indices")",
                                 R"("extensions":{"KHR_draco_mesh_compression":{}},"indices")");
    expect_refused(ErrorCode::WrongFormat, "is compressed by KHR_draco_mesh_compression", compressed);
}

TEST_F(ReadGltf, RefusesOtherFormatsAndVersions) {
    const std::string png = "\x89PNG\r\n\x1a\n and some more bytes";
    expect_refused(ErrorCode::WrongFormat, "the word glTF", "a.glb", png);
    expect_refused(ErrorCode::WrongFormat, "the brace", "a.gltf", png);
    const std::string json = tetrahedron<std::uint8_t>().text();
    expect_refused(ErrorCode::WrongFormat, "the file is of version '1.0' of glTF", "a.gltf",
                   replaced(json, R"("2.0")", R"("1.0")"));
    expect_refused(ErrorCode::WrongFormat, "does not say of which version", "a.gltf",
                   replaced(json, R"("version":"2.0")", ""));
    std::string glb = tetrahedron<std::uint8_t>().glb();
    glb[4] = 1;
    expect_refused(ErrorCode::WrongFormat, "the file is of version 1 of GLB", "a.glb", glb);
}
