#include "mesh_io/exported_files.hpp"
#include "support/expect_error.hpp"
#include "support/expect_same_faces.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

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
constexpr ExportedKind k3ds{"3ds", ".3ds"};

template <typename Number>
std::string bytes_of(Number value) {
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string chunk(std::uint16_t id, const std::string& content) {
    return bytes_of(id) + bytes_of(static_cast<std::uint32_t>(content.size() + 6)) + content;
}

/// A 3DS file by hand, on a little-endian machine: main chunk, editor, object, mesh, points and faces.
std::string encode_3ds(const TriangleMesh& mesh) {
    std::string points = bytes_of(static_cast<std::uint16_t>(mesh.vertices.size()));
    for (const Vec3f& p : mesh.vertices) points += bytes_of(p);
    std::string faces = bytes_of(static_cast<std::uint16_t>(mesh.faces.size()));
    for (const Triangle& face : mesh.faces) {
        for (const std::uint32_t vertex : face) faces += bytes_of(static_cast<std::uint16_t>(vertex));
        faces += bytes_of(std::uint16_t{0}); // flags
    }
    const std::string object =
        std::string("box") + '\0' + chunk(0x4100, chunk(0x4110, points) + chunk(0x4120, faces));
    return chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, object)));
}

std::string base64(const std::string& bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bits;
    for (const char byte : bytes)
        for (int bit = 7; bit >= 0; --bit) bits += (byte >> bit & 1) != 0 ? '1' : '0';
    bits.resize((bits.size() + 5) / 6 * 6, '0');
    std::string text;
    for (std::size_t i = 0; i < bits.size(); i += 6)
        text += kDigits[std::stoul(bits.substr(i, 6), nullptr, 2)];
    return text + std::string((4 - text.size() % 4) % 4, '=');
}

/// A glTF file of one tetrahedron, in the three ways in which a file can hold its numbers.
struct SmallGltf {
    std::string json(const std::string& uri) const {
        const std::string size = std::to_string(binary.size());
        return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
               R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
               R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
               R"({"bufferView":1,"byteOffset":4,"componentType":)" +
               component_type + R"(,"count":12,"type":"SCALAR"}],"bufferViews":[)" +
               R"({"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":)" +
               std::to_string(binary.size() - 48) + R"(}],"buffers":[{)" + uri + R"("byteLength":)" + size +
               "}]}";
    }
    std::string embedded() const {
        return json(R"("uri":"data:application/octet-stream;base64,)" + base64(binary) + "\",");
    }
    std::string glb() const {
        std::string text = json("");
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const auto size_of = [](const std::string& s) {
            return bytes_of(static_cast<std::uint32_t>(s.size()));
        };
        const std::string chunks =
            size_of(text) + "JSON" + text + size_of(binary) + std::string("BIN\0", 4) + binary;
        return "glTF" + bytes_of(std::uint32_t{2}) +
               bytes_of(static_cast<std::uint32_t>(chunks.size() + 12)) + chunks;
    }

    std::string component_type;
    std::string binary;
};

template <typename Index>
SmallGltf small_gltf(const std::string& component_type, Index last_corner) {
    std::string binary;
    for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)})
        binary += bytes_of(p);
    binary += "skip"; // the accessor's own offset
    for (const int vertex : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2}) binary += bytes_of(static_cast<Index>(vertex));
    return {component_type, binary + bytes_of(last_corner)};
}

std::vector<SmallGltf> small_gltfs(std::uint8_t last_corner) {
    return {small_gltf<std::uint8_t>("5121", last_corner), small_gltf<std::uint16_t>("5123", last_corner),
            small_gltf<std::uint32_t>("5125", last_corner)};
}

class ReadScene : public TemporaryFolderTest {
  protected:
    std::string exported(const ExportedKind& kind) const {
        const fs::path file = path(std::string("exported") + kind.ending);
        export_with_assimp(file, make_box({1, 2, 3}, 2), kind);
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    void expect_refused(ErrorCode code, const std::string& words, const std::string& name,
                        const std::string& content) const {
        const fs::path file = write(name, content);
        expect_error(code, file.string() + ": " + words, [&] { read_mesh(file); });
    }
};

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), with);
}

} // namespace

TEST_F(ReadScene, AppliesTheTransformsOfNodes) {
    // Turned by a quarter about z, twice as large along x, and moved.
    const Placement placement{0, -1, 0, 10, 2, 0, 0, 20, 0, 0, 1, 30};
    const TriangleMesh box = make_box({1, 2, 3}, 2);
    TriangleMesh expected = box;
    for (Vec3f& p : expected.vertices) p = {10 - p.y, 20 + 2 * p.x, 30 + p.z};
    for (const ExportedKind& kind : {kGlb, kGltf}) {
        const fs::path file = path(std::string("placed") + kind.ending);
        export_with_assimp(file, box, kind, placement);
        expect_same_faces(read_mesh(file), expected);
    }
}

TEST_F(ReadScene, KeepsFacesOutwardUnderAMirroringTransform) {
    const Placement mirror{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    export_with_assimp(path("mirror.glb"), make_box({1, 2, 3}), kGlb, mirror);
    const MeshReport report = inspect(read_mesh(path("mirror.glb")));
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(report.signed_volume, 6, 1e-6);
}

TEST_F(ReadScene, Keeps3dsPositionsAsTheyStandInTheFile) {
    const TriangleMesh box = make_box({1, 2, 3}, 2);
    expect_same_faces(read_mesh(write("box.3ds", encode_3ds(box))), box);
}

TEST_F(ReadScene, NoticesThatAFileIsShorterThanItSays) {
    const std::string glb = exported(kGlb);
    expect_refused(ErrorCode::Damaged, "the file says that it has", "cut.glb", glb.substr(0, glb.size() - 1));
    expect_refused(ErrorCode::Damaged, "the file says that it has", "long.glb", glb + "x");
    expect_refused(ErrorCode::Damaged, "the file ends at byte 10", "head.glb", glb.substr(0, 10));
    const std::string three_ds = exported(k3ds);
    expect_refused(ErrorCode::Damaged, "the file says that it has", "cut.3ds",
                   three_ds.substr(0, three_ds.size() - 1));
    const std::string gltf = exported(kGltf);
    expect_refused(ErrorCode::Damaged, "Assimp cannot read the file", "cut.gltf",
                   gltf.substr(0, gltf.size() - 5));
}

TEST_F(ReadScene, RefusesAGltfFileWithoutItsBuffer) {
    const std::string gltf = exported(kGltf);
    fs::remove(path("exported.bin"));
    expect_refused(ErrorCode::Damaged, "Assimp cannot read the file", "alone.gltf", gltf);
}

TEST_F(ReadScene, DoesNotOpenABufferThatIsNoOrdinaryFile) {
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "this system has no /dev/zero";
    fs::create_symlink("/dev/zero", path("endless.bin"));
    expect_refused(ErrorCode::Damaged, "Assimp cannot read the file", "endless.gltf",
                   replaced(exported(kGltf), "exported.bin", "endless.bin"));
}

TEST_F(ReadScene, RefusesCoordinatesThatAreNotFinite) {
    std::string glb = exported(kGlb);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::size_t buffer = glb.find(std::string("BIN\0", 4)) + 4; // positions come first
    ASSERT_LT(buffer, glb.size());
    std::memcpy(glb.data() + buffer, &nan, sizeof(nan));
    expect_refused(ErrorCode::InvalidMesh, "vertex 0 of the mesh", "nan.glb", glb);
}

TEST_F(ReadScene, RefusesNestingThatWouldExhaustTheStack) {
    expect_refused(ErrorCode::Damaged, "the JSON has too many brackets in brackets", "deep.gltf",
                   "{" + std::string(2'000'000, '['));
    std::string chain =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[";
    for (int i = 1; i < 100'000; ++i) chain += "{\"children\":[" + std::to_string(i) + "]},";
    expect_refused(ErrorCode::Damaged, "there are too many nodes with children", "chain.gltf",
                   chain + "{}]}");
    expect_refused(ErrorCode::Damaged, "there are too many nodes with children", "escaped.gltf",
                   replaced(chain, "children", "childre\\u006e") + "{}]}");
}

TEST_F(ReadScene, RefusesA3dsFileWithAnEnormousTreeOfNodes) {
    std::string nodes;
    for (int i = 0; i < 5000; ++i) nodes += chunk(0xB002, "");
    expect_refused(ErrorCode::Damaged, "there are too many nodes", "tree.3ds",
                   chunk(0x4D4D, chunk(0xB000, nodes)));
}

TEST_F(ReadScene, RefusesA3dsFileWithAFaceThatRefersToAMissingVertex) {
    TriangleMesh box = make_box({1, 2, 3});
    box.faces[5][1] = 8;
    expect_refused(ErrorCode::InvalidMesh,
                   "face 5 of the mesh 'box' refers to vertex 8, but there are 8 vertices, numbered from 0",
                   "beyond.3ds", encode_3ds(box));
}

TEST_F(ReadScene, RefusesA3dsListThatPromisesMoreFacesThanItHas) {
    const std::string object = std::string("box") + '\0' + chunk(0x4100, chunk(0x4120, "\xFF\xFF"));
    expect_refused(ErrorCode::Damaged, "a list of 65535 faces has only 2 bytes", "short.3ds",
                   chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, object))));
}

TEST_F(ReadScene, TakesIndicesOfEveryTypeFromEveryKindOfBuffer) {
    for (const SmallGltf& file : small_gltfs(3)) {
        SCOPED_TRACE(file.component_type);
        write("beside.bin", file.binary);
        EXPECT_TRUE(inspect(read_mesh(write("a.gltf", file.json(R"("uri":"beside.bin",)")))).closed);
        EXPECT_TRUE(inspect(read_mesh(write("a.gltf", file.embedded()))).closed);
        EXPECT_TRUE(inspect(read_mesh(write("a.glb", file.glb()))).closed);
    }
}

TEST_F(ReadScene, RefusesAGltfFileWithAFaceThatRefersToAMissingVertex) {
    const std::string words =
        "a face of mesh 0 refers to vertex 4, but there are 4 vertices, numbered from 0";
    for (const SmallGltf& file : small_gltfs(4)) {
        SCOPED_TRACE(file.component_type);
        write("beside.bin", file.binary);
        expect_refused(ErrorCode::InvalidMesh, words, "a.gltf", file.json(R"("uri":"beside.bin",)"));
        expect_refused(ErrorCode::InvalidMesh, words, "a.gltf", file.embedded());
        expect_refused(ErrorCode::InvalidMesh, words, "a.glb", file.glb());
    }
}

TEST_F(ReadScene, FindsAMissingVertexAlsoInJsonThatOnlyAssimpAccepts) {
    const std::string words = "a face of mesh 0 refers to vertex 4";
    const std::string json = small_gltf<std::uint32_t>("5125", 4).embedded();
    expect_refused(ErrorCode::InvalidMesh, words, "latin1.gltf",
                   replaced(json, R"({"mesh":0})", "{\"name\":\"\xE9\",\"mesh\":0}"));
    for (const std::string key : {"meshes", "accessors", "bufferViews", "buffers"})
        expect_refused(ErrorCode::InvalidMesh, words, "twice.gltf",
                       json.substr(0, json.size() - 1) + ",\"" + key + "\":[]}");
}

TEST_F(ReadScene, RefusesCompressedPositions) {
    for (const std::string extension :
         {"KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_meshopt_compression"})
        expect_refused(ErrorCode::WrongFormat, "the file uses the extension " + extension, "small.gltf",
                       replaced(exported(kGltf), "{", "{\"extensionsRequired\":[\"" + extension + "\"],"));
}

TEST_F(ReadScene, RefusesOtherFormats) {
    const std::string png = "\x89PNG\r\n\x1a\n and some more bytes";
    expect_refused(ErrorCode::WrongFormat, "the word glTF", "a.glb", png);
    expect_refused(ErrorCode::WrongFormat, "the brace", "a.gltf", png);
    expect_refused(ErrorCode::WrongFormat, "the bytes 4D 4D", "a.3ds", png);
}
