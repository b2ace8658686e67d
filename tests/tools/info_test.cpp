#include "tools/command_line.hpp"
#include "tools/sample_files.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

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
    EXPECT_NE(text.find("--repair finds nothing to mend"), std::string::npos) << text;
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
        std::filesystem::path(ECHINUS_SOURCE_FOLDER) / "../shared/meshes/horse_glmark2_raw.off";
    if (!std::filesystem::exists(horse)) GTEST_SKIP() << "the development meshes are not there";
    const json report = info(horse.string());
    EXPECT_EQ(report["faces"], 7172);
    EXPECT_EQ(report["closed"], false);
    EXPECT_EQ(report["border_edges"], 0);
    EXPECT_EQ(report["nonmanifold_edges"], 24);
    EXPECT_EQ(report["repair"]["closed_then"], true);
}
