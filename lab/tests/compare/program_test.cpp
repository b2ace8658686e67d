#include "tools/command_line.hpp"

#include <nlohmann/json.hpp>

using namespace echinus::test;
using nlohmann::json;

namespace {

class CompareProgram : public CommandLineTest {
  protected:
    CompareProgram() : CommandLineTest(ECHINUS_COMPARE_PROGRAM) {}
    void SetUp() override {
        CommandLineTest::SetUp();
        write("torus.obj", obj_text(echinus::make_torus(1, 0.4, 20, 10)));
    }
    /// Of two quick systems and few particles.
    static std::vector<std::string> quick(std::vector<std::string> more) {
        std::vector<std::string> arguments{"torus.obj", "--systems", "exact,dense", "--points", "400"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_F(CompareProgram, PrintsTablesForPeople) {
    const std::string text = expect_success(quick({}));
    EXPECT_TRUE(contains(text, "torus.obj: 400 faces, R = 1.4; each system in at most 630000 bytes")) << text;
    for (const char* part : {"exact map", "dense grid", "inside?, ns", "wrong side, %", "depth error"})
        EXPECT_TRUE(contains(text, part)) << part << '\n' << text;
    EXPECT_EQ(files(), std::vector<std::string>{"torus.obj"});
}

TEST_F(CompareProgram, PrintsJsonForMachines) {
    const json report = json::parse(expect_success(quick({"--bytes", "0.2MB", "--json"})));
    EXPECT_EQ(report["mesh"], "torus.obj");
    EXPECT_EQ(report["faces"], 400);
    EXPECT_EQ(report["byte_budget"], 200'000);
    EXPECT_EQ(report["particles"], 400);
    ASSERT_EQ(report["systems"].size(), 2U);
    EXPECT_EQ(report["systems"][0]["name"], "exact");
    EXPECT_EQ(report["systems"][1]["name"], "dense");
    for (const json& system : report["systems"]) {
        EXPECT_LE(system["bytes"], 200'000);
        EXPECT_GT(system["build_ms"], 0);
        for (const char* set : {"U", "S", "C"}) {
            EXPECT_GT(system["sets"][set]["contains_ns"], 0);
            EXPECT_GT(system["sets"][set]["contacts_ns"], 0);
        }
    }
    EXPECT_EQ(report["systems"][0]["sets"]["S"]["wrong_share"], 0);
    EXPECT_GT(report["systems"][1]["sets"]["S"]["depth_error_radii"]["worst"], 0);
    EXPECT_FALSE(report.contains("curves"));
}

TEST_F(CompareProgram, HasAllSystemsOfThePaperUnlessToldOtherwise) {
    const json report =
        json::parse(expect_success({"torus.obj", "--points", "100", "--segments", "3", "--json"}));
    std::string names;
    for (const json& system : report["systems"]) names += system["name"].get<std::string>() + ' ';
    for (const char* name : {"exact ", "distance ", "dense ", "embree "})
        EXPECT_TRUE(contains(names, name)) << names;
}

TEST_F(CompareProgram, MeasuresCurvesWhereTheyAreWanted) {
    const json report = json::parse(expect_success(quick({"--bytes", "64KB", "--curves", "--json"})));
    ASSERT_EQ(report["curves"].size(), 2U);
    EXPECT_EQ(report["curves"][1]["name"], "dense");
    EXPECT_EQ(report["curves"][1]["sizes"].size(), 8U);
}

TEST_F(CompareProgram, TakesItsOptionsBeforeTheMeshAndSpacesBetweenNames) {
    const json report =
        json::parse(expect_success({"--points", "100", "--json", "--systems", "exact, dense", "torus.obj"}));
    EXPECT_EQ(report["systems"].size(), 2U);
}

TEST_F(CompareProgram, ReadsStandardInput) {
    const std::string torus = content("torus.obj");
    const std::vector<std::string> arguments{"-", "--format", "obj", "--systems", "exact", "--points", "100"};
    EXPECT_TRUE(contains(expect_success(arguments, torus), "standard input: 400 faces"));
}

TEST_F(CompareProgram, RefusesAnOpenMeshWithTheRemedy) {
    write("open.obj", open_box_text());
    write("doubled.obj", doubled_face_text());
    expect_failure(1, "open.obj: the mesh is not closed", {"open.obj"});
    expect_failure(1, "fix it with --repair", {"doubled.obj"});
    expect_success({"doubled.obj", "--repair", "--systems", "exact", "--points", "100"});
}

TEST_F(CompareProgram, RefusesWrongUse) {
    expect_failure(2, "there is no system 'octree'", {"torus.obj", "--systems", "octree"});
    expect_failure(2, "--systems", {"torus.obj", "--systems", "dense,,exact"});
    expect_failure(2, "'exact' is named twice", {"torus.obj", "--systems", "exact,dense,exact"});
    expect_failure(2, "--bytes", {"torus.obj", "--bytes", "630"});
    expect_failure(2, "--points", {"torus.obj", "--points", "5"});
    expect_failure(1, "missing.obj", {"missing.obj"});
}
