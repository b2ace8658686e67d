#include "tools/command_line.hpp"

#include <echinus/mesh_io.hpp>

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
    expect_failure(2, "subcommand", {"mesh"});
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
    expect_failure(2, "this file is read",
                   {"mesh", "repair", "box.obj", "--drop-inner-faces", "-o", "./box.obj"});
    EXPECT_FALSE(std::filesystem::exists(path("out.obj")));
}
