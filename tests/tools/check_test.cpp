#include "support/meshes.hpp"
#include "tools/command_line.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::test;
using nlohmann::json;

namespace {

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& [a, b, c] : other.faces) mesh.faces.push_back({a + first, b + first, c + first});
    return mesh;
}

/// A dress of one sheet through a body, which crosses itself, and a hat beside both.
class CheckCommand : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        const TriangleMesh ball = make_sphere(1, 24, 12);
        body_ = joined(ball, translated(ball, {0.53F, 0.02F, 0.01F}));
        dress_ = make_box({3, 3, 0.5}, 5);
        dress_.faces.pop_back();
        write("body.obj", obj_text(body_));
        write("dress.obj", obj_text(dress_));
        write("hat.obj", obj_text(translated(make_box({1, 1, 1}), {0, 0, 5})));
    }

    TriangleMesh body_, dress_;
};

} // namespace

TEST_F(CheckCommand, TellsWhatIntersectsWhatWhatItselfAndHowDeep) {
    const json result = json::parse(expect_success({"check", "dress.obj", "body.obj", "hat.obj", "--json"}));
    EXPECT_EQ(result["intersecting"], true);
    ASSERT_EQ(result["meshes"].size(), 3U);
    EXPECT_EQ(result["meshes"][1]["file"], "body.obj");
    EXPECT_EQ(result["meshes"][1]["faces"], body_.faces.size());
    ASSERT_EQ(result["between"].size(), 1U);
    const json& between = result["between"][0];
    EXPECT_EQ(between["a"], 0);
    EXPECT_EQ(between["b"], 1);
    EXPECT_EQ(between["pairs"], intersecting_pairs(dress_, body_).size());
    EXPECT_EQ(between["first_pairs"].size(), 8U);
    EXPECT_GT(between["curves"], 0);
    EXPECT_GT(between["curve_length"], 6);
    EXPECT_EQ(between["b_in_a"], nullptr); // the dress is open
    EXPECT_EQ(between["a_in_b"]["vertices"] > 0, between["a_in_b"]["depth"] > 0);
    ASSERT_EQ(result["own"].size(), 1U);
    EXPECT_EQ(result["own"][0]["mesh"], 1);
    EXPECT_EQ(result["own"][0]["pairs"], self_intersecting_pairs(body_).size());
}

TEST_F(CheckCommand, PrintsATableForEachAndASentenceWhereNothingIntersects) {
    const std::string text = expect_success({"check", "dress.obj", "body.obj", "hat.obj"});
    EXPECT_NE(text.find("dress.obj and body.obj\n"), std::string::npos) << text;
    EXPECT_NE(text.find("body.obj and itself\n"), std::string::npos) << text;
    EXPECT_NE(text.find("not known: the mesh is not closed"), std::string::npos) << text;
    EXPECT_EQ(text.find("hat.obj"), std::string::npos) << text;
    EXPECT_EQ(expect_success({"check", "hat.obj"}), "No faces intersect: 1 mesh.\n");
    EXPECT_EQ(json::parse(expect_success({"check", "hat.obj", "--json"}))["intersecting"], false);
}

TEST_F(CheckCommand, CallsNoClosedMeshOpenThatNoMapCanHold) {
    write("tiny.obj", obj_text(make_box({1e-17F, 1e-17F, 1e-17F})));
    const std::string text = expect_success({"check", "tiny.obj", "tiny.obj"});
    EXPECT_NE(text.find("or no exact map can hold it"), std::string::npos) << text;
}

TEST_F(CheckCommand, WritesTheMeshesWithCurvesAsAPlyThatCanBeRead) {
    expect_success({"check", "dress.obj", "body.obj", "--pairs", "out.ply"});
    const std::string bytes = content("out.ply");
    const TriangleMesh read = read_mesh(path("out.ply"));
    EXPECT_EQ(read.faces.size(), dress_.faces.size() + body_.faces.size());
    std::size_t length = bytes.find("end_header\n") + 11;
    const auto number = [&](const std::string& word) {
        return std::stoul(bytes.substr(bytes.find(word) + word.size()));
    };
    const std::size_t vertices = number("element vertex "), faces = number("element face "),
                      edges = number("element edge ");
    EXPECT_GT(vertices, dress_.vertices.size() + body_.vertices.size());
    EXPECT_GT(edges, 20U);
    EXPECT_EQ(bytes.size(), length + 15 * vertices + 16 * faces + 8 * edges);
    std::size_t red = 0;
    for (std::size_t i = 0; i < faces; ++i)
        red += static_cast<std::uint8_t>(bytes[length + 15 * vertices + 16 * i + 13]) == 220;
    std::vector<std::uint8_t> expected(faces);
    for (const FacePair& pair : intersecting_pairs(dress_, body_))
        expected[pair.a] = expected[dress_.faces.size() + pair.b] = 1;
    for (const FacePair& pair : self_intersecting_pairs(body_))
        expected[dress_.faces.size() + pair.a] = expected[dress_.faces.size() + pair.b] = 1;
    EXPECT_EQ(red, static_cast<std::size_t>(std::count(expected.begin(), expected.end(), 1)));
    EXPECT_TRUE(expect_success({"check", "hat.obj", "--pairs", "-"}).starts_with("ply\n"));
}

TEST_F(CheckCommand, ReadsOneMeshFromStandardInput) {
    const std::string text = expect_success({"check", "body.obj", "-", "--format", "obj"}, obj_text(dress_));
    EXPECT_NE(text.find("body.obj and standard input\n"), std::string::npos) << text;
    expect_failure(2, "standard input (-) is named twice", {"check", "-", "-", "--format", "obj"});
    expect_failure(2, "--format", {"check", "body.obj", "-"});
}

TEST_F(CheckCommand, NamesTheFileThatItCannotUse) {
    write("empty.obj", "");
    write("points.obj", "v 0 0 0\n");
    write("nan.obj", "v nan 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3\n");
    write("index.obj", "v 0 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 4\n");
    expect_failure(1, "empty.obj: ", {"check", "body.obj", "empty.obj"});
    expect_failure(1, "points.obj: ", {"check", "body.obj", "points.obj"});
    expect_failure(1, "nan.obj: line 1", {"check", "body.obj", "nan.obj"});
    expect_failure(1, "index.obj: line 4", {"check", "body.obj", "index.obj"});
    expect_failure(1, "absent.obj: ", {"check", "absent.obj"});
    expect_failure(2, "MESH is required", {"check"});
    expect_failure(2, "out.ply", {"check", "body.obj", "--pairs", "out.obj"});
    expect_failure(2, "--json", {"check", "body.obj", "--pairs", "-", "--json"});
    expect_success({"mesh", "box", "-o", "box.ply"});
    expect_failure(2, "box.ply: is an input file", {"check", "body.obj", "box.ply", "--pairs", "box.ply"});
}

TEST_F(CheckCommand, NamesTheFileWhoseFacesAllLieOnEachOther) {
    std::string text;
    for (int i = 0; i < 8200; ++i) text += "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n";
    write("same.obj", text);
    expect_failure(1, "same.obj: more than 33554432 pairs", {"check", "hat.obj", "same.obj"});
}

TEST_F(CheckCommand, TakesMeshesOnEachOtherAndEdgesWithManyFaces) {
    const json copies = json::parse(expect_success({"check", "hat.obj", "hat.obj", "--json"}));
    EXPECT_GT(copies["between"][0]["pairs"], 12);
    write("fins.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    EXPECT_EQ(expect_success({"check", "fins.obj"}), "No faces intersect: 1 mesh.\n");
}

TEST_F(CheckCommand, MovesMeshesFarFromZeroToOneFrame) {
    const auto far_box = [&](double x) {
        std::string text;
        for (int i = 0; i < 8; ++i)
            text += "v " + std::to_string(5e6 + x + (i & 1)) + " " + std::to_string(i >> 1 & 1) + " " +
                    std::to_string(i >> 2) + "\n";
        return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n";
    };
    write("a.obj", far_box(0));
    write("b.obj", far_box(0.5));
    write("c.obj", far_box(1.001));
    const ProgramResult result = run({"check", "a.obj", "b.obj", "c.obj", "--json"});
    EXPECT_EQ(result.exit_status, 0) << result.error;
    const json found = json::parse(result.output);
    ASSERT_EQ(found["between"].size(), 2U);
    EXPECT_EQ(found["between"][0]["b"], 1);
    EXPECT_EQ(found["between"][1]["a"], 1);
}
