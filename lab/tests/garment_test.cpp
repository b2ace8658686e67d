// The script garment, which needs Python.

#include "tools/command_line.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/simulation.hpp>

#include <cstdlib>
#include <fstream>
#include <iterator>

using namespace echinus;

namespace {

const std::filesystem::path kSource = ECHINUS_SOURCE_FOLDER;

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Garment : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        if (std::system("python3 --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "there is no python3";
    }
    /// Runs the script with these arguments. @return the file that it made
    std::filesystem::path make(const std::string& arguments) const {
        const std::filesystem::path made = path("made.obj");
        const std::string script = "'" + (kSource / "lab" / "garment").string() + "' ";
        EXPECT_EQ(std::system((script + arguments + " -o '" + made.string() + "'").c_str()), 0);
        return made;
    }
};

} // namespace

TEST_F(Garment, OfAShirtAndASkirtIsSewnAllRoundAndTouchesItselfNowhere) {
    for (const char* spacing : {"0.1", "0.2"}) {
        const TriangleMesh outfit = read_mesh(make(std::string("shirt skirt --spacing ") + spacing));
        const MeshReport report = inspect(outfit);
        EXPECT_EQ(report.component_count, 2u);
        EXPECT_TRUE(report.manifold);
        EXPECT_EQ(report.misoriented_edges.count, 0u);
        EXPECT_TRUE(self_intersecting_pairs(outfit).empty());
        EXPECT_EQ(make_cloth(outfit, {}).faces, outfit.faces);
    }
}

TEST_F(Garment, MakesTheFlagOfTheSceneThatShips) {
    EXPECT_EQ(bytes_of(make("flag --spacing 0.07")), bytes_of(kSource / "scenes" / "meshes" / "flag.obj"));
}
