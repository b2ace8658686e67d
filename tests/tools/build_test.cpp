#include "support/meshes.hpp"
#include "tools/command_line.hpp"

#include <echinus/map_file.hpp>
#include <echinus/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <cstring>
#include <sstream>

using namespace echinus;
using namespace echinus::test;
using nlohmann::json;

namespace {

class BuildCommand : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        write("box.obj", box_text());
    }

    /// The arguments of a small build with some more.
    static std::vector<std::string> small(std::vector<std::string> more) {
        more.insert(more.begin(), {"build", "box.obj", "--kind", "distance", "--directions", "24x12"});
        return more;
    }
    std::vector<std::byte> map_bytes(const std::string& name) const {
        return serialise(load_map(path(name)));
    }
};

} // namespace

TEST_F(BuildCommand, PrintsWhatItBuilt) {
    const json built = json::parse(expect_success(small({"-o", "box.ech", "--json"})));
    EXPECT_EQ(built["kind"], "distance");
    EXPECT_EQ(built["faces"], 12);
    EXPECT_EQ(built["directions"], 24 * 12);
    EXPECT_EQ(built["entries"], 24 * 12);
    EXPECT_EQ(built["max_entries"], 1);
    EXPECT_EQ(built["bytes"], (24 * 12 + 1) * 4 + 24 * 12 * 4);
    EXPECT_EQ(built["centre_inside"], true);
    EXPECT_GE(built["build_ms"].get<double>(), 0);
}

TEST_F(BuildCommand, LeavesTheMeshAloneWhenItsNameIsGivenForTheMap) {
    expect_failure(2, "box.obj: is an input file", small({"-o", "./box.obj"}));
    EXPECT_EQ(content("box.obj"), box_text());
}

TEST_F(BuildCommand, BuildsAnExactMapUnlessTold) {
    const json built = json::parse(expect_success({"build", "box.obj", "-o", "box.ech", "--json"}));
    const ExactMap map = load_exact_map(path("box.ech"));
    EXPECT_EQ(serialise(map), serialise(ExactMap::build(make_box({2, 3, 4}))));
    EXPECT_EQ(built["kind"], "exact");
    EXPECT_EQ(built["faces"], 12);
    EXPECT_EQ(built["cells"], map.view().cell_count());
    EXPECT_EQ(built["bands"], map.view().winding_below.size());
    EXPECT_EQ(built["references"], map.view().references.size());
    EXPECT_EQ(built["longest_list"], map.statistics().longest_list);
    EXPECT_EQ(built["bytes"], map.view().byte_count());
    EXPECT_EQ(built["centre_inside"], true);
    EXPECT_EQ(built["certain_share"], 1);
    EXPECT_EQ(built["border_edges"], 0);
    EXPECT_EQ(built["rule"], "nonzero");
    EXPECT_GE(built["build_ms"].get<double>(), 0);
    EXPECT_FALSE(built.contains("inside_out"));
}

TEST_F(BuildCommand, RoundsTheCellsOfAnOctantDownToASquare) {
    for (const auto& [cells, divisions] : {std::pair{"1", 1}, {"35", 5}, {"36", 6}, {"262144", 512}}) {
        const json built = json::parse(
            expect_success({"build", "box.obj", "--cells-per-octant", cells, "-o", "box.ech", "--json"}));
        EXPECT_EQ(built["divisions"], divisions);
        EXPECT_EQ(built["cells"], 8 * divisions * divisions);
    }
}

TEST_F(BuildCommand, KeepsWithinABudgetInAnyUnit) {
    for (const auto& [budget, bytes] : {std::pair{"20000B", 20000},
                                        {"20KB", 20000},
                                        {"0.02MB", 20000},
                                        {"20KiB", 20480},
                                        {"0.02MiB", 20971}}) {
        const json built =
            json::parse(expect_success({"build", "box.obj", "--budget", budget, "-o", "box.ech", "--json"}));
        EXPECT_LE(built["bytes"], bytes);
        EXPECT_GT(built["bytes"], bytes / 2);
    }
}

TEST_F(BuildCommand, NamesTheMeshAndABudgetThatSuffices) {
    const std::vector<std::string> within{"build", "box.obj", "-o", "box.ech", "--budget"};
    const auto with_budget = [&](const std::string& budget) {
        std::vector<std::string> arguments = within;
        arguments.push_back(budget);
        return arguments;
    };
    const std::string error = run(with_budget("100B")).error;
    const std::string beginning = "echinus: box.obj: the coarsest map takes ";
    ASSERT_TRUE(error.starts_with(beginning)) << error;
    std::istringstream sizes(error.substr(beginning.size())); // "1.77 KB (1764 bytes)"
    std::string number, unit;
    char bracket = 0;
    std::size_t bytes = 0;
    sizes >> number >> unit >> bracket >> bytes;
    expect_success(with_budget(number + unit));
    expect_success(with_budget(std::to_string(bytes) + "B"));
    expect_failure(2, "more than the budget", with_budget(std::to_string(bytes - 1) + "B"));
}

TEST_F(BuildCommand, TakesABudgetOfGigabytes) {
    const auto built = [&](const char* budget) {
        json map =
            json::parse(expect_success({"build", "box.obj", "--budget", budget, "-o", "box.ech", "--json"}));
        return map["divisions"].get<int>();
    };
    EXPECT_EQ(built("1GB"), built("1000MB"));
    EXPECT_EQ(built("0.00002GB"), built("20KB"));
    EXPECT_EQ(built("0.00002GiB"), built("21.5KB"));
}

TEST_F(BuildCommand, BuildsASolidThatLiesWithinTheBandsOfACoarseMap) {
    write_mesh(path("fins.off"), make_fins(60));
    const json map = json::parse(
        expect_success({"build", "fins.off", "--cells-per-octant", "1", "-o", "fins.ech", "--json"}));
    EXPECT_EQ(map["divisions"], 1);
    expect_success({"info", "fins.ech"});
}

TEST_F(BuildCommand, ObeysTheOptionsOfAnExactMap) {
    TriangleMesh nested = make_box({2, 3, 4});
    const TriangleMesh inner = make_box({1, 1, 1});
    for (const Triangle& face : inner.faces) nested.faces.push_back({face[0] + 8, face[1] + 8, face[2] + 8});
    nested.vertices.insert(nested.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    write("nested.obj", obj_text(nested));
    const auto centre_inside = [&](const std::string& rule) {
        const json built = json::parse(expect_success(
            {"build", "nested.obj", "--rule", rule, "--centre", "search", "-o", "nested.ech", "--json"}));
        EXPECT_EQ(built["rule"], rule);
        return contains(load_map(path("nested.ech")), {0.1F, 0.1F, 0.1F});
    };
    EXPECT_TRUE(centre_inside("nonzero"));
    EXPECT_FALSE(centre_inside("parity"));
}

TEST_F(BuildCommand, RefusesOptionsOfTheOtherKind) {
    const auto refuse = [&](const std::string& words, std::vector<std::string> options) {
        options.insert(options.begin(), {"build", "box.obj", "-o", "box.ech"});
        expect_failure(2, words, options);
    };
    refuse("--directions: belongs to --kind distance", {"--directions", "24x12"});
    refuse("--correction: belongs to --kind distance", {"--kind", "exact", "--correction", "none"});
    refuse("--entries", {"--entries", "unorm16"});
    refuse("--pole", {"--pole", "x"});
    refuse("--budget: belongs to --kind exact", {"--kind", "distance", "--budget", "1MB"});
    refuse("--cells-per-octant", {"--kind", "distance", "--cells-per-octant", "9"});
    refuse("--rule", {"--kind", "distance", "--rule", "parity"});
}

TEST_F(BuildCommand, TakesTheOptionsOfThePaperUnlessTold) {
    const json built =
        json::parse(expect_success({"build", "box.obj", "--kind", "distance", "-o", "box.ech", "--json"}));
    EXPECT_EQ(built["directions"], 200 * 200);
    EXPECT_EQ(built["correction"], "signed");
    EXPECT_EQ(built["entry_format"], "float32");
    EXPECT_EQ(built["pole"], "z");
}

TEST_F(BuildCommand, ObeysItsOptions) {
    const json built = json::parse(expect_success(
        small({"--correction", "none", "--entries", "unorm16", "--pole", "x", "-o", "box.ech", "--json"})));
    EXPECT_EQ(built["correction"], "none");
    EXPECT_EQ(built["entry_format"], "unorm16");
    EXPECT_EQ(built["pole"], "x");
    EXPECT_EQ(built["longitude_count"], 24);
    EXPECT_EQ(built["colatitude_count"], 12);
    const DistanceMap expected =
        DistanceMap::build(make_box({2, 3, 4}), {.longitude_count = 24,
                                                 .colatitude_count = 12,
                                                 .correction = VertexCorrection::None,
                                                 .entry_format = EntryFormat::Unorm16,
                                                 .pole_axis = PoleAxis::X});
    const DistanceMap actual = load_distance_map(path("box.ech"));
    const auto entries = expected.view().entries_unorm16;
    ASSERT_EQ(actual.view().entries_unorm16.size(), entries.size());
    EXPECT_EQ(std::memcmp(actual.view().entries_unorm16.data(), entries.data(), entries.size_bytes()), 0);
}

TEST_F(BuildCommand, BuildsAnOctahedralGridAndRefusesTheOptionsOfTheOtherGrid) {
    const json built =
        json::parse(expect_success({"build", "box.obj", "--kind", "distance", "--grid", "octahedral",
                                    "--divisions", "8", "-o", "box.ech", "--json"}));
    EXPECT_EQ(built["grid"], "octahedral");
    EXPECT_EQ(built["divisions"], 8);
    EXPECT_EQ(built["directions"], 17 * 17);
    EXPECT_FALSE(built.contains("longitude_count"));
    EXPECT_TRUE(contains(load_map(path("box.ech")), {0.99F, 0, 0}));
    EXPECT_NE(expect_success({"info", "box.ech"}).find("289, edges of the octahedron cut into 8"),
              std::string::npos);
    const auto refuse = [&](const std::string& words, std::vector<std::string> options) {
        options.insert(options.begin(), {"build", "box.obj", "--kind", "distance", "-o", "box.ech"});
        expect_failure(2, words, options);
    };
    refuse("--divisions: belongs to --grid octahedral or cube", {"--divisions", "8"});
    refuse("--pole: belongs to --grid spherical or ellipsoidal", {"--grid", "cube", "--pole", "x"});
    refuse("--divisions: belongs to --grid octahedral or cube",
           {"--grid", "ellipsoidal", "--divisions", "8"});
    refuse("--directions: belongs to --grid spherical", {"--grid", "octahedral", "--directions", "24x12"});
    refuse("--pole: belongs to --grid spherical", {"--grid", "octahedral", "--pole", "x"});
    refuse("--divisions", {"--grid", "octahedral", "--divisions", "3"});
}

TEST_F(BuildCommand, BuildsACube) {
    const json built = json::parse(expect_success({"build", "box.obj", "--kind", "distance", "--grid", "cube",
                                                   "--divisions", "8", "-o", "box.ech", "--json"}));
    EXPECT_EQ(built["grid"], "cube");
    EXPECT_EQ(built["directions"], 6 * 9 * 9);
    EXPECT_TRUE(contains(load_map(path("box.ech")), {0.99F, 0, 0}));
    EXPECT_NE(expect_success({"info", "box.ech"}).find("486, edges of the cube cut into 8"),
              std::string::npos);
}

TEST_F(BuildCommand, BuildsAnEllipsoidAroundTheMeshAndTellsItsScale) {
    const json built =
        json::parse(expect_success({"build", "box.obj", "--kind", "distance", "--grid", "ellipsoidal",
                                    "--directions", "24x12", "--pole", "y", "-o", "box.ech", "--json"}));
    EXPECT_EQ(built["grid"], "ellipsoidal");
    EXPECT_EQ(built["pole"], "y");
    const DistanceMap map = load_distance_map(path("box.ech"));
    ASSERT_EQ(built["scale"].size(), 3U);
    EXPECT_EQ(built["scale"][2], map.view().scale.z);
    EXPECT_TRUE(contains(map, {0.99F, 0, 0}));
    EXPECT_NE(expect_success({"info", "box.ech"}).find("24 x 12 = 288, poles on y, axes scaled by 1.000, "),
              std::string::npos);
}

TEST_F(BuildCommand, PutsTheCentreOfEitherKindOfMapWhereItIsTold) {
    const TriangleMesh box = make_box({2, 3, 4});
    const auto build = [&](const char* kind, const char* centre) {
        expect_success({"build", "box.obj", "--kind", kind, "--centre", centre, "-o", "box.ech"});
        return load_map(path("box.ech"));
    };
    for (const auto& [word, centre] :
         {std::pair{"sphere", CentreChoice::BoundingSphere}, {"search", CentreChoice::Search}}) {
        EXPECT_EQ(std::get<DistanceMap>(build("distance", word)).source_hash(),
                  DistanceMap::build(box, {.centre = centre}).source_hash());
        EXPECT_EQ(std::get<ExactMap>(build("exact", word)).source_hash(),
                  ExactMap::build(box, {.centre = centre}).source_hash());
    }
}

TEST_F(BuildCommand, GivesTheSameMapOnAnyNumberOfThreads) {
    expect_success(small({"--threads", "1", "-o", "one.ech"}));
    expect_success(small({"--threads", "3", "-o", "three.ech"}));
    EXPECT_EQ(map_bytes("one.ech"), map_bytes("three.ech"));
}

TEST_F(BuildCommand, ReadsAndWritesTheStandardStreams) {
    expect_success(small({"-o", "file.ech"}));
    write("stream.ech", expect_success({"build", "-", "--format", "obj", "--kind", "distance", "--directions",
                                        "24x12", "-o", "-"},
                                       box_text()));
    EXPECT_EQ(map_bytes("stream.ech"), map_bytes("file.ech"));
    expect_failure(2, "--json", small({"-o", "-", "--json"}));
    expect_failure(2, "--format", {"build", "-", "-o", "box.ech"}, box_text());
}

TEST_F(BuildCommand, RefusesAnOpenMeshUnlessTold) {
    write("open.obj", open_box_text());
    expect_failure(1, "open.obj: the mesh is not closed: 3 border edges (at faces",
                   {"build", "open.obj", "-o", "open.ech"});
    expect_failure(1, "--allow-open", {"build", "open.obj", "--repair", "-o", "open.ech"});
    const json built = json::parse(expect_success({"build", "open.obj", "--allow-open", "--kind", "distance",
                                                   "--directions", "24x12", "-o", "open.ech", "--json"}));
    EXPECT_GT(built["wrong_parity_share"].get<double>(), 0);
    const json exact =
        json::parse(expect_success({"build", "open.obj", "--allow-open", "-o", "open.ech", "--json"}));
    EXPECT_EQ(exact["border_edges"], 3);
    EXPECT_LT(exact["certain_share"].get<double>(), 1);
    EXPECT_GT(exact["uncertain_directions"].get<double>(), 0);
}

TEST_F(BuildCommand, MendsTheMeshOnlyWhenTold) {
    write("doubled.obj", doubled_face_text());
    expect_failure(1, "fix it with --repair", {"build", "doubled.obj", "-o", "map.ech"});
    const json built = json::parse(expect_success({"build", "doubled.obj", "--repair", "--kind", "distance",
                                                   "--directions", "24x12", "-o", "map.ech", "--json"}));
    EXPECT_EQ(built["repairs"]["duplicate_faces_dropped"], 1);
    EXPECT_EQ(built["faces"], 12);
    const std::string text = expect_success(
        {"build", "doubled.obj", "--repair", "--kind", "distance", "--directions", "24x12", "-o", "map.ech"});
    EXPECT_NE(text.find("Repair: 1 duplicate face dropped."), std::string::npos) << text;
}

TEST_F(BuildCommand, TakesCornersForOneThatDifferByRoundings) {
    const auto write_with_gap = [&](float gap) {
        TriangleMesh mesh = make_box({2, 3, 4});
        mesh.vertices.push_back(mesh.vertices[mesh.faces[0][0]] + Vec3f{0, 0, gap});
        mesh.faces[0][0] = 8;
        write("cracked.obj", obj_text(mesh));
    };
    write_with_gap(2e-7F);
    const json built = json::parse(expect_success({"build", "cracked.obj", "-o", "cracked.ech", "--json"}));
    EXPECT_EQ(built["border_edges"], 0);
    write_with_gap(1e-3F);
    expect_failure(1, "not closed", {"build", "cracked.obj", "--repair", "-o", "cracked.ech"});
    const json welded = json::parse(
        expect_success({"build", "cracked.obj", "--weld", "0.002", "-o", "cracked.ech", "--json"}));
    EXPECT_EQ(welded["repairs"]["vertices_welded"], 1);
    expect_failure(2, "--weld", {"build", "cracked.obj", "--weld", "-1", "-o", "cracked.ech"});
    expect_failure(2, "welded within 5", {"build", "cracked.obj", "--weld", "5", "-o", "cracked.ech"});
}

TEST_F(BuildCommand, NoticesThatSheetsWithTwoSidesEncloseNothing) {
    for (const std::uint32_t count : {1U, 6U, 7U, 40U}) {
        TriangleMesh slats;
        for (std::uint32_t i = 0; i < count; ++i) {
            const float x = 0.1F * static_cast<float>(i);
            slats.vertices.insert(slats.vertices.end(), {{x, -1, -1}, {x, 1, -1}, {x, 1, 1}, {x, -1, 1}});
            const std::uint32_t a = 4 * i, b = a + 1, c = a + 2, d = a + 3;
            slats.faces.insert(slats.faces.end(), {{a, b, c}, {a, c, d}, {c, b, a}, {d, c, a}});
        }
        write("slats.obj", obj_text(slats));
        expect_failure(1, "encloses nothing", {"build", "slats.obj", "-o", "slats.ech"});
        expect_failure(1, "encloses no volume",
                       {"build", "slats.obj", "--kind", "distance", "-o", "slats.ech"});
    }
}

TEST_F(BuildCommand, RefusesOptionsThatMakeNoSense) {
    const auto refuse = [&](const std::string& words, std::vector<std::string> options) {
        options.insert(options.begin(), {"build", "box.obj", "-o", "box.ech"});
        expect_failure(2, words, options);
    };
    refuse("--directions", {"--kind", "distance", "--directions", "200"});
    refuse("--directions", {"--kind", "distance", "--directions", "20x"});
    refuse("--directions", {"--kind", "distance", "--directions", "20x30x40"});
    refuse("--directions", {"--kind", "distance", "--directions", "-20x30"});
    refuse("--directions", {"--kind", "distance", "--directions", "99999999999x30"});
    refuse("colatitude_count", {"--kind", "distance", "--directions", "200x3"});
    refuse("longitude_count", {"--kind", "distance", "--directions", "100000x200"});
    refuse("--kind: 'grid' is not one of exact|distance", {"--kind", "grid"});
    refuse("--cells-per-octant", {"--cells-per-octant", "0"});
    refuse("--cells-per-octant", {"--cells-per-octant", "262145"});
    refuse("--budget", {"--budget", "300"});
    refuse("--budget", {"--budget", "300TB"});
    refuse("at most 1000000GB", {"--budget", "1000001GB"});
    refuse("--budget", {"--budget", "-1KB"});
    refuse("--budget", {"--budget", "nanKB"});
    refuse("coarsest", {"--budget", "100B"});
    refuse("--budget", {"--budget", "1MB", "--cells-per-octant", "9"});
    refuse("--rule", {"--rule", "odd"});
    refuse("--centre", {"--centre", "origin"});
    refuse("--correction: 'some' is not one of signed|paper|none", {"--correction", "some"});
    refuse("--entries", {"--entries", "0"});
    refuse("--pole", {"--pole", "w"});
    refuse("--threads", {"--threads", "-1"});
    refuse("--threads", {"--threads", "1000000"});
    expect_failure(2, "--output", {"build", "box.obj"});
    expect_failure(2, "MESH", {"build", "-o", "box.ech"});
}

TEST_F(BuildCommand, LeavesNothingWhenTheMapCannotBeWritten) {
    expect_failure(1, "missing/box.ech", small({"-o", "missing/box.ech"}));
    std::filesystem::create_directory(path("folder"));
    expect_failure(1, "folder", small({"-o", "folder"}));
    if (std::filesystem::exists("/dev/full")) expect_failure(1, "No space left", small({"-o", "/dev/full"}));
}

TEST_F(BuildCommand, KeepsTheOldMapWhenItFails) {
    expect_success(small({"-o", "box.ech"}));
    const std::string old = content("box.ech");
    write("box.obj", open_box_text());
    expect_failure(1, "not closed", small({"-o", "box.ech"}));
    EXPECT_EQ(content("box.ech"), old);
}

TEST_F(BuildCommand, TakesWhatIsInsideOutForAnExactMapOnly) {
    TriangleMesh box = make_box({2, 3, 4});
    for (Triangle& face : box.faces) std::swap(face[0], face[1]);
    write("inside_out.obj", obj_text(box));
    const std::vector<std::string> distance{"build", "inside_out.obj", "--kind", "distance", "-o", "box.ech"};
    expect_failure(1, "inside_out.obj: the mesh is inside out", distance);
    const json built = json::parse(expect_success({"build", "inside_out.obj", "-o", "box.ech", "--json"}));
    EXPECT_EQ(built["inside_out"], true);
    EXPECT_EQ(built["centre_inside"], true);
    const std::string text = expect_success({"build", "inside_out.obj", "-o", "box.ech"});
    EXPECT_NE(text.find("The mesh is inside out."), std::string::npos) << text;
    const json mended =
        json::parse(expect_success({"build", "inside_out.obj", "--repair", "-o", "box.ech", "--json"}));
    EXPECT_FALSE(mended.contains("inside_out"));
}

TEST_F(BuildCommand, RefusesWhatHasNoInsideUnlessTold) {
    TriangleMesh box = make_box({2, 3, 4});
    for (Vec3f& vertex : box.vertices) vertex.z = 0;
    write("flat.obj", obj_text(box));
    for (const char* kind : {"exact", "distance"}) {
        expect_failure(1, "flat.obj: the mesh encloses no",
                       {"build", "flat.obj", "--kind", kind, "-o", "flat.ech"});
    }
    const json built =
        json::parse(expect_success({"build", "flat.obj", "--allow-open", "-o", "flat.ech", "--json"}));
    EXPECT_EQ(built["centre_inside"], false);
}

TEST_F(BuildCommand, MakesAnOpenMeshSolidWhereAskedTo) {
    write("open.obj", open_box_text());
    expect_failure(1, "--close-holes or --thicken", {"build", "open.obj", "-o", "map.ech"});
    const json built =
        json::parse(expect_success({"build", "open.obj", "--close-holes", "3", "--json", "-o", "map.ech"}));
    EXPECT_EQ(built["repairs"]["holes_closed"], 1);
    EXPECT_EQ(built["repairs"]["faces_added"], 1);
    EXPECT_EQ(built["certain_share"], 1);
    const std::string shell = expect_success({"build", "open.obj", "--thicken", "0.25", "-o", "map.ech"});
    EXPECT_NE(shell.find("1 sheet thickened"), std::string::npos) << shell;
    const ExactMap map = load_exact_map(path("map.ech"));
    EXPECT_FALSE(contains(map, {0, 0, 0}));
    EXPECT_TRUE(contains(map, {0.9F, 0, 0.3F}));
}
