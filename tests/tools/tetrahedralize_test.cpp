#include "tools/command_line.hpp"
#include "tools/sample_files.hpp"

#include <echinus/mesh_io.hpp>

#include <nlohmann/json.hpp>

using namespace echinus;
using namespace echinus::test;
using nlohmann::json;

namespace {

class TetrahedralizeCommand : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        write("torus.obj", obj_text(make_torus(1, 0.4, 40, 16)));
    }
};

} // namespace

TEST_F(TetrahedralizeCommand, WritesABodyThatReadsBackAndSaysWhatItIsLike) {
    const json report = json::parse(
        expect_success({"tetrahedralize", "torus.obj", "-o", "torus.msh", "--size", "0.15", "--json"}));
    const TetrahedraFile file = read_tetrahedra(path("torus.msh"));
    EXPECT_EQ(report["tetrahedra"], file.mesh.tetrahedra.size());
    EXPECT_EQ(report["vertices"], file.mesh.vertices.size());
    EXPECT_EQ(report["size"], 0.15);
    EXPECT_EQ(report["components"], 1);
    EXPECT_GT(report["least_angle_deg"], 9);
    EXPECT_LT(report["greatest_angle_deg"], 165);
    EXPECT_NEAR(report["volume"].get<double>(), inspect_tetrahedra(file.mesh).volume, 1e-9);
    EXPECT_LT(report["greatest_to_model"], 0.05);
    EXPECT_EQ(report["removed_tetrahedra"], 0);
    expect_success({"tetrahedralize", "torus.obj", "-o", "torus.vtk", "--size", "0.15", "--threads", "1"});
    EXPECT_EQ(read_tetrahedra(path("torus.vtk")).mesh.tetrahedra, file.mesh.tetrahedra);
}

TEST_F(TetrahedralizeCommand, MeetsACount) {
    const auto count = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"tetrahedralize", "torus.obj", "-o", "torus.msh", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return json::parse(expect_success(arguments))["tetrahedra"].get<double>();
    };
    EXPECT_NEAR(count({"--count", "2000"}), 2000, 100);
    EXPECT_NEAR(count({}), 10'000, 500);
}

TEST_F(TetrahedralizeCommand, PrintsATableOrTheBodyItself) {
    const std::string table =
        expect_success({"tetrahedralize", "torus.obj", "-o", "torus.msh", "--count", "500"});
    EXPECT_NE(table.find("dihedral angles"), std::string::npos) << table;
    const std::string body = expect_success({"tetrahedralize", "torus.obj", "-o", "-", "--count", "500"});
    EXPECT_EQ(body, content("torus.msh"));
}

TEST_F(TetrahedralizeCommand, RefusesWhatItCannotDo) {
    write("open.obj", open_box_text());
    expect_failure(1, "open.obj: the mesh is not closed", {"tetrahedralize", "open.obj", "-o", "a.msh"});
    expect_failure(2, "must end in .msh or .vtk, or be -; it is a.stl",
                   {"tetrahedralize", "torus.obj", "-o", "a.stl"});
    expect_failure(1, "torus.obj: no tetrahedra of the size 5",
                   {"tetrahedralize", "torus.obj", "-o", "a.msh", "--size", "5"});
    expect_failure(2, "finite and positive", {"tetrahedralize", "torus.obj", "-o", "a.msh", "--size", "-1"});
    expect_failure(2, "must be given, and positive",
                   {"tetrahedralize", "torus.obj", "-o", "a.msh", "--size", "0"});
    expect_failure(2, "more tetrahedra than the limit of 50",
                   {"tetrahedralize", "torus.obj", "-o", "a.msh", "--size", "0.1", "--most", "50"});
    expect_failure(2, "--count",
                   {"tetrahedralize", "torus.obj", "-o", "a.msh", "--size", "1", "--count", "5"});
}
