#include "tools/command_line.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path kSource = ECHINUS_SOURCE_FOLDER;

class SimulateCommand : public CommandLineTest {
  protected:
    nlohmann::json simulate(const std::string& scene, const std::vector<std::string>& options = {}) const {
        std::vector<std::string> arguments{"simulate", scene, "-o", "run", "--json"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return nlohmann::json::parse(expect_success(arguments));
    }

    /// With an exact map no particle is inside at rest, or ever was.
    void expect_none_inside(const std::string& scene, const std::vector<std::string>& options = {}) const {
        const nlohmann::json report = simulate(scene, options);
        EXPECT_EQ(report.at("map_kind"), "exact");
        EXPECT_FALSE(report.at("frames_to_rest").is_null());
        EXPECT_EQ(report.at("inside_at_rest"), 0);
        EXPECT_EQ(report.at("lost_count"), 0);
    }

    /// Runs one of the scenes that ship, with 900 particles, until it rests. The hash covers every bit of the
    /// last two frames; update it here after an intended change of a map or the solver.
    void expect_rest(const std::string& scene, const std::string& state_hash) const {
        const nlohmann::json report = simulate((kSource / "scenes" / scene).string(), {"--particles", "900"});
        EXPECT_EQ(report.at("particles"), 900);
        EXPECT_EQ(report.at("state_hash"), state_hash);
        EXPECT_FALSE(report.at("frames_to_rest").is_null());
        EXPECT_LE(report.at("inside_at_rest").get<double>(), 0.01 * report.at("particles").get<double>());
        EXPECT_LE(report.at("deepest").at("in_radii").get<double>(), 0.01);
    }
};

const std::string kFallingSheetScene = R"({"model": {"box": {"size": [1, 1, 1]}},
    "cloth": {"particles": [4, 3], "size": [1, 1], "position": [0, 0, 2]}, "frame_limit": 6})";

const std::vector<std::array<float, 3>> kTableCorners{
    {-0.5F, -0.5F, -0.1F}, {0.5F, -0.5F, -0.1F}, {0.5F, 0.5F, -0.1F}, {-0.5F, 0.5F, -0.1F},
    {-0.5F, -0.5F, 0.1F},  {0.5F, -0.5F, 0.1F},  {0.5F, 0.5F, 0.1F},  {-0.5F, 0.5F, 0.1F}};
const std::string kTable = R"(v -0.5 -0.5 -0.1
v 0.5 -0.5 -0.1
v 0.5 0.5 -0.1
v -0.5 0.5 -0.1
v -0.5 -0.5 0.1
v 0.5 -0.5 0.1
v 0.5 0.5 0.1
v -0.5 0.5 0.1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

} // namespace

TEST_F(SimulateCommand, LeavesNoParticleOfTheSmallClothInsideTheTorus) {
    expect_none_inside((kSource / "scenes" / "torus_small.json").string(), {"--particles", "225"});
}

TEST_F(SimulateCommand, LeavesNoParticleOfTheSmallClothInsideTheHorse) {
    if (!fs::exists(kSource / "models" / "horse.3ds"))
        GTEST_SKIP() << "models/horse.3ds is not there; scripts/setup fetches it";
    expect_none_inside((kSource / "scenes" / "horse.json").string(), {"--particles", "225"});
}

TEST_F(SimulateCommand, LeavesNoParticleOfTheBagInsideTheTorus) {
    // As the scene has it, but with fewer particles.
    nlohmann::json scene =
        nlohmann::json::parse(std::ifstream(kSource / "scenes" / "bag.json"), nullptr, true, true);
    scene["cloth"]["mesh"]["sphere"]["segments"] = {40, 20};
    scene["cloth"]["thickness"] = 0.02;
    write("bag.json", scene.dump());
    expect_none_inside("bag.json");
}

TEST_F(SimulateCommand, LosesNoParticleOfTheFlagToItsPole) {
    const nlohmann::json report = simulate((kSource / "scenes" / "flag.json").string(), {"--frames", "75"});
    EXPECT_EQ(report.at("particles"), 496);
    EXPECT_EQ(report.at("lost_count"), 0);
    EXPECT_EQ(report.at("inside_at_rest"), 0);
    EXPECT_LT(report.at("strain").at("largest"), 0.2);
}

TEST_F(SimulateCommand, LosesNoParticleToAThinPlateThatMovesAndTurns) {
    // As the scene has it, but by the paper's method.
    nlohmann::json scene =
        nlohmann::json::parse(std::ifstream(kSource / "scenes" / "thin_plate.json"), nullptr, true, true);
    scene["cloth"]["particles"] = {30, 30};
    scene["solver"] = "jakobsen";
    scene["frame_limit"] = 240;
    write("plate.json", scene.dump());
    const nlohmann::json report = simulate("plate.json");
    EXPECT_EQ(report.at("lost_count"), 0);
    EXPECT_GT(report.at("rescued_count"), 0);
    EXPECT_EQ(report.at("inside_at_rest"), 0);
}

TEST_F(SimulateCommand, DrapesTheSmallClothOnTheTorusAsEverBefore) {
    expect_rest("torus_distance.json", "26bef6464d648ab1");
}

TEST_F(SimulateCommand, DrapesTheSmallClothOnTheHorseAsEverBefore) {
    if (!fs::exists(kSource / "models" / "horse.3ds"))
        GTEST_SKIP() << "models/horse.3ds is not there; scripts/setup fetches it";
    expect_rest("horse_distance.json", "b71cdcd18af14ef2");
}

TEST_F(SimulateCommand, ReportsTheLoadOnEachColliderUnderTheNewtonSolver) {
    const auto load = [&](const std::string& keys, const std::vector<std::string>& options = {}) {
        write("scene.json",
              R"({"colliders": [{"model": {"box": {}}}, {"model": {"box": {}}, "position": [0, 0, 9]}],
            "cloth": {"particles": [5, 5], "size": [0.4, 0.4], "position": [0, 0, 0.51], "thickness": 0.01},
            "frame_limit": 90)" +
                  keys + "}");
        return simulate("scene.json", options).at("colliders");
    };
    const nlohmann::json measured = load("");
    const double weight = 0.2 * 0.4 * 0.4 * 9.81; // of the material's density
    EXPECT_NEAR(measured[0].at("load").at("force")[2].get<double>(), -weight, 0.02 * weight);
    EXPECT_EQ(measured[1].at("load").at("force"), nlohmann::json({0.0, 0.0, 0.0}));
    EXPECT_EQ(measured[0].at("load").at("torque").size(), 3u);
    EXPECT_TRUE(load(R"(, "solver": "jakobsen")")[0].at("load").is_null());
    EXPECT_TRUE(load(R"(, "solver": "jakobsen")")[0].at("loads").is_null());
    // Over time it is the same as the change of momentum: the cloth begins and ends at rest.
    const nlohmann::json& loads = measured[0].at("loads");
    ASSERT_EQ(loads.size(), measured[1].at("loads").size());
    double sum = 0;
    for (const nlohmann::json& saved : loads) sum += saved.at("force")[2].get<double>();
    EXPECT_NEAR(sum / static_cast<double>(loads.size()), -weight, 0.02 * weight);
    EXPECT_EQ(loads.back().at("force"), measured[0].at("load").at("force"));
    EXPECT_EQ(loads.front().at("frame"), 1);
    // Of every tenth frame the mean is that of ten.
    const nlohmann::json tenth = load(R"(, "at_rest": {"frames": 1000})", {"--every", "10"})[0].at("loads");
    ASSERT_EQ(tenth.size(), 9u);
    double first_ten = 0;
    for (std::size_t i = 0; i < 10; ++i) first_ten += loads[i].at("force")[2].get<double>() / 10;
    EXPECT_NEAR(tenth[0].at("force")[2].get<double>(), first_ten, 1e-9);
    EXPECT_EQ(tenth[0].at("frame"), 10);
}

TEST_F(SimulateCommand, WritesTheClothItsMotionTheColliderAndAReport) {
    write("scene.json", kFallingSheetScene);
    const nlohmann::json report = simulate("scene.json", {"--every", "2"});
    EXPECT_EQ(report, nlohmann::json::parse(content("run/report.json")));
    EXPECT_EQ(report.at("particles"), 12);
    EXPECT_EQ(report.at("frames"), 6);
    EXPECT_TRUE(report.at("frames_to_rest").is_null());
    EXPECT_TRUE(content("run/cloth.pc2").starts_with("POINTCACHE2"));
    EXPECT_EQ(content("run/cloth.pc2").size(), 32 + 4 * 12 * 12u); // header, four moments of twelve particles
    EXPECT_TRUE(fs::exists(path("run/cloth.obj")));
    EXPECT_TRUE(fs::exists(path("run/collider.obj")));
}

TEST_F(SimulateCommand, GoesOnFromASavedStateToTheSameEnd) {
    write("scene.json", kFallingSheetScene);
    const nlohmann::json whole = simulate("scene.json");
    simulate("scene.json", {"--frames", "3", "--save-state", "middle.state"});
    const nlohmann::json rest = simulate("scene.json", {"--from-state", "middle.state"});
    EXPECT_EQ(rest.at("state_hash"), whole.at("state_hash"));
    EXPECT_EQ(rest.at("frames"), 6);
    write("other.json", R"({"model": {"box": {}}, "cloth": {"size": [1, 1], "position": [0, 0, 2]}})");
    expect_failure(1, "middle.state belongs to a simulation with another deformable",
                   {"simulate", "other.json", "-o", "run", "--from-state", "middle.state"});
}

TEST_F(SimulateCommand, RefusesAStateThatIsNotBeforeTheLastFrame) {
    write("scene.json", kFallingSheetScene);
    simulate("scene.json", {"--frames", "4", "--save-state", "middle.state"});
    for (const char* frames : {"3", "4"})
        expect_failure(
            2,
            "--from-state: middle.state was saved after frame 4, and the run ends at frame " +
                std::string(frames),
            {"simulate", "scene.json", "-o", "none", "--frames", frames, "--from-state", "middle.state"});
    EXPECT_FALSE(fs::exists(path("none")));
}

TEST_F(SimulateCommand, WritesAStateToStandardOutputAndNothingElse) {
    write("scene.json", kFallingSheetScene);
    const std::string state = expect_success({"simulate", "scene.json", "-o", "run", "--save-state", "-"});
    EXPECT_TRUE(state.starts_with("ECHSTATE"));
    EXPECT_FALSE(fs::exists(path("-")));
    simulate("scene.json", {"--save-state", "file.state"});
    EXPECT_EQ(state, content("file.state"));
    expect_failure(2, "--json", {"simulate", "scene.json", "-o", "run", "--save-state", "-", "--json"});
    expect_failure(2, "--save-state", {"simulate", "scene.json", "--html", "-", "--save-state", "-"});
    expect_failure(2, "--from-state", {"simulate", "scene.json", "-o", "run", "--from-state", "-"});
}

TEST_F(SimulateCommand, WritesNoStateOfARunWhoseFolderCannotBeWritten) {
    write("scene.json", kFallingSheetScene);
    write("run", "a file");
    expect_failure(1, "is not a folder",
                   {"simulate", "scene.json", "-o", "run", "--save-state", "end.state"});
    EXPECT_FALSE(fs::exists(path("end.state")));
}

TEST_F(SimulateCommand, CountsTheFacesThatIntersectInTheWorstSavedFrame) {
    // Only particles collide, and the four of the sheet fall past the post between them.
    write("scene.json", R"({"model": {"box": {"size": [0.2, 0.2, 1]}},
        "cloth": {"particles": [2, 2], "size": [4, 4], "position": [0, 0, 0.501], "velocity": [0, 0, -9]},
        "frame_limit": 60, "solver": "jakobsen"})");
    EXPECT_TRUE(simulate("scene.json").at("worst_frames").is_null());
    const nlohmann::json report = simulate("scene.json", {"--judge", "all", "--every", "10"});
    const nlohmann::json& worst = report.at("worst_frames");
    EXPECT_EQ(worst.at("judged"), 7);
    EXPECT_GT(worst.at("intersecting_pairs").at("pairs"), 0);
    EXPECT_EQ(report.at("intersecting_pairs"), 0);
    EXPECT_GT(worst.at("intersecting_pairs").at("frame"), 0);
    EXPECT_EQ(worst.at("self_intersecting_pairs").at("pairs"), 0);
    EXPECT_TRUE(worst.at("self_intersecting_pairs").at("frame").is_null());
}

TEST_F(SimulateCommand, CountsTheFacesThatIntersectAtTheEnd) {
    write("apart.json", kFallingSheetScene);
    const nlohmann::json apart = simulate("apart.json");
    EXPECT_EQ(apart.at("intersecting_pairs"), 0);
    EXPECT_EQ(apart.at("self_intersecting_pairs"), 0);
    // Two faces around a box, whose four sides of two faces they cut; no particle is near it.
    write("cut.json", R"({"model": {"box": {"size": [1, 1, 1]}}, "cloth": {"particles": [2, 2],
        "size": [4, 4], "position": [0.3, 0, 0.1]}, "frame_limit": 1, "solver": "jakobsen"})");
    const nlohmann::json cut = simulate("cut.json");
    EXPECT_GE(cut.at("intersecting_pairs"), 8);
    EXPECT_LE(cut.at("intersecting_pairs"), 16);
    EXPECT_EQ(cut.at("self_intersecting_pairs"), 0);
    EXPECT_EQ(cut.at("inside_at_rest"), 0);
}

TEST_F(SimulateCommand, MeasuresTheGapOfTheParticlesInContact) {
    write("apart.json", kFallingSheetScene);
    EXPECT_EQ(simulate("apart.json").at("contact_gap"),
              nlohmann::json::parse(R"({"particles": 0, "mean": null, "least": null})"));
    // Lies 0.1 above the box, which its middle row reaches over; nothing moves.
    write("near.json", R"({"model": {"box": {"size": [1, 1, 1]}}, "gravity": [0, 0, 0], "cloth":
        {"particles": [3, 3], "size": [4, 4], "position": [0, 0, 0.6], "thickness": 0.08}, "frame_limit": 1})");
    const nlohmann::json near = simulate("near.json");
    EXPECT_EQ(near.at("contact_gap").at("particles"), 1);
    EXPECT_NEAR(near.at("contact_gap").at("mean"), 0.1, 1e-5);
    EXPECT_EQ(near.at("contact_gap").at("mean"), near.at("contact_gap").at("least"));
    EXPECT_LE(near.at("strain").at("percentile_99"), near.at("strain").at("largest"));
}

TEST_F(SimulateCommand, WritesOneObjPerMomentWhereAskedTo) {
    write("scene.json", kFallingSheetScene);
    simulate("scene.json", {"--every", "3", "--obj"});
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(path("run/frames")))
        count += entry.path().extension() == ".obj";
    EXPECT_EQ(count, 3u);
    EXPECT_FALSE(fs::exists(path("run/cloth.pc2")));
}

TEST_F(SimulateCommand, LetsAMeshFromAFileFallAsCloth) {
    expect_success({"mesh", "sphere", "--radius", "0.5", "--segments", "12x8", "-o", "bag.obj"});
    expect_success({"mesh", "sphere", "--radius", "0.7", "--segments", "12x8", "-o", "wide.obj"});
    write("scene.json", R"({"model": {"box": {}}, "frame_limit": 20,
        "cloth": {"mesh": "bag.obj", "rest_mesh": "wide.obj", "position": [0, 0, 1.2]}})");
    const nlohmann::json report = simulate("scene.json");
    EXPECT_EQ(report.at("particles"), 86);
    EXPECT_GT(report.at("strain").at("mean"), 0.0);
    EXPECT_EQ(content("run/cloth.pc2").size(), 32 + 21 * 86 * 12u);
    expect_success(
        {"render", "moment", "run", "--samples", "1", "--width", "60", "--height", "40", "-o", "p.png"});
}

TEST_F(SimulateCommand, LetsAThreadAndAKiteOnAThreadFall) {
    write("thread.obj", "v -1 0 1\nv -0.5 0 1\nv 0 0 1\nv 0.5 0 1\nv 1 0 1\nl 1 2 3 4 5\n");
    write("kite.obj", "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 1.5 1 1.5\nv 2 1 2\nf 1 2 3\nl 3 4 5\n");
    for (const std::string name : {"thread", "kite"}) {
        write("scene.json", R"({"model": {"box": {}}, "frame_limit": 60, "cloth": {"mesh": ")" + name +
                                R"(.obj", "thickness": 0.05}})");
        const nlohmann::json report = simulate("scene.json");
        EXPECT_EQ(report.at("particles"), 5);
        EXPECT_EQ(report.at("intersecting_pairs"), 0);
        EXPECT_NE(content("run/cloth.obj").find("\nl "), std::string::npos) << "the threads are saved";
        expect_success(
            {"render", "moment", "run", "--samples", "1", "--width", "60", "--height", "40", "-o", "p.png"});
    }
}

TEST_F(SimulateCommand, SavesTheSurfaceOfASoftBodyAlone) {
    write("scene.json", R"({"model": {"box": {}}, "frame_limit": 10,
        "bodies": [{"mesh": {"box": {"size": [0.3, 0.3, 0.3]}}, "element": 0.1, "position": [0, 0, 0.8]}]})");
    EXPECT_EQ(simulate("scene.json").at("particles"), 4 * 4 * 4);
    EXPECT_EQ(content("run/cloth.pc2").size(), 32 + 11 * (64 - 8) * 12u);
    expect_success(
        {"render", "moment", "run", "--samples", "1", "--width", "60", "--height", "40", "-o", "p.png"});
}

TEST_F(SimulateCommand, ReportsTheStrainOfAMaterialThatHasNoConstraints) {
    // A block that stands on its lower side: of its height it loses about a half of density * g * height / E.
    write("scene.json", R"({"model": {"box": {}}, "frame_limit": 90, "bodies": [{"young_modulus": 5000,
        "mesh": {"box": {"size": [0.2, 0.2, 0.2]}}, "element": 0.1, "position": [0, 0, 0.61],
        "pins": {"from": [-1, -1, -0.11], "to": [1, 1, -0.09]}}]})");
    const nlohmann::json report = simulate("scene.json");
    EXPECT_EQ(report.at("constraints"), 0);
    EXPECT_GT(report.at("strain").at("mean"), 0.1);
    EXPECT_LT(report.at("strain").at("largest"), 0.6);
    EXPECT_GT(report.at("strain").at("edges").at("mean"), 0.05);
    EXPECT_GE(report.at("strain").at("edges").at("largest"),
              report.at("strain").at("edges").at("percentile_99"));
}

TEST_F(SimulateCommand, TakesAboutAsManyParticlesAsItIsToldAndHoldsThoseNearestToTheScenes) {
    write("scene.json", R"({"model": {"box": {}}, "frame_limit": 9, "cloth": {"particles": [61, 31],
        "size": [2, 1], "position": [0, 0, 2], "pins": [[0, 0], [1, 0], [60, 30]],
        "handles": [{"particles": [[0, 1], [60, 0]]}]}})");
    EXPECT_EQ(simulate("scene.json").at("particles"), 61 * 31);
    EXPECT_EQ(simulate("scene.json", {"--particles", "200", "--obj"}).at("particles"), 20 * 10);
    // Three corners stay where they began, of which one is held by the handle; none of the others does.
    const auto places_in = [&](const std::string& frame) {
        std::vector<std::array<double, 3>> places;
        std::istringstream lines(content("run/frames/cloth_" + frame + ".obj"));
        for (std::string line; std::getline(lines, line);)
            if (std::array<double, 3> p{};
                std::sscanf(line.c_str(), "v %lf %lf %lf", &p[0], &p[1], &p[2]) == 3)
                places.push_back(p);
        return places;
    };
    const auto first = places_in("000000"), last = places_in("000009");
    ASSERT_EQ(last.size(), 200u);
    for (std::size_t i = 0; i < last.size(); ++i)
        EXPECT_EQ(first[i] == last[i], i == 0 || i == 19 || i == 199) << i;
    write("bag.json", R"({"model": {"box": {}}, "cloth": {"mesh": {"sphere": {}}, "position": [0, 0, 2]}})");
    expect_failure(2, "--particles", {"simulate", "bag.json", "-o", "run", "--particles", "100"});
}

TEST_F(SimulateCommand, TakesABodyFromAFileOfTetrahedra) {
    write("ball.node", "4 3 0 0\n0 0 0 0\n1 0.3 0 0\n2 0 0.3 0\n3 0 0 0.3\n");
    write("ball.ele", "1 4 0\n0 0 1 2 3\n");
    write("scene.json", R"({"model": {"box": {}}, "frame_limit": 3,
        "bodies": [{"mesh": "ball.ele", "position": [0, 0, 0.8]}]})");
    EXPECT_EQ(simulate("scene.json").at("particles"), 4);
    write("ball.ele", "1 4 0\n0 0 1 2 4\n");
    expect_failure(1, "ball.ele", {"simulate", "scene.json", "-o", "run"});
}

TEST_F(SimulateCommand, NamesTheModelThatAClothBeginsIn) {
    write("scene.json", R"({"model": {"box": {}}, "cloth": {"size": [2, 2], "particles": [5, 5]}})");
    expect_failure(1, "scene.json: the deformable begins intersecting the box in",
                   {"simulate", "scene.json", "-o", "run"});
    write("scene.json",
          R"({"model": {"box": {}}, "cloth": {"size": [0.2, 0.2], "particles": [2, 2], "pins": [[0, 0]]}})");
    expect_failure(1,
                   "4 particles begin inside the box, 1 of them pinned there; the first is particle 0; move",
                   {"simulate", "scene.json", "-o", "run"});
}

TEST_F(SimulateCommand, NamesTheMeshOfAClothAndTheFaceAtFault) {
    const std::string sheet = "v 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\nv 0 0 3\nf 1 2 3\nf 1 3 4\nf 1 3 5\n";
    write("three.obj", sheet);
    write("scene.json", R"({"model": {"box": {}}, "cloth": {"mesh": "three.obj"}})");
    expect_failure(1, "three.obj: the edge between vertices 0 and 2 has the faces 0, 1, 2",
                   {"simulate", "scene.json", "-o", "run"});
    write("scene.json", R"({"model": {"box": {}}, "cloth": {"mesh": "nowhere.obj"}})");
    expect_failure(1, "scene.json: the mesh nowhere.obj is in none", {"simulate", "scene.json", "-o", "run"});
    write("scene.json", R"({"model": {"box": {}}, "cloth": {"mesh": {"box": {}}, "pins": [8]}})");
    expect_failure(1, "scene.json: cloth.mesh: a pin refers to vertex 8",
                   {"simulate", "scene.json", "-o", "run"});
}

TEST_F(SimulateCommand, NamesTheSceneAndTheKeyAtFault) {
    write("misspelt.json", R"({"model": {"box": {}}, "cloth": {"particels": [4, 4], "size": [1, 1]}})");
    expect_failure(1, "misspelt.json: ", {"simulate", "misspelt.json", "-o", "run"});
    expect_failure(1, "particels", {"simulate", "misspelt.json", "-o", "run"});
    write("impossible.json", R"({"model": {"torus": {"major": 1, "minor": 2}}, "cloth": {"size": [1, 1]}})");
    expect_failure(1, "impossible.json: \"model\": ", {"simulate", "impossible.json", "-o", "run"});
    expect_failure(1, "nowhere.json", {"simulate", "nowhere.json", "-o", "run"});
    write("empty.json", "");
    expect_failure(1, "empty.json", {"simulate", "empty.json", "-o", "run"});
}

TEST_F(SimulateCommand, NamesAnOpenModelAndTheRepairThatWouldCloseIt) {
    const auto scene_on = [](const std::string& model, const std::string& more = "") {
        return R"({"model": ")" + model +
               R"(", "frame_limit": 1, "cloth": {"particles": [2, 2], "size": [1, 1],
            "position": [0, 0, 9]}, "solver": "jakobsen")" +
               more + "}";
    };
    write("open.obj", echinus::test::open_box_text());
    write("doubled.obj", echinus::test::doubled_face_text());
    write("open.json", scene_on("open.obj"));
    write("doubled.json", scene_on("doubled.obj"));
    expect_failure(1, "open.obj: the mesh is not closed: 3 border edges (at faces",
                   {"simulate", "open.json", "-o", "run"});
    expect_failure(1, R"(; fix it elsewhere, or with "small_holes" or "sheets" in the scene's "repair")",
                   {"simulate", "open.json", "-o", "run"});
    const std::string remedy =
        R"("repair": ["seams", "duplicate_faces", "doubled_patches", "slivers", "orientation"])";
    expect_failure(1, "; fix it with " + remedy, {"simulate", "doubled.json", "-o", "run"});
    write("doubled.json", scene_on("doubled.obj", ", " + remedy));
    simulate("doubled.json");
}

TEST_F(SimulateCommand, ReadsNoSceneFromStandardInput) {
    expect_failure(2, "SCENE: cannot be standard input", {"simulate", "-", "-o", "run"}, kFallingSheetScene);
}

TEST_F(SimulateCommand, LeavesNoFolderBehindWhenItDiverges) {
    write("wild.json", R"({"model": {"box": {}}, "time_step": 1000,
        "cloth": {"particles": [4, 4], "size": [1, 1], "position": [9, 0, 2]}})");
    expect_failure(1, "wild.json: the simulation diverged in frame", {"simulate", "wild.json", "-o", "run"});
}

TEST_F(SimulateCommand, LetsSurfacesCollideWhereTheSceneOrAnOptionSaysSo) {
    // The middle of a sheet of four particles falls on a small ball.
    const std::string scene = R"({"model": {"sphere": {"radius": 0.2, "segments": [12, 6]}},
        "cloth": {"particles": [2, 2], "size": [2, 2], "position": [0.1, 0, 0.25], "thickness": 0.01},
        "frame_limit": 50)";
    write("particles.json", scene + R"(, "solver": "jakobsen"})");
    write("surfaces.json", scene + "}");
    const nlohmann::json particles = simulate("particles.json");
    EXPECT_EQ(particles.at("collision"), "particles");
    EXPECT_GT(particles.at("intersecting_pairs"), 0);
    const nlohmann::json surfaces = simulate("surfaces.json");
    EXPECT_EQ(surfaces.at("collision"), "surfaces_and_self");
    EXPECT_EQ(surfaces.at("intersecting_pairs"), 0);
    EXPECT_EQ(surfaces.at("unresolved"), 0);
    EXPECT_GE(surfaces.at("truncated").at("most"), surfaces.at("truncated").at("mean"));
    const auto hash_with = [&](const std::string& name, const std::vector<std::string>& options) {
        return simulate(name, options).at("state_hash");
    };
    EXPECT_EQ(hash_with("surfaces.json", {"--collision", "surfaces_and_self"}), surfaces.at("state_hash"));
    EXPECT_EQ(simulate("surfaces.json", {"--collision", "particles"}).at("collision"), "particles");
    expect_failure(2, "leave the option out, or set \"solver\": \"newton\" in the scene",
                   {"simulate", "particles.json", "-o", "run", "--collision", "surfaces"});
    expect_failure(2, "--collision", {"simulate", "particles.json", "-o", "run", "--collision", "maybe"});
}

TEST_F(SimulateCommand, NamesTheSuccessorsOfFormerOptions) {
    const std::vector<std::string> command{"simulate", "scene.json", "-o", "run"};
    const auto refuses = [&](std::vector<std::string> options, const std::string& sentence) {
        options.insert(options.begin(), command.begin(), command.end());
        expect_failure(2, sentence, options);
    };
    refuses({"--surfaces", "off"},
            "--surfaces is now --collision surfaces; to turn it off, use --collision particles");
    refuses({"--surfaces=on"},
            "--surfaces is now --collision surfaces; to turn it off, use --collision particles");
    refuses({"--self", "on"},
            "--self is now --collision surfaces_and_self; to turn it off, use --collision surfaces");
    EXPECT_EQ(run({"simulate", "--help"}).output.find("--surfaces"), std::string::npos);
    refuses({"--surface"}, "there is no option --surface");
}

TEST_F(SimulateCommand, TakesAnOpenModelWhereSurfacesCollide) {
    write("roof.obj", "v -1 0 0\nv 1 0 0\nv 0 1 0.2\nv 0 -1 0.2\nf 1 2 3\nf 1 4 2\n");
    const std::string scene = R"({"model": "roof.obj", "cloth": {"particles": [6, 6], "size": [1, 1],
        "position": [0, 0, 0.3], "thickness": 0.01}, "frame_limit": 120, "collision": )";
    write("surfaces.json", scene + "\"surfaces\"}");
    const nlohmann::json report = simulate("surfaces.json");
    EXPECT_EQ(report.at("intersecting_pairs"), 0);
    EXPECT_EQ(report.at("inside_at_rest"), 0);
    EXPECT_GT(report.at("contact_gap").at("particles"), 0);
    write("particles.json", scene + "\"particles\"}");
    expect_failure(1, "roof.obj", {"simulate", "particles.json", "-o", "run"});
}

// ---- Colliders that move on their own, and deform

namespace {

/// As PC2: a box whose top waves.
std::string waving_box(const std::vector<std::array<float, 3>>& corners, int sample_count) {
    std::string bytes("POINTCACHE2\0", 12);
    const auto add = [&](const auto& value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(std::int32_t{1});
    add(static_cast<std::int32_t>(corners.size()));
    add(0.0F);
    add(1.0F);
    add(std::int32_t{sample_count});
    for (int i = 0; i < sample_count; ++i)
        for (const auto& [x, y, z] : corners) {
            add(x);
            add(y);
            add(z > 0 ? z + 0.1F * std::sin(0.5F * static_cast<float>(i) + 2 * x) - 0.1F * std::sin(2 * x)
                      : z);
        }
    return bytes;
}

} // namespace

TEST_F(SimulateCommand, LetsEachColliderMoveOnItsOwnAndSavesWhereItStands) {
    write("scene.json", R"({"cloth": {"particles": [20, 20], "size": [1, 1], "position": [0, 0, 0.3]},
        "colliders": [
            {"model": {"box": {"size": [3, 3, 0.1]}}, "position": [0, 0, -0.4]},
            {"model": {"sphere": {"radius": 0.2, "segments": [16, 8]}}, "linear_velocity": [0, 0, 0.1]},
            {"model": {"box": {"size": [0.1, 0.8, 0.1]}}, "keyframes": [
                {"time": 0, "position": [-1, 0, 0]},
                {"time": 0.5, "position": [0.3, 0, 0.05], "rotation": {"axis": [0, 0, 1], "degrees": 60}}]}],
        "frame_limit": 50})");
    const nlohmann::json report = simulate("scene.json");
    EXPECT_EQ(report.at("lost_count"), 0);
    EXPECT_EQ(report.at("intersecting_pairs"), 0);
    EXPECT_EQ(report.at("self_intersecting_pairs"), 0);
    EXPECT_EQ(report.at("inside_at_rest"), 0);
    const nlohmann::json& colliders = report.at("colliders");
    ASSERT_EQ(colliders.size(), 3u);
    EXPECT_EQ(report.at("collider").at("mesh"), "collider.obj");
    EXPECT_EQ(colliders[2].at("mesh"), "collider_2.obj");
    EXPECT_EQ(colliders[0].at("poses").size(), 1u);
    EXPECT_EQ(colliders[1].at("poses").size(), 51u);
    // From its last key on it rests.
    EXPECT_EQ(colliders[2].at("poses").size(), 31u);
    EXPECT_NEAR(colliders[2].at("poses").back().at("translation")[0].get<double>(), 0.3, 1e-9);
    EXPECT_TRUE(fs::exists(path("run/collider_1.obj")));
    // Pictures show all of them.
    expect_success(
        {"render", "moment", "run", "-o", "end.png", "--width", "40", "--height", "30", "--samples", "1"});
}

TEST_F(SimulateCommand, DeformsAColliderByACacheAndSavesIt) {
    write("box.obj", kTable);
    write("wave.pc2", waving_box(kTableCorners, 20));
    const std::string scene =
        R"({"model": "box.obj", "collider": {"cache": {"file": "wave.pc2", "frames_per_second": 24}},
        "cloth": {"particles": [20, 20], "size": [0.9, 0.9], "position": [0, 0, 0.2]}, "frame_limit": 200,
        "time_step": 0.004166666666666667})";
    write("scene.json", scene);
    const nlohmann::json report = simulate("scene.json", {"--every", "10"});
    EXPECT_EQ(report.at("lost_count"), 0);
    EXPECT_EQ(report.at("unresolved"), 0);
    EXPECT_EQ(report.at("intersecting_pairs"), 0);
    EXPECT_EQ(report.at("inside_at_rest"), 0);
    EXPECT_GT(report.at("contact_gap").at("particles"), 50);
    EXPECT_EQ(report.at("colliders")[0].at("cache"), "collider.pc2");
    EXPECT_EQ(fs::file_size(path("run/collider.pc2")), 32 + 21 * kTableCorners.size() * 12);
    expect_success(
        {"render", "moment", "run", "-o", "end.png", "--width", "40", "--height", "30", "--samples", "1"});

    expect_failure(2, "cannot show a deforming collider", {"simulate", "scene.json", "--html", "page.html"});
    write("wave.pc2", waving_box({{0, 0, 0}, {1, 0, 0}}, 20));
    expect_failure(1, "wave.pc2: has 2 points, but the model has 8 vertices",
                   {"simulate", "scene.json", "-o", "other"});
    write("scene.json",
          R"({"model": "box.obj", "collider": {"cache": "none.pc2"}, "cloth": {"size": [1, 1]}})");
    expect_failure(1, "scene.json: the vertex cache none.pc2 is in none of the folders",
                   {"simulate", "scene.json", "-o", "other"});
}

TEST_F(SimulateCommand, WarnsOfKeysThatHaveNoEffectAndGoesOn) {
    write("scene.json", R"({"model": {"box": {"size": [1, 1, 1]}}, "solver": "verlet",
        "cloth": {"particles": [4, 3], "size": [1, 1], "position": [0, 0, 2]}, "frame_limit": 2})");
    const ProgramResult result = run({"simulate", "scene.json", "-o", "run"});
    EXPECT_EQ(result.exit_status, 0);
    EXPECT_NE(result.error.find("warning: scene.json: the key solver has no effect"), std::string::npos)
        << result.error;
}
