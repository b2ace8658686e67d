#include "tools/command_line.hpp"
#include "tools/sample_files.hpp"

#include <nlohmann/json.hpp>

using namespace echinus;
using namespace echinus::test;
using nlohmann::json;

namespace {

/// Meshes that no sensible program makes, given to the commands that read one.
class BadMesh : public CommandLineTest {
  protected:
    /// Both `info` and `build` must refuse it, naming the file and the fault.
    void expect_refusal(const std::string& name, const std::string& text, const std::string& words) const {
        write(name, text);
        expect_refusal(name, words);
    }
    void expect_refusal(const std::string& name, const std::string& words) const {
        expect_failure(1, name + ": ", {"info", name});
        expect_failure(1, words, {"info", name});
        expect_failure(1, name + ": ", {"build", name, "-o", "map.ech"});
        expect_failure(1, words, {"build", name, "--repair", "--allow-open", "-o", "map.ech"});
    }

    json build(const std::string& name) const {
        return json::parse(expect_success(
            {"build", name, "--kind", "distance", "--directions", "32x16", "-o", "map.ech", "--json"}));
    }
    json info(const std::string& name) const { return json::parse(expect_success({"info", name, "--json"})); }
};

std::string scaled_box(double factor) {
    TriangleMesh mesh = make_box({2, 3, 4});
    for (Vec3f& vertex : mesh.vertices) vertex *= static_cast<float>(factor);
    return obj_text(mesh);
}

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

} // namespace

TEST_F(BadMesh, ThatIsMissingOrADirectory) {
    expect_refusal("missing.obj", "missing.obj");
    std::filesystem::create_directory(path("folder.obj"));
    expect_refusal("folder.obj", "folder.obj");
}

TEST_F(BadMesh, ThatIsEmpty) {
    for (const char* name : {"e.obj", "e.ply", "e.stl", "e.off", "e.gltf", "e.glb", "e.3ds"}) {
        expect_refusal(name, "", name);
    }
}

TEST_F(BadMesh, ThatIsOfAnotherFormatThanItsNameSays) {
    for (const char* name : {"e.obj", "e.ply", "e.stl", "e.off", "e.gltf", "e.glb", "e.3ds", "e.png", "e"}) {
        expect_refusal(name, "\x89PNG\r\n\x1a\n and so on, but no mesh\n", name);
    }
}

TEST_F(BadMesh, ThatHasNoFaces) {
    expect_refusal("points.obj", kTriangle, "face");
    expect_refusal("points.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "face");
}

TEST_F(BadMesh, ThatIsTruncated) {
    expect_refusal("cut.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n", "cut.off");
    expect_refusal(
        "cut.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n",
        "cut.ply");
    std::string binary_stl(80, ' ');
    binary_stl += std::string("\x02\0\0\0", 4) + std::string(60, '\0');
    expect_refusal("cut.stl", binary_stl, "cut.stl");
}

TEST_F(BadMesh, ThatHasCoordinatesThatAreNotFinite) {
    expect_refusal("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "finite");
    expect_refusal("inf.obj", "v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", "finite");
    expect_refusal("huge.obj", "v 0 0 0\nv 1e300 0 0\nv 0 1 0\nf 1 2 3\n", "huge.obj");
}

TEST_F(BadMesh, ThatHasIndicesOutOfRange) {
    expect_refusal("index.obj", std::string(kTriangle) + "f 1 2 4\n", "index.obj");
    expect_refusal("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "index.off");
}

TEST_F(BadMesh, ThatIsOneFaceIsDescribedButBuiltOnlyWhenTold) {
    write("one.obj", std::string(kTriangle) + "f 1 2 3\n");
    EXPECT_EQ(info("one.obj")["border_edges"], 3);
    expect_failure(1, "not closed", {"build", "one.obj", "-o", "map.ech"});
    expect_success(
        {"build", "one.obj", "--allow-open", "--kind", "distance", "--directions", "32x16", "-o", "map.ech"});
}

TEST_F(BadMesh, ThatIsOnePointIsNeverBuilt) {
    // One position, hence one vertex once they are welded.
    write("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
    EXPECT_EQ(info("point.obj")["degenerate_faces"], 1);
    expect_failure(1, "point.obj", {"build", "point.obj", "-o", "map.ech"});
    expect_failure(1, "point.obj", {"build", "point.obj", "--allow-open", "-o", "map.ech"});
}

TEST_F(BadMesh, ThatIsVeryLargeOrVerySmallIsBuiltAllTheSame) {
    for (const double factor : {1e9, 1e-9}) {
        write("box.obj", scaled_box(factor));
        const json built = build("box.obj");
        EXPECT_EQ(built["centre_inside"], true) << factor;
        EXPECT_EQ(built["entries"], 32 * 16) << factor;
        EXPECT_NEAR(built["radius"].get<double>() / factor, std::sqrt(29.0) / 2, 1e-4);
    }
}

TEST_F(BadMesh, ThatIsAMillionTimesLongerThanWideIsBuiltAllTheSame) {
    write("needle.obj", obj_text(make_box({1e6, 1, 1})));
    const json built = build("needle.obj");
    EXPECT_EQ(built["centre_inside"], true);
    EXPECT_EQ(built["wrong_parity_share"], 0);
}
