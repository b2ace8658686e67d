#include "tools/command_line.hpp"

#include <echinus/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>

using MainCommand = CommandLineTest;

TEST_F(MainCommand, PrintsItsVersion) {
    EXPECT_EQ(expect_success({"--version"}), "echinus " ECHINUS_VERSION "\n");
}

TEST_F(MainCommand, TellsTheExitStatusesInItsHelp) {
    EXPECT_NE(expect_success({"--help"}).find("Exit status: 0 success, 1 failure, 2 usage error"),
              std::string::npos);
}

TEST_F(MainCommand, RefusesAMissingOrUnknownCommandAsWrongUse) {
    expect_failure(2, "A command is required", {});
    expect_failure(2,
                   "there is no command 'frobnicate'; the commands are mesh, info, check, part, build, query",
                   {"frobnicate", "x.obj"});
    expect_failure(2, "there is no command 'frobnicate'; the commands are mesh, map, moment, sheet",
                   {"render", "frobnicate"});
    expect_failure(2, "there is no option --frobnicate;", {"--frobnicate"});
}

TEST_F(MainCommand, NamesWhatIsNearestToAMistypedWord) {
    expect_failure(2, "there is no command 'simulat'; the nearest is simulate; the commands are mesh",
                   {"simulat", "x.json"});
    expect_failure(2, "there is no command 'shet'; the nearest is sheet", {"render", "shet"});
    expect_failure(2, "there is no option --verson; the nearest is --version", {"--verson"});
    // Also where something else is missing.
    expect_failure(2, "there is no option --direction; the nearest is --directions",
                   {"build", "x.obj", "--direction", "200"});
    expect_failure(2, "there is no option --outpt; the nearest is --output", {"build", "x.obj", "--outpt=y"});
}

TEST_F(MainCommand, NamesTheOptionWhoseValueItCannotTake) {
    expect_failure(2, "--directions: '=' is not a valid value; write it as --directions VALUE or",
                   {"build", "x.obj", "--directions", "=", "200", "-o", "y"});
    expect_failure(
        2, "--directions: 'many' is not a valid value; expected COUNTxCOUNT; see echinus build --help",
        {"build", "x.obj", "--directions", "many", "-o", "y"});
}

TEST_F(MainCommand, TellsWhereTheComparisonWentWhateverItsArguments) {
    expect_failure(2, "echinus-compare", {"compare"});
    expect_failure(2, "--target echinus-compare", {"compare", "torus.obj", "--systems", "exact,dense"});
    expect_failure(2, "echinus-compare", {"compare", "--help"});
}

TEST_F(MainCommand, SaysOnOneLineAlsoWhatAnArgumentWithNewlinesBroke) {
    expect_failure(2, "two lines", {"two\nlines"});
}

TEST_F(MainCommand, TellsOfAnInstructionSetThatTheMachineDoesNotHave) {
    setenv("ECHINUS_INSTRUCTION_SET", "abacus", 1);
    expect_failure(2, "'abacus'", {"--version"});
    setenv("ECHINUS_INSTRUCTION_SET", "scalar", 1);
    expect_success({"--version"});
    unsetenv("ECHINUS_INSTRUCTION_SET");
}

using namespace echinus::test;
using nlohmann::json;

namespace {

class InfoCommand : public CommandLineTest {
  protected:
    json info(const std::string& file) const { return json::parse(expect_success({"info", file, "--json"})); }
};

} // namespace

TEST_F(InfoCommand, DescribesAClosedMesh) {
    write("torus.obj", obj_text(echinus::make_torus(1, 0.4, 60, 24)));
    const json torus = info("torus.obj");
    EXPECT_EQ(torus["faces"], 2880);
    EXPECT_EQ(torus["vertices"], 1440);
    EXPECT_EQ(torus["closed"], true);
    EXPECT_EQ(torus["manifold"], true);
    EXPECT_EQ(torus["components"], 1);
    for (const char* fault :
         {"border_edges", "nonmanifold_edges", "misoriented_edges", "duplicate_faces", "degenerate_faces"}) {
        EXPECT_EQ(torus[fault], 0) << fault;
    }
    // The volume of the round torus is 2 pi^2 r^2 R = 3.158; the 60 x 24 segments cut a little off.
    EXPECT_NEAR(torus["volume"].get<double>(), 3.158, 0.06);
    EXPECT_NEAR(torus["radius"].get<double>(), 1.4, 1e-6);
    ASSERT_EQ(torus["centre"].size(), 3u);
    for (const json& coordinate : torus["centre"]) EXPECT_NEAR(coordinate.get<double>(), 0, 1e-6);
}

TEST_F(InfoCommand, NamesTheFirstFacesAtAHole) {
    write("open.obj", open_box_text());
    const json box = info("open.obj");
    EXPECT_EQ(box["closed"], false);
    EXPECT_EQ(box["border_edges"], 3);
    EXPECT_EQ(box["first_faces"]["border_edges"].size(), 3u);
    const std::string text = expect_success({"info", "open.obj"});
    EXPECT_NE(text.find("3, at faces"), std::string::npos) << text;
    EXPECT_NE(text.find("--repair finds nothing to repair"), std::string::npos) << text;
}

TEST_F(InfoCommand, ForetellsWhatRepairWouldDo) {
    write("doubled.obj", doubled_face_text());
    const json box = info("doubled.obj");
    EXPECT_EQ(box["closed"], false);
    EXPECT_EQ(box["duplicate_faces"], 1);
    EXPECT_EQ(box["repair"]["duplicate_faces_dropped"], 1);
    EXPECT_EQ(box["repair"]["closed_then"], true);
    const std::string text = expect_success({"info", "doubled.obj"});
    EXPECT_NE(text.find("With --repair: 1 duplicate face dropped; then the mesh is closed."),
              std::string::npos)
        << text;
}

TEST_F(InfoCommand, DescribesAMapAsTheBuildDid) {
    write("box.obj", box_text());
    for (const char* kind : {"exact", "distance"}) {
        const std::vector<std::string> build{"build", "box.obj", "--kind", kind, "-o", "box.ech"};
        std::vector<std::string> build_json = build;
        build_json.emplace_back("--json");
        const json built = json::parse(expect_success(build_json));
        EXPECT_EQ(built["kind"], kind);
        EXPECT_EQ(info("box.ech"), built);
        EXPECT_EQ(built["file_bytes"], std::filesystem::file_size(path("box.ech")));
        const std::string text = expect_success(build);
        EXPECT_EQ(expect_success({"info", "box.ech"}), text);
    }
}

TEST_F(InfoCommand, ShowsTheHistogramOfEntries) {
    write("box.obj", box_text());
    expect_success({"build", "box.obj", "--kind", "distance", "--directions", "24x12", "-o", "box.ech"});
    const std::string text = expect_success({"info", "box.ech"});
    EXPECT_NE(text.find("entries  directions\n        1         288  100.0 %"), std::string::npos) << text;
}

TEST_F(InfoCommand, ReadsStandardInput) {
    write("box.obj", box_text());
    expect_success({"build", "box.obj", "--kind", "distance", "--directions", "24x12", "-o", "box.ech"});
    EXPECT_EQ(json::parse(expect_success({"info", "-", "--json"}, content("box.ech"))), info("box.ech"));
    EXPECT_EQ(json::parse(expect_success({"info", "-", "--format", "obj", "--json"}, box_text())),
              info("box.obj"));
    expect_failure(2, "--format", {"info", "-"}, box_text());
    expect_failure(1, "standard input", {"info", "-", "--format", "ply"}, "no ply\n");
}

TEST_F(InfoCommand, RefusesADamagedMapByName) {
    write("box.obj", box_text());
    expect_success({"build", "box.obj", "--kind", "distance", "--directions", "24x12", "-o", "box.ech"});
    const std::string map = content("box.ech");
    write("half.ech", map.substr(0, map.size() / 2));
    expect_failure(1, "half.ech: the map file is truncated or damaged", {"info", "half.ech"});
}

TEST_F(InfoCommand, NoticesThatItsOutputGoesNowhere) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    write("box.obj", box_text());
    const ProgramResult result = run({"info", "box.obj"}, "", "/dev/full");
    EXPECT_EQ(result.exit_status, 1);
    EXPECT_EQ(result.error_line_count(), 1u) << result.error;
}

TEST_F(InfoCommand, ShowsThatTheDirtyHorseCanBeMended) {
    const std::filesystem::path horse =
        std::filesystem::path(ECHINUS_SHARED) / "meshes/horse_glmark2_raw.off";
    if (!std::filesystem::exists(horse)) GTEST_SKIP() << "there is no file " << horse;
    const json report = info(horse.string());
    EXPECT_EQ(report["faces"], 7172);
    EXPECT_EQ(report["closed"], false);
    EXPECT_EQ(report["border_edges"], 0);
    EXPECT_EQ(report["nonmanifold_edges"], 24);
    EXPECT_EQ(report["repair"]["closed_then"], true);
}

using namespace echinus;

using MeshCommand = CommandLineTest;

TEST_F(MeshCommand, MakesThePapersTorus) {
    EXPECT_EQ(expect_success({"mesh", "torus", "--major", "1", "--minor", "0.4", "--segments", "60x24", "-o",
                              "torus.obj"}),
              "");
    const MeshReport report = inspect(read_mesh(path("torus.obj")));
    EXPECT_EQ(report.face_count, 2880U);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_NEAR(report.bounding_sphere.radius, 1.4, 1e-6);
}

TEST_F(MeshCommand, MakesASphereAndABoxInOtherFormats) {
    expect_success({"mesh", "sphere", "--radius", "2", "--segments", "60x30", "-o", "sphere.ply"});
    const MeshReport sphere = inspect(read_mesh(path("sphere.ply")));
    EXPECT_EQ(sphere.face_count, 2U * 60 * 29);
    EXPECT_NEAR(sphere.bounding_sphere.radius, 2, 1e-6);

    expect_success({"mesh", "box", "--size", "1x2x0.5", "--segments", "4", "-o", "box.stl"});
    const MeshReport box = inspect(read_mesh(path("box.stl")));
    EXPECT_EQ(box.face_count, 12U * 16);
    EXPECT_NEAR(box.signed_volume, 1, 1e-6);
    EXPECT_TRUE(box.closed);
}

TEST_F(MeshCommand, WritesObjToStandardOutput) {
    write("box.obj", expect_success({"mesh", "box", "--size", "1x1x1", "--segments", "4", "-o", "-"}));
    EXPECT_EQ(inspect(read_mesh(path("box.obj"))).face_count, 192U);
}

TEST_F(MeshCommand, ShowsAnExampleInTheHelpOfEachShape) {
    for (const std::string shape : {"torus", "sphere", "box"}) {
        const std::string help = expect_success({"mesh", shape, "--help"});
        EXPECT_NE(help.find("Example: echinus mesh " + shape + " --"), std::string::npos);
        EXPECT_TRUE(help.ends_with("\n"));
    }
}

TEST_F(MeshCommand, RefusesWrongUse) {
    expect_failure(2, "A command (torus, sphere, box or repair)", {"mesh"});
    expect_failure(2, "cone", {"mesh", "cone", "-o", "a.obj"});
    expect_failure(2, "--output", {"mesh", "torus"});
    expect_failure(2, "--segments", {"mesh", "torus", "--segments", "60", "-o", "a.obj"});
    expect_failure(2, "--segments", {"mesh", "torus", "--segments", "60x-1", "-o", "a.obj"});
    expect_failure(2, "--major", {"mesh", "torus", "--major", "wide", "-o", "a.obj"});
    expect_failure(2, "minor radius", {"mesh", "torus", "--minor", "2", "-o", "a.obj"});
    expect_failure(2, "the radius of a sphere is nan", {"mesh", "sphere", "--radius", "nan", "-o", "a.obj"});
    expect_failure(2, "3 meridians", {"mesh", "sphere", "--segments", "2x2", "-o", "a.obj"});
    expect_failure(2, "2^27", {"mesh", "sphere", "--segments", "4000000000x4000000000", "-o", "a.obj"});
    expect_failure(2, "the edge length of a box is 0", {"mesh", "box", "--size", "1x0x1", "-o", "a.obj"});
    for (const char* size : {"1x1", "1x1x1x1", "1xx1", "axbxc"})
        expect_failure(2, "--size", {"mesh", "box", "--size", size, "-o", "a.obj"});
    for (const char* name : {"a.glb", "a", ".obj", "a.obj.gz"})
        expect_failure(2, std::string("must end in .obj, .ply, .stl or .off, or be -; it is ") + name,
                       {"mesh", "box", "-o", name});
    expect_success({"mesh", "box", "-o", "BOX.OBJ"});
}

TEST_F(MeshCommand, ReportsAFileThatCannotBeWritten) {
    expect_failure(1, "missing/a.obj", {"mesh", "box", "-o", "missing/a.obj"});
}

TEST_F(MeshCommand, RepairsAMeshAndMakesItSolid) {
    TriangleMesh box = make_box({1, 1, 1}, 2);
    box.faces.push_back(box.faces[0]);
    box.faces.erase(box.faces.begin() + 5);
    write_mesh(path("box.obj"), box);
    EXPECT_EQ(expect_success({"mesh", "repair", "box.obj", "-o", "mended.obj"}),
              "1 duplicate face dropped; the mesh is not closed now\n");
    EXPECT_EQ(expect_success({"mesh", "repair", "box.obj", "--close-holes", "3", "-o", "solid.obj"}),
              "1 duplicate face dropped, 1 hole closed; the mesh is closed now\n");
    EXPECT_TRUE(inspect(read_mesh(path("solid.obj"))).closed);
    EXPECT_NEAR(inspect(read_mesh(path("solid.obj"))).signed_volume, 1, 1e-6);
    EXPECT_NE(expect_success({"mesh", "repair", "box.obj", "--thicken", "0.1", "--json", "-o", "shell.ply"})
                  .find("\"sheets_thickened\": 1"),
              std::string::npos);
    EXPECT_TRUE(inspect(read_mesh(path("shell.ply"))).closed);
}

TEST_F(MeshCommand, RefusesAnImpossibleRepair) {
    write_mesh(path("box.obj"), make_box({1, 1, 1}));
    const auto repair = [](const std::string& option, const std::string& value) {
        return std::vector<std::string>{"mesh", "repair", "box.obj", option, value, "-o", "out.obj"};
    };
    expect_failure(2, "--close-holes", repair("--close-holes", "257"));
    expect_failure(2, "--close-holes", repair("--close-holes", "-1"));
    for (const char* wrong : {"0", "-1", "nan", "inf", "thick", ""})
        expect_failure(2, "--thicken", repair("--thicken", wrong));
    expect_failure(2, "is an input file",
                   {"mesh", "repair", "box.obj", "--drop-inner-faces", "-o", "./box.obj"});
    EXPECT_FALSE(std::filesystem::exists(path("out.obj")));
}

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
