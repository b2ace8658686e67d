#include "tools/command_line.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <sstream>

using nlohmann::json;

namespace {

using Range = std::array<std::string, 2>;

std::string cube(const Range& x, const Range& y, const Range& z) {
    std::string text;
    for (std::size_t i = 0; i < 8; ++i)
        text += "v " + x[i & 1U] + " " + y[i >> 1U & 1U] + " " + z[i >> 2U] + "\n";
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n";
}

/// 1 x 0.9 x 0.8 in the coordinates of a country.
const std::string kCube =
    cube({"448262.25", "448263.25"}, {"5411932.40", "5411933.30"}, {"112.30", "113.10"});
using Point = std::array<double, 3>;
const std::array<Point, 3> kPoints{
    {{448262.75, 5411932.50, 112.7}, {448262.75, 5411932.35, 112.7}, {448262.75, 5411933.40, 112.7}}};
const std::array<double, 3> kDistances{-0.1, 0.05, 0.1};

template <typename Number>
std::string npy_points(const std::string& type) {
    std::string dict = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (3, 3), }";
    dict.resize(117, ' ');
    std::string bytes = std::string("\x93NUMPY\x01\0\x76\0", 10) + dict + '\n';
    for (const Point& point : kPoints)
        for (const double coordinate : point) {
            const auto number = static_cast<Number>(coordinate);
            bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
        }
    return bytes;
}

std::string csv_points() {
    std::ostringstream text;
    text.precision(12);
    for (const auto& [x, y, z] : kPoints) text << x << ',' << y << ',' << z << '\n';
    return text.str();
}

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line, word; std::getline(lines, line);) {
        std::istringstream words(line);
        for (rows.emplace_back(); std::getline(words, word, ',');) rows.back().push_back(word);
    }
    return rows;
}

class FarAwayCommands : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        write("cube.obj", kCube);
        write("points.csv", csv_points());
    }
};

} // namespace

TEST_F(FarAwayCommands, AnswerAsNearTheOrigin) {
    write("points.npy", npy_points<double>("<f8"));
    for (const std::string kind : {"exact", "distance"}) {
        expect_success({"build", "cube.obj", "--kind", kind, "-o", "cube.ech"});
        for (const std::string points : {"points.csv", "points.npy"}) {
            std::vector<std::string> arguments{"query",       "cube.ech", points, "-o",
                                               "answers.csv", "--margin", "1"};
            if (kind == "exact") arguments.emplace_back("--signed-distance");
            expect_success(arguments);
            const auto rows = rows_of(content("answers.csv"));
            ASSERT_EQ(rows.size(), 4U);
            for (std::size_t i = 0; i < kPoints.size(); ++i) {
                const auto& row = rows[i + 1];
                EXPECT_EQ(row[0], kDistances[i] < 0 ? "1" : "0");
                if (kind == "distance") continue;
                EXPECT_NEAR(std::stod(row[10]), kDistances[i], 3e-6);
                // The nearest point, in the frame of the file.
                EXPECT_NEAR(std::stod(row[5]), kPoints[i][0], 3e-6);
                EXPECT_NEAR(std::stod(row[6]), i == 2 ? 5411933.30 : 5411932.40, 3e-6);
                EXPECT_NEAR(std::stod(row[7]), kPoints[i][2], 3e-6);
            }
        }
    }
}

TEST_F(FarAwayCommands, WriteContactPointsAsDoubles) {
    expect_success({"build", "cube.obj", "-o", "cube.ech"});
    expect_success({"query", "cube.ech", "points.csv", "-o", "answers.npy"});
    const std::string answers = content("answers.npy");
    EXPECT_NE(answers.find("('point', '<f8', (3,))"), std::string::npos);
    constexpr std::size_t kRecord = 1 + 4 + 12 + 24 + 4 + 1, kPoint = 1 + 4 + 12;
    ASSERT_GE(answers.size(), 3 * kRecord);
    double y = 0;
    std::memcpy(&y, answers.data() + answers.size() - 3 * kRecord + kPoint + 8, sizeof y);
    EXPECT_NEAR(y, 5411932.40, 3e-6);
}

TEST_F(FarAwayCommands, SayByHowMuchFloatsRound) {
    expect_success({"build", "cube.obj", "-o", "cube.ech"});
    write("floats.npy", npy_points<float>("<f4"));
    const json summary =
        json::parse(expect_success({"query", "cube.ech", "floats.npy", "-o", "answers.csv", "--json"}));
    EXPECT_EQ(summary["points_step"], 0.5);
    EXPECT_NE(expect_success({"query", "cube.ech", "floats.npy", "-o", "answers.csv"}).find("spacing is 0.5"),
              std::string::npos);
    EXPECT_FALSE(
        json::parse(expect_success({"query", "cube.ech", "points.csv", "-o", "answers.csv", "--json"}))
            .contains("points_step"));

    // As floats have it there.
    write("rounded.obj", cube({"448262.25", "448263.25"}, {"5411932.5", "5411933.5"}, {"112.25", "113.125"}));
    EXPECT_EQ(json::parse(expect_success({"info", "rounded.obj", "--json"}))["rounding_step"], 0.5);
    EXPECT_NE(expect_success({"info", "rounded.obj"}).find("spacing is 0.5"), std::string::npos);
    const json built = json::parse(expect_success({"build", "rounded.obj", "-o", "rounded.ech", "--json"}));
    EXPECT_EQ(built["rounding_step"], 0.5);
}

TEST_F(FarAwayCommands, DescribeMeshesAndMapsInTheFrameOfTheFile) {
    const json mesh = json::parse(expect_success({"info", "cube.obj", "--json"}));
    EXPECT_NEAR(mesh["volume"].get<double>(), 0.72, 1e-6);
    EXPECT_FALSE(mesh.contains("rounding_step"));
    expect_success({"build", "cube.obj", "-o", "cube.ech"});
    const json map = json::parse(expect_success({"info", "cube.ech", "--json"}));
    for (const json& description : {mesh, map}) {
        EXPECT_NEAR(description["centre"][0].get<double>(), 448262.75, 1e-5);
        EXPECT_NEAR(description["centre"][1].get<double>(), 5411932.85, 1e-5);
        EXPECT_NEAR(description["centre"][2].get<double>(), 112.7, 1e-5);
        EXPECT_EQ(description["origin"], (json{448263, 5411933, 112.5}));
    }
    EXPECT_NE(expect_success({"info", "cube.obj"}).find("(448263, 5411933, 112.5)"), std::string::npos);
    EXPECT_NE(expect_success({"info", "cube.ech"}).find("(448263, 5411933, 112.5)"), std::string::npos);
}

TEST_F(FarAwayCommands, RepairFillAndDraw) {
    write("open.obj", kCube.substr(0, kCube.find("f 3 1 5 7")));
    expect_success({"mesh", "repair", "open.obj", "--close-holes", "4", "-o", "closed.stl"});
    EXPECT_NEAR(json::parse(expect_success({"info", "closed.stl", "--json"}))["volume"].get<double>(), 0.72,
                1e-6);
    expect_success({"tetrahedralize", "cube.obj", "--size", "0.2", "-o", "cube.msh"});
    std::istringstream body(content("cube.msh"));
    for (std::string line; line != "$Nodes";) std::getline(body, line);
    std::size_t count = 0, number = 0;
    double x = 0, y = 0, z = 0;
    for (body >> count; count > 0 && body >> number >> x >> y >> z; --count) {
        EXPECT_NEAR(x, 448262.75, 0.5 + 3e-6);
        EXPECT_NEAR(y, 5411932.85, 0.45 + 3e-6);
        EXPECT_NEAR(z, 112.7, 0.4 + 3e-6);
    }
    EXPECT_EQ(count, 0U);
    expect_success({"build", "cube.obj", "-o", "cube.ech"});
    expect_success({"render", "map", "cube.ech", "cube.obj", "-o", "cube.png", "--width", "60", "--height",
                    "40", "--samples", "1"});
}

TEST_F(FarAwayCommands, RefuseToSimulateByName) {
    write("scene.json", R"({"model": "cube.obj", "cloth": {"particles": [4, 4], "size": [2, 2],
                            "position": [0, 0, 3], "thickness": 0.01}})");
    expect_failure(1, "cube.obj is located around (448263, 5.41193e+06, 112.5)",
                   {"simulate", "scene.json", "-o", "run"});
}

using namespace echinus;
using namespace echinus::test;

namespace {

/// Meshes that no sensible program makes, given to the commands that read one.
class BadMesh : public CommandLineTest {
  protected:
    /// Both `info` and `build` must refuse it, naming the file and the fault.
    void expect_refusal(const std::string& name, const std::string& words) const {
        expect_failure(1, name + ": ", {"info", name});
        expect_failure(1, words, {"info", name});
        expect_failure(1, name + ": ", {"build", name, "-o", "map.ech"});
        expect_failure(1, words, {"build", name, "--repair", "--allow-open", "-o", "map.ech"});
    }

    json info(const std::string& name) const { return json::parse(expect_success({"info", name, "--json"})); }
};

constexpr const char* kOneFace = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

} // namespace

TEST_F(BadMesh, ThatIsMissingOrADirectory) {
    expect_refusal("missing.obj", "missing.obj");
    std::filesystem::create_directory(path("folder.obj"));
    expect_refusal("folder.obj", "folder.obj");
}

TEST_F(BadMesh, ThatIsOneFaceIsDescribedButBuiltOnlyWhenTold) {
    write("one.obj", kOneFace);
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
