// The scripts figure, which needs Debian's Python and python3-numpy, and garment, which needs Python.

#include "tools/command_line.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/simulation.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

using namespace echinus;

namespace {

/// A joint of a BVH file that only turns, with what is below it.
std::string joint(const std::string& name, const std::string& offset, const std::string& below) {
    return "JOINT " + name + "\n{\nOFFSET " + offset + "\nCHANNELS 3 Zrotation Xrotation Yrotation\n" +
           below + "}\n";
}

std::string end_site(const std::string& offset) {
    return "End Site\n{\nOFFSET " + offset + "\n}\n";
}

std::string limbs(const std::string& side, const std::string& sign) {
    return joint(side + "Hip", sign + "10 0 0",
                 joint(side + "Knee", "0 -40 0",
                       joint(side + "Ankle", "0 -40 0", joint(side + "Toes", "0 -7 15", end_site("0 0 8")))));
}

std::string arm(const std::string& side, const std::string& sign) {
    return joint(side + "Collar", "0 20 0",
                 joint(side + "Shoulder", sign + "18 0 0",
                       joint(side + "Elbow", sign + "28 0 0",
                             joint(side + "Wrist", sign + "25 0 0", end_site(sign + "15 0 0")))));
}

/// A capture in centimetres in which a body first stands and then has lifted its left thigh to the front.
std::string capture() {
    const std::string trunk =
        joint("Ab", "0 8 0",
              joint("Chest", "0 20 0",
                    joint("Neck", "0 20 0", joint("Head", "0 10 0", end_site("0 17 0"))) + arm("Left", "") +
                        arm("Right", "-")));
    std::string text =
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation "
        "Xrotation Yrotation\n" +
        trunk + limbs("Left", "") + limbs("Right", "-") + "}\nMOTION\nFrames: 31\nFrame Time: 0.1\n";
    constexpr int kJointsBeforeTheHip =
        13; // the trunk's four below the root, and four of each arm, and the root
    for (int frame = 0; frame <= 30; ++frame) {
        text += "0 88 0 ";
        for (int i = 0; i < 3 * kJointsBeforeTheHip; ++i) text += "0 ";
        text += "0 " + std::to_string(-3 * frame) + " 0 ";
        for (int i = 0; i < 3 * 7; ++i) text += "0 ";
        text += "\n";
    }
    return text;
}

class Figure : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        if (std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") != 0)
            GTEST_SKIP() << "there is no /usr/bin/python3 with numpy";
        write("lift.bvh", capture());
        const std::string script = std::string("'") + ECHINUS_SOURCE_FOLDER + "/lab/figure' ";
        const std::string files = "'" + path("lift.bvh").string() + "' -o '" + path("figure.glb").string() +
                                  "' --skirt '" + path("skirt.obj").string() + "'";
        ASSERT_EQ(
            std::system(
                (script + files + " --faces 4000 --spacing 0.03 --still 0.5 --blend 1 --seconds 3").c_str()),
            0);
    }
};

/// The lowest vertex on the figure's left.
std::size_t left_sole(const TriangleMesh& figure) {
    const auto height = [](const Vec3f& p) { return p.x > 0 ? p.y : 9; };
    const auto& vertices = figure.vertices;
    return static_cast<std::size_t>(
        std::min_element(vertices.begin(), vertices.end(),
                         [&](const Vec3f& a, const Vec3f& b) { return height(a) < height(b); }) -
        vertices.begin());
}

} // namespace

TEST_F(Figure, IsOneClosedSkinThatFollowsTheCaptureFromANeutralPose) {
    const TriangleMesh figure = read_mesh(path("figure.glb"));
    const MeshReport report = inspect(figure);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_EQ(report.component_count, 1U);
    EXPECT_GT(report.signed_volume, 0.05);
    EXPECT_TRUE(self_intersecting_pairs(figure).empty());

    const VertexCache cache = read_vertex_cache(path("figure.glb"), figure, 30);
    EXPECT_NEAR(cache.end_time(), 3.5, 1e-6);
    for (const double time : {0.0, 0.4}) {
        const std::vector<Vec3f> still = vertices_at(cache, time);
        for (std::size_t i = 0; i < still.size(); ++i)
            EXPECT_NEAR(length(still[i] - figure.vertices[i]), 0, 1e-5);
    }
    // The leg, 0.9 m long with its foot, is level and points to the front.
    const Vec3f sole = vertices_at(cache, 3.5)[left_sole(figure)];
    EXPECT_NEAR(sole.y, 0.9, 0.15);
    EXPECT_NEAR(sole.z, 0.9, 0.15);
}

TEST_F(Figure, HasASkirtThatBeginsClearOfIt) {
    const TriangleMesh figure = read_mesh(path("figure.glb"));
    const TriangleMesh skirt = read_mesh(path("skirt.obj"));
    EXPECT_TRUE(intersecting_pairs(skirt, figure).empty());
    EXPECT_TRUE(self_intersecting_pairs(skirt).empty());
    EXPECT_EQ(inspect(skirt).component_count, 1U);
}

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
