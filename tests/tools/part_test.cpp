#include "support/meshes.hpp"
#include "tools/command_line.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

using namespace echinus;
using namespace echinus::test;
using nlohmann::json;

namespace {

/// A sheet through a ball.
class PartCommand : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        write("ball.obj", obj_text(make_sphere(0.3, 24, 12)));
        write("sheet.obj", obj_text(translated(sheet_mesh(15, 15), {0, 0, 0.05F})));
    }
};

} // namespace

TEST_F(PartCommand, MovesASheetOutOfABallAndTellsHowMuchItIsStretched) {
    const json result = json::parse(
        expect_success({"part", "sheet.obj", "--model", "ball.obj", "-o", "parted.obj", "--json"}));
    EXPECT_EQ(result["parted"], true);
    EXPECT_GT(result["models"][0]["pairs_before"], 0);
    EXPECT_EQ(result["models"][0]["pairs"], 0);
    EXPECT_EQ(result["vertices_inside"], 0);
    EXPECT_LT(result["stretched_share"], 0.1);
    const TriangleMesh parted = read_mesh(path("parted.obj"));
    EXPECT_EQ(parted.vertices.size(), 225U);
    EXPECT_TRUE(intersecting_pairs(parted, read_mesh(path("ball.obj"))).empty());
    const std::string text =
        expect_success({"part", "sheet.obj", "--model", "ball.obj", "-o", "parted.obj", "--threads", "1"});
    EXPECT_NE(text.find("pairs with ball.obj"), std::string::npos) << text;
    EXPECT_NE(expect_success({"part", "sheet.obj", "-o", "-"}).find("\nf "), std::string::npos);
}

TEST_F(PartCommand, BringsSeveralMeshesIntoTheirOrderAndKeepsWhatElseTheirFilesHold) {
    const TriangleMesh flat = sheet_mesh(15, 15);
    TriangleMesh wave = translated(sheet_mesh(15, 15), {0.003F, 0.002F, 0});
    for (Vec3f& v : wave.vertices) v.z = 0.05F * std::sin(9 * v.x);
    write("inner.obj", "# lining\nvt 0.5 0.5\n" + obj_text(flat));
    write("outer.obj", obj_text(wave));
    const json result =
        json::parse(expect_success({"part", "inner.obj", "outer.obj", "-o", "parted", "--json"}));
    EXPECT_GT(result["own_pairs_before"], 0);
    EXPECT_EQ(result["own_pairs"], 0);
    EXPECT_TRUE(content("parted/inner.obj").starts_with("# lining\nvt 0.5 0.5\nv "));
    const TriangleMesh inner = read_mesh(path("parted/inner.obj")),
                       outer = read_mesh(path("parted/outer.obj"));
    EXPECT_TRUE(intersecting_pairs(inner, outer).empty());
    EXPECT_GT(outer.vertices[112].z, inner.vertices[112].z);
    const std::string swapped = expect_success({"part", "outer.obj", "inner.obj", "-o", "parted"});
    EXPECT_NE(swapped.find("pairs with themselves and each other"), std::string::npos) << swapped;
    EXPECT_LT(read_mesh(path("parted/outer.obj")).vertices[112].z,
              read_mesh(path("parted/inner.obj")).vertices[112].z);
}

TEST_F(PartCommand, WarnsOfPolygonsThatItHasToDivideOnlyWhereAnObjCouldHaveKeptThem) {
    const ProgramResult as_ply = run({"part", "sheet.obj", "--model", "ball.obj", "-o", "parted.ply"});
    EXPECT_EQ(as_ply.exit_status, 0) << as_ply.error;
    EXPECT_EQ(as_ply.error.find("polygons"), std::string::npos) << as_ply.error;
    const std::string pentagon =
        "v -1 -1 0.02\nv 1 -1 0\nv 1.5 0.5 0\nv 0 -0.4 0.02\nv -1.5 0.5 0\nf 1 2 3 4 5\n";
    write("pentagon.obj", pentagon);
    const ProgramResult as_obj =
        run({"part", "pentagon.obj", "--model", "ball.obj", "-o", "parted.obj", "--best"});
    EXPECT_EQ(as_obj.exit_status, 0) << as_obj.error;
    EXPECT_EQ(read_mesh(path("parted.obj")).faces, read_mesh(path("pentagon.obj")).faces) << as_obj.error;
}

TEST_F(PartCommand, FailsForWhatCannotBePartedUnlessTheBestIsWanted) {
    write("bottle.obj", obj_text(klein_bottle()));
    expect_failure(1, "bottle.obj could not be parted: ", {"part", "bottle.obj", "-o", "parted.obj"});
    const ProgramResult best = run({"part", "bottle.obj", "-o", "parted.obj", "--best", "--json"});
    EXPECT_EQ(best.exit_status, 0);
    EXPECT_NE(best.error.find("warning: bottle.obj could not be parted: "), std::string::npos) << best.error;
    EXPECT_EQ(json::parse(best.output)["parted"], false);
    EXPECT_EQ(read_mesh(path("parted.obj")).vertices.size(), klein_bottle().vertices.size());
}

TEST_F(PartCommand, RefusesArgumentsThatMakeNoSense) {
    expect_failure(2, "-o", {"part", "sheet.obj"});
    expect_failure(1, "none.obj", {"part", "sheet.obj", "--model", "none.obj", "-o", "a.obj"});
    expect_failure(2, "the thickness is 0", {"part", "sheet.obj", "-o", "a.obj", "--thickness", "0"});
    expect_failure(2, "named twice", {"part", "-", "--model", "-", "-o", "a.obj"});
    expect_failure(2, "several meshes need a folder", {"part", "sheet.obj", "ball.obj", "-o", "-"});
    expect_failure(2, "two meshes are called sheet.obj", {"part", "sheet.obj", "other/sheet.obj", "-o", "a"});
    expect_failure(2, "input file", {"part", "sheet.obj", "ball.obj", "-o", "."});
}
