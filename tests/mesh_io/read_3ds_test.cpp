#include "mesh_io/exported_files.hpp"
#include "mesh_io/gltf_text.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

const TriangleMesh kBox = make_box({1, 2, 3}, 2);

/// A chunk, on a little-endian machine.
std::string chunk(std::uint16_t id, const std::string& content) {
    return bytes_of(id) + bytes_of(static_cast<std::uint32_t>(content.size() + 6)) + content;
}

std::string words(const std::vector<std::uint16_t>& values) {
    return bytes_of(values);
}

std::string name(const std::string& text) {
    return text + '\0';
}

/// An object with its lists of points and faces, and its own frame: a quarter about z, moved by (5, 6, 7).
std::string object(const TriangleMesh& mesh, const std::string& object_name = "box") {
    std::string points = words({static_cast<std::uint16_t>(mesh.vertices.size())});
    for (const Vec3f& p : mesh.vertices) points += bytes_of(p);
    std::string faces = words({static_cast<std::uint16_t>(mesh.faces.size())});
    for (const Triangle& face : mesh.faces)
        for (const std::uint32_t word : {face[0], face[1], face[2], 7U}) // the last are flags
            faces += bytes_of(static_cast<std::uint16_t>(word));
    const std::string matrix = bytes_of(std::vector<float>{0, 1, 0, -1, 0, 0, 0, 0, 1, 5, 6, 7});
    return chunk(0x4000, name(object_name) + chunk(0x4100, chunk(0x4110, points) + chunk(0x4120, faces) +
                                                               chunk(0x4160, matrix)));
}

constexpr std::uint16_t kNoParent = 0xFFFF;

/// A node of the keyframes.
std::string node(std::uint16_t number, const std::string& object_name, std::uint16_t parent = kNoParent,
                 const std::string& tracks = "") {
    return chunk(0xB002, chunk(0xB030, words({number})) +
                             chunk(0xB010, name(object_name) + words({0, 0, parent})) + tracks +
                             chunk(0xB013, bytes_of(std::vector<float>{3, 1, 4})));
}

struct Key {
    std::uint32_t frame;
    std::vector<float> value;
};

/// A track, with a term of a spline at each key.
std::string track(std::uint16_t id, const std::vector<Key>& keys) {
    std::string bytes = words({0, 0, 0, 0, 0}) + bytes_of(static_cast<std::uint32_t>(keys.size()));
    for (const Key& key : keys)
        bytes += bytes_of(key.frame) + words({2}) + bytes_of(0.25F) + bytes_of(key.value);
    return chunk(id, bytes);
}
std::string moves(const std::vector<Key>& keys) {
    return track(0xB020, keys);
}
/// Keys have an angle and an axis.
std::string turns(const std::vector<Key>& keys) {
    return track(0xB021, keys);
}

std::string file_of(const std::string& objects, const std::string& nodes = "") {
    return chunk(0x4D4D, chunk(0x0002, words({3, 0})) + chunk(0x3D3D, objects) +
                             (nodes.empty() ? "" : chunk(0xB000, nodes)));
}

class Read3ds : public TemporaryFolderTest {
  protected:
    TriangleMesh read(const std::string& bytes) const { return read_mesh(write("a.3ds", bytes)); }
    VertexCache read_cache(const std::string& bytes) const {
        const fs::path file = write("a.3ds", bytes);
        return read_vertex_cache(file, read_mesh(file), 25);
    }
    void expect_refused(ErrorCode code, const std::string& sentence, const std::string& bytes) const {
        const fs::path file = write("a.3ds", bytes);
        expect_error(code, file.string() + ": " + sentence, [&] { read_mesh(file); });
    }
};

constexpr float kRight = std::numbers::pi_v<float> / 2;
const std::string kQuarter = turns({{0, {kRight, 1, 0, 0}}});

/// A node that stands where the pivot of an object stands in the file, turned as its frame is.
const Vec3f kPivot{4, 9, 11};
const Key kTurned{0, {-kRight, 0, 0, 1}};
std::string stands(const Vec3f& more = {}) {
    return moves({{0, {kPivot.x + more.x, kPivot.y + more.y, kPivot.z + more.z}}}) + turns({kTurned});
}
const std::string kRises =
    moves({{0, {kPivot.x, kPivot.y, kPivot.z}}, {10, {kPivot.x, kPivot.y, kPivot.z + 10}}});

} // namespace

TEST_F(Read3ds, KeepsPositionsAsTheyStandInTheFile) {
    expect_same_faces(read(file_of(object(kBox))), kBox);
}

TEST_F(Read3ds, KeyframesDoNotMoveTheModel) {
    for (const std::string& tracks :
         {std::string(), kQuarter, moves({{0, {5, 6, 7}}, {10, {50, 60, 70}}}) + kQuarter,
          track(0xB022, {{0, {2, -3, 0.1F}}}), track(0xB022, {{0, {0, 0, 0}}})}) {
        expect_same_faces(read(file_of(object(kBox), node(0, "box", kNoParent, tracks))), kBox);
        // Under a parent that moves, too, and one that is a camera.
        const std::string child = node(1, "box", 0, tracks);
        expect_same_faces(read(file_of(object(kBox), node(0, "$$$DUMMY", kNoParent, kQuarter) + child)),
                          kBox);
        expect_same_faces(read(file_of(object(kBox), chunk(0xB003, chunk(0xB030, words({0}))) + child)),
                          kBox);
    }
}

TEST_F(Read3ds, FurtherNodesOfAnObjectPlaceCopies) {
    const std::string first = node(0, "box", kNoParent, stands());
    const std::string second = node(1, "box", kNoParent, stands({10, 0, 0}));
    TriangleMesh two = kBox, copy = translated(kBox, {10, 0, 0});
    const auto count = static_cast<std::uint32_t>(two.vertices.size());
    two.vertices.insert(two.vertices.end(), copy.vertices.begin(), copy.vertices.end());
    for (const Triangle& face : copy.faces)
        two.faces.push_back({count + face[0], count + face[1], count + face[2]});
    expect_same_faces(read(file_of(object(kBox), first + second)), two, 1e-5);
    // Two objects of one name have a node each.
    expect_same_faces(read(file_of(object(kBox) + object(copy), first + second)), two);
}

TEST_F(Read3ds, AnimationsLeadObjectsByTheirFramesAndPivots) {
    const TriangleMesh mesh = read(file_of(object(kBox)));
    const auto expect_risen = [&](const VertexCache& cache, double time, double height) {
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            const Vec3d expected = Vec3d(mesh.vertices[i]) + Vec3d{0, 0, height};
            EXPECT_NEAR(length(Vec3d(vertices_at(cache, time)[i]) - expected), 0, 1e-5);
        }
    };
    const VertexCache moving =
        read_cache(file_of(object(kBox), node(0, "box", kNoParent, turns({kTurned}) + kRises)));
    EXPECT_EQ(moving.sample_count(), 11U);
    expect_risen(moving, 0, 0);
    expect_risen(moving, 0.2, 5);
    // A parent carries its child along.
    const std::string parent = node(7, "$$$DUMMY", kNoParent, moves({{0, {0, 0, 0}}, {10, {0, 0, 10}}}));
    const VertexCache carried = read_cache(file_of(object(kBox), parent + node(1, "box", 7, stands())));
    expect_risen(carried, 0, 0);
    expect_risen(carried, 0.4, 10);
}

TEST_F(Read3ds, RotationsGoOnFromKeyToKeyAndRunClockwise) {
    // About z by 30 degrees, then about x by 90: each seen against its axis, about the pivot.
    const VertexCache cache = read_cache(file_of(
        object(kBox), node(0, "box", kNoParent,
                           moves({{0, {kPivot.x, kPivot.y, kPivot.z}}}) +
                               turns({kTurned, {10, {kRight / 3, 0, 0, 1}}, {20, {kRight, 1, 0, 0}}}))));
    const TriangleMesh mesh = read_mesh(path("a.3ds"));
    const Rotation one = Rotation::about({0, 0, 1}, -kRight / 3), two = Rotation::about({1, 0, 0}, -kRight);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec3d pivot(kPivot), arm = Vec3d(mesh.vertices[i]) - pivot;
        EXPECT_NEAR(length(Vec3d(vertices_at(cache, 0.4)[i]) - pivot - one.apply(arm)), 0, 1e-5);
        EXPECT_NEAR(length(Vec3d(vertices_at(cache, 0.8)[i]) - pivot - two.apply(one.apply(arm))), 0, 1e-5);
    }
}

TEST_F(Read3ds, RefusesAnAnimationThatItCannotFollow) {
    const auto expect_unfollowed = [&](const std::string& sentence, const std::string& nodes) {
        expect_error(ErrorCode::InvalidMesh, sentence, [&] { read_cache(file_of(object(kBox), nodes)); });
    };
    expect_unfollowed("the file has no animation", node(0, "box", kNoParent, kQuarter));
    const std::string words_of_parent = "the keyframes of the object 'box' belong to a node below a light";
    expect_unfollowed(words_of_parent, chunk(0xB003, chunk(0xB030, words({0}))) + node(1, "box", 0, kRises));
    expect_unfollowed(words_of_parent, node(0, "box", 0, kRises));
}

TEST_F(Read3ds, ReadsAnEnormousTreeOfNodes) {
    std::string nodes = node(0, "box", kNoParent, kQuarter);
    for (std::uint16_t i = 1; i < 60'000; ++i)
        nodes += node(i, "$$$DUMMY", static_cast<std::uint16_t>(i - 1));
    expect_same_faces(read(file_of(object(kBox), nodes)), kBox);
}

TEST_F(Read3ds, RefusesASmallFileOfWhichAHugeMeshWouldBeMade) {
    TriangleMesh mesh = kBox;
    mesh.faces.assign(60'000, {0, 1, 2});
    std::string nodes;
    for (std::uint16_t i = 0; i < 5000; ++i) nodes += node(i, "box", kNoParent, kQuarter);
    expect_refused(ErrorCode::InvalidMesh, "the file names the same data so often",
                   file_of(object(mesh), nodes));
}

TEST_F(Read3ds, NoticesThatAFileIsShorterThanItSays) {
    const std::string whole = file_of(object(kBox));
    expect_refused(ErrorCode::Damaged, "the file says that it has", whole.substr(0, whole.size() - 1));
    EXPECT_EQ(read(whole + "spare").faces.size(), kBox.faces.size());
}

TEST_F(Read3ds, RefusesAFaceThatRefersToAMissingVertex) {
    TriangleMesh box = make_box({1, 2, 3});
    box.faces[5][1] = 8;
    expect_refused(ErrorCode::InvalidMesh,
                   "face 5 of the mesh 'box' refers to vertex 8, but there are 8 vertices, numbered from 0",
                   file_of(object(box)));
}

TEST_F(Read3ds, RefusesCoordinatesThatAreNotFinite) {
    TriangleMesh box = kBox;
    box.vertices[3].y = std::numeric_limits<float>::infinity();
    expect_refused(ErrorCode::InvalidMesh, "vertex 3 of the mesh 'box' is not finite", file_of(object(box)));
}

TEST_F(Read3ds, RefusesListsAndChunksThatPromiseMoreThanTheyHave) {
    const auto mesh = [](const std::string& content) {
        return file_of(chunk(0x4000, name("box") + chunk(0x4100, content)));
    };
    expect_refused(ErrorCode::Damaged, "a list of 65535 faces has only 0 bytes",
                   mesh(chunk(0x4120, "\xFF\xFF")));
    expect_refused(ErrorCode::Damaged, "a list of 65535 vertices has only 0 bytes",
                   mesh(chunk(0x4110, "\xFF\xFF")));
    std::string longer = chunk(0x4120, words({0}));
    longer[2] = 99;
    expect_refused(ErrorCode::Damaged, "the chunk at byte 38 says that it has 99 bytes, but 8 remain",
                   mesh(longer));
    expect_refused(
        ErrorCode::Damaged, "the chunk that ends at byte",
        file_of(object(kBox), chunk(0xB002, chunk(0xB020, words({0, 0, 0, 0, 0, 0xFFFF, 0xFFFF})))));
    expect_refused(ErrorCode::Damaged, "the chunk that ends at byte",
                   file_of(chunk(0x4000, "no end of the name")));
}

TEST_F(Read3ds, RefusesOtherFormats) {
    expect_refused(ErrorCode::WrongFormat, "the bytes 4D 4D", "\x89PNG\r\n\x1a\n and some more bytes");
}
