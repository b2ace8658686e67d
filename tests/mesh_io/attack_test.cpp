#include "mesh_io/exported_files.hpp"
#include "mesh_io/readers.hpp"
#include "mesh_io/write_mesh.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>
#include <vector>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

// A reader of hostile bytes either refuses them with an Error or gives a mesh that all other functions
// accept.

namespace {

struct SmallFile {
    std::string name;
    std::string content;
};

class Attack : public TemporaryFolderTest {
  protected:
    std::vector<SmallFile> small_files() const {
        const TriangleMesh mesh{{{0, 0, 0}, {1.25F, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
        std::vector<SmallFile> files{{"ours.obj", encode_obj(mesh)},
                                     {"ours.off", encode_off(mesh)},
                                     {"ours.ply", encode_ply(mesh)},
                                     {"ours.stl", encode_stl(mesh)}};
        for (const ExportedKind& kind : kExportedKinds) {
            if (!can_export()) break;
            const std::string name = std::string("exported_") + kind.exporter + kind.ending;
            export_with_assimp(path(name), mesh, kind);
            std::ifstream stream(path(name), std::ios::binary);
            files.push_back({name, {std::istreambuf_iterator<char>(stream), {}}});
        }
        return files;
    }

    /// @returns whether the bytes were taken as a mesh
    bool attack(const std::string& name, std::string_view content) const {
        // A buffer of exactly this size: the address sanitizer sees every read beyond it.
        const std::vector<char> bytes(content.begin(), content.end());
        const MeshSource source{path(name).string(), {bytes.data(), bytes.size()}};
        try {
            const MeshReport report = inspect(read_mesh(source));
            EXPECT_GT(report.face_count, 0U);
            return true;
        } catch (const Error& error) {
            const std::string sentence = error.what();
            EXPECT_TRUE(sentence.starts_with(source.name + ": ")) << sentence;
            EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
            return false;
        }
    }
};

/// Up to the last word that the format requires: a name may follow it in text STL.
std::size_t end_of_promises(const SmallFile& file) {
    const std::size_t end_of_solid = file.content.find("endsolid");
    if (end_of_solid != std::string::npos) return end_of_solid + 8;
    return file.content.find_last_not_of('\n');
}

} // namespace

TEST_F(Attack, FilesCutAtEveryLengthAreRefusedOrGiveAValidMesh) {
    for (const SmallFile& file : small_files()) {
        SCOPED_TRACE(file.name);
        EXPECT_TRUE(attack(file.name, file.content));
        for (std::size_t length = 0; length < file.content.size(); ++length)
            attack(file.name, file.content.substr(0, length));
    }
}

TEST_F(Attack, FilesThatStateTheirSizeAreNotTakenWhenCut) {
    for (const SmallFile& file : small_files()) {
        if (file.name.ends_with(".obj") || file.name.ends_with(".gltf")) continue; // these state none
        SCOPED_TRACE(file.name);
        for (std::size_t length = 0; length < end_of_promises(file); ++length)
            ASSERT_FALSE(attack(file.name, file.content.substr(0, length))) << "cut at " << length;
    }
}

TEST_F(Attack, NoBeginningOfAFileThatIsReadIsRefused) {
    for (const SmallFile& file : small_files()) {
        SCOPED_TRACE(file.name);
        for (std::size_t length = 84; length <= file.content.size(); ++length) {
            const MeshSource beginning{file.name, std::string_view(file.content).substr(0, length)};
            EXPECT_NO_THROW(require_beginning(beginning)) << "cut at " << length;
        }
    }
}

TEST_F(Attack, AFileIsNotTakenWhenItsBeginningIsRefused) {
    std::mt19937 random(3);
    for (const SmallFile& file : small_files()) {
        SCOPED_TRACE(file.name);
        std::size_t refused_count = 0;
        for (int round = 0; round < 400; ++round) {
            std::string spoilt = file.content;
            spoilt[random() % 5] = static_cast<char>(random());
            if (spoilt.size() > 84) // the number of faces, where it is a binary STL
                spoilt.replace(80, 4, {static_cast<char>(random() % 5), '\0', '\0', '\0'});
            try {
                require_beginning({file.name, spoilt});
            } catch (const Error&) {
                ++refused_count;
                ASSERT_FALSE(attack(file.name, spoilt));
            }
        }
        EXPECT_GT(refused_count, 0U);
    }
}

TEST_F(Attack, ZerosAndNoiseAreRefusedByTheirBeginning) {
    std::mt19937 random(4);
    std::string noise(65'536, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    for (const std::string ending : {".obj", ".off", ".ply", ".stl", ".gltf", ".glb", ".3ds", ".txt"}) {
        SCOPED_TRACE(ending);
        EXPECT_THROW(require_beginning({ending, std::string(65'536, '\0')}), Error);
        if (ending == ".stl") continue; // noise promises a huge number of faces
        EXPECT_THROW(require_beginning({ending, noise}), Error);
    }
}

TEST_F(Attack, FilesWithSpoiltBytesAreRefusedOrGiveAValidMesh) {
    std::mt19937 random(1);
    for (const SmallFile& file : small_files()) {
        SCOPED_TRACE(file.name);
        for (int round = 0; round < 400; ++round) {
            std::string spoilt = file.content;
            for (unsigned i = 0, count = 1 + random() % 3; i < count; ++i)
                spoilt[random() % spoilt.size()] = static_cast<char>(random());
            attack(file.name, spoilt);
        }
    }
}

TEST_F(Attack, FilesWithExchangedDigitsAreRefusedOrGiveAValidMesh) {
    std::mt19937 random(2);
    for (const SmallFile& file : small_files()) {
        SCOPED_TRACE(file.name);
        for (int round = 0; round < 200; ++round) {
            std::string spoilt = file.content;
            for (char& c : spoilt)
                if (c >= '0' && c <= '9' && random() % 40 == 0) c = "0123456789-.e+#/"[random() % 16];
            attack(file.name, spoilt);
        }
    }
}
