#include "tools/command_line.hpp"

#include <echinus/map_file.hpp>

#include <nlohmann/json.hpp>

#include <cstring>
#include <sstream>

using namespace echinus;
using namespace echinus::test;
using nlohmann::json;

namespace {

const std::vector<Vec3f> kThreePoints{
    {0, 0, 0}, {0.9F, 0.1F, -0.2F}, {1.05F, 0.1F, 0}, {9, 9, 9}, {0.5F, -1.4F, 1.9F}};

template <typename T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string npy_text(const std::vector<Vec3f>& points) {
    std::string dict =
        "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(points.size()) + ", 3), }";
    dict.resize(117, ' ');
    dict += '\n';
    std::string text = std::string("\x93NUMPY\x01\0\x76\0", 10) + dict;
    for (const Vec3f& point : points) append(text, point);
    return text;
}

std::string csv_text(const std::vector<Vec3f>& points) {
    std::ostringstream text;
    text.precision(9);
    for (const Vec3f& p : points) text << p.x << ',' << p.y << ',' << p.z << '\n';
    return text.str();
}

/// The expected contents of the answers' array behind its header.
std::string records(const std::vector<Contact>& contacts) {
    std::string bytes;
    for (const Contact& contact : contacts) {
        bytes += contact.inside ? '\1' : '\0';
        append(bytes, contact.depth);
        append(bytes, contact.normal);
        append(bytes, contact.point);
        append(bytes, contact.face);
        bytes += contact.certain ? '\1' : '\0';
    }
    return bytes;
}

/// The one on the path need not be the one of the system's packages.
std::string python_with_numpy() {
    for (const char* python : {"python3", "/usr/bin/python3"}) {
        if (std::system((python + std::string(" -c 'import numpy' 2>/dev/null")).c_str()) == 0) return python;
    }
    return {};
}

class QueryCommand : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        write("box.obj", box_text());
        expect_success({"build", "box.obj", "-o", "exact.ech"});
        expect_success({"build", "box.obj", "--kind", "distance", "--directions", "48x24", "-o", "box.ech"});
        write("points.npy", npy_text(kThreePoints));
        write("points.csv", csv_text(kThreePoints));
    }

    std::vector<Contact> contacts(const std::string& file, float margin) const {
        const AnyMap map = load_map(path(file));
        std::vector<Contact> contacts(kThreePoints.size());
        contacts_batch(map, kThreePoints, margin, contacts);
        return contacts;
    }
};

} // namespace

TEST_F(QueryCommand, AnswersWhatTheLibraryAnswers) {
    for (const std::string map : {"box.ech", "exact.ech"}) {
        for (const std::string margin : {"0", "0.25"}) {
            for (const std::string points : {"points.npy", "points.csv"}) {
                expect_success({"query", map, points, "-o", "answers.npy", "--margin", margin});
                EXPECT_TRUE(content("answers.npy").ends_with(records(contacts(map, std::stof(margin)))));
            }
        }
    }
}

TEST_F(QueryCommand, MarksWhatIsNotCertain) {
    write("open.obj", open_box_text());
    expect_success({"build", "open.obj", "--allow-open", "-o", "open.ech"});
    std::string points;
    for (const char* x : {"-0.95", "-0.5", "0", "0.5", "0.95"})
        for (const char* y : {"-1.45", "-0.7", "0", "0.7", "1.45"})
            for (const char* z : {"-1.95", "-0.9", "0", "0.9", "1.95"})
                points += std::string(x) + ',' + y + ',' + z + '\n';
    std::istringstream lines(expect_success({"query", "open.ech", "-", "-o", "-"}, points));
    std::string line;
    std::getline(lines, line);
    bool is_certain_met[2] = {};
    while (std::getline(lines, line)) is_certain_met[line.back() - '0'] = true;
    EXPECT_TRUE(is_certain_met[0] && is_certain_met[1]);
}

TEST_F(QueryCommand, KnowsThePointsOfABox) {
    const std::string text = expect_success({"query", "box.ech", "points.csv", "-o", "-"});
    std::istringstream lines(text);
    std::string line;
    std::string inside;
    std::getline(lines, line);
    EXPECT_EQ(line, "inside,depth,normal_x,normal_y,normal_z,point_x,point_y,point_z,face,certain");
    while (std::getline(lines, line)) inside += line[0];
    EXPECT_EQ(inside, "11001");
}

TEST_F(QueryCommand, CountsInItsSummary) {
    const json summary =
        json::parse(expect_success({"query", "box.ech", "points.npy", "-o", "answers.csv", "--json"}));
    EXPECT_EQ(summary["points"], 5);
    EXPECT_EQ(summary["inside"], 3);
    EXPECT_EQ(summary["contacts"], 3);
}

TEST_F(QueryCommand, ReadsAndWritesTheStandardStreams) {
    expect_success({"query", "box.ech", "points.npy", "-o", "answers.npy"});
    EXPECT_EQ(expect_success({"query", "box.ech", "-", "-o", "-"}, npy_text(kThreePoints)),
              content("answers.npy"));
    EXPECT_EQ(expect_success({"query", "-", "points.npy", "-o", "-"}, content("box.ech")),
              content("answers.npy"));
    expect_success({"query", "box.ech", "points.csv", "-o", "answers.csv"});
    EXPECT_EQ(expect_success({"query", "box.ech", "-", "-o", "-"}, csv_text(kThreePoints)),
              content("answers.csv"));
    expect_failure(2, "POINTS", {"query", "-", "-", "-o", "answers.npy"});
    expect_failure(2, "--json", {"query", "box.ech", "points.npy", "-o", "-", "--json"});
}

TEST_F(QueryCommand, AddsSignedDistancesAndWindingNumbers) {
    write("open.obj", open_box_text());
    expect_success({"build", "open.obj", "--allow-open", "-o", "open.ech"});
    const ExactMap map = load_exact_map(path("open.ech"));
    std::string expected;
    for (const Vec3f& point : kThreePoints) {
        std::ostringstream line;
        line.precision(9);
        line << signed_distance(map, point) << ' ' << winding_number(map, point, 1e-4F) << '\n';
        expected += line.str();
    }
    std::istringstream lines(expect_success(
        {"query", "open.ech", "points.csv", "--signed-distance", "--winding-number", "-o", "-"}));
    std::string line, found;
    std::getline(lines, line);
    EXPECT_TRUE(line.ends_with(",certain,signed_distance,winding_number")) << line;
    while (std::getline(lines, line)) {
        const std::size_t second = line.rfind(','), first = line.rfind(',', second - 1);
        std::ostringstream numbers;
        numbers.precision(9);
        numbers << std::stof(line.substr(first + 1)) << ' ' << std::stof(line.substr(second + 1)) << '\n';
        found += numbers.str();
    }
    EXPECT_EQ(found, expected);

    expect_success({"query", "open.ech", "points.npy", "--signed-distance", "-o", "with.npy"});
    expect_success({"query", "open.ech", "points.npy", "-o", "without.npy"});
    EXPECT_NE(content("with.npy").find("('certain', '|u1'), ('signed_distance', '<f4')]"), std::string::npos);
    EXPECT_EQ(content("with.npy").size() % 64, (kThreePoints.size() * (34 + 4)) % 64);
    EXPECT_EQ(content("without.npy").size() % 64, (kThreePoints.size() * 34) % 64);
}

TEST_F(QueryCommand, AsksADistanceMapForNothingThatItDoesNotHave) {
    for (const std::string option : {"--signed-distance", "--winding-number"})
        expect_failure(2, option + ": needs an exact map",
                       {"query", "box.ech", "points.csv", option, "-o", "answers.csv"});
}

TEST_F(QueryCommand, AnswersNoPointsWithNoAnswers) {
    write("none.npy", npy_text({}));
    expect_success({"query", "box.ech", "none.npy", "-o", "answers.npy"});
    EXPECT_EQ(content("answers.npy").size() % 64, 0u);
}

TEST_F(QueryCommand, AnswersPointsThatAreNoNumbers) {
    EXPECT_EQ(expect_success({"query", "box.ech", "-", "-o", "-"}, "nan,0,0\n0,inf,0\n"),
              "inside,depth,normal_x,normal_y,normal_z,point_x,point_y,point_z,face,certain\n"
              "0,0,0,0,0,nan,0,0,-1,1\n"
              "0,0,0,0,0,0,inf,0,-1,1\n");
}

TEST_F(QueryCommand, AnswersMoreThanOneBlock) {
    constexpr std::size_t kPointCount = 150'001;
    write("many.npy", npy_text(std::vector<Vec3f>(kPointCount, kThreePoints[1])));
    const json summary =
        json::parse(expect_success({"query", "box.ech", "many.npy", "-o", "answers.npy", "--json"}));
    EXPECT_EQ(summary["points"], kPointCount);
    EXPECT_EQ(summary["inside"], kPointCount);
}

TEST_F(QueryCommand, WritesAnswersThatNumpyReads) {
    const std::string python = python_with_numpy();
    if (python.empty()) GTEST_SKIP() << "python3-numpy is not there";
    expect_success({"query", "box.ech", "points.npy", "-o", "answers.npy"});
    const std::string script =
        "import numpy as n; a = n.load('" + path("answers.npy").string() + "'); p = n.load('" +
        path("points.npy").string() +
        "'); assert a.shape == (5,) and p.shape == (5, 3); "
        "assert a.dtype.names == ('inside', 'depth', 'normal', 'point', 'face', 'certain'); "
        "assert a['inside'].tolist() == [1, 1, 0, 0, 1]; "
        "assert a['normal'].shape == (5, 3) and a['point'].dtype == n.float32; "
        "assert (a['face'] == -1).all() and (a['point'][3] == p[3]).all()";
    EXPECT_EQ(std::system((python + " -c \"" + script + "\"").c_str()), 0);
}

TEST_F(QueryCommand, RefusesPointsThatItCannotRead) {
    const auto refuse = [&](const std::string& name, const std::string& text, const std::string& words) {
        write(name, text);
        expect_failure(1, name + ": " + words, {"query", "box.ech", name, "-o", "answers.npy"});
    };
    refuse("bad.npy", "", "not a .npy file");
    refuse("bad.npy", "1,2,3\n", "not a .npy file");
    refuse("bad.npy", npy_text(kThreePoints).substr(0, 150),
           "its header declares 5 points, but the file ends before");
    refuse("bad.npy", npy_text(kThreePoints) + "x",
           "its header declares 5 points, but the file continues after them");
    refuse("bad.csv", "", "it contains neither points nor a line of names");
    refuse("bad.csv", "1,2,3\n1,2\n", "line 2");
    refuse("bad.txt", "{\"x\": 1}\n", "line 1");
    expect_failure(1, "missing.npy", {"query", "box.ech", "missing.npy", "-o", "answers.npy"});
    std::filesystem::create_directory(path("folder.npy"));
    expect_failure(1, "folder.npy", {"query", "box.ech", "folder.npy", "-o", "answers.npy"});
    expect_failure(1, "standard input: line 1", {"query", "box.ech", "-", "-o", "answers.npy"}, "hello\n");
}

TEST_F(QueryCommand, RefusesWhatIsNoMap) {
    expect_failure(1, "box.obj: not a map file", {"query", "box.obj", "points.npy", "-o", "answers.npy"});
    expect_failure(1, "missing.ech", {"query", "missing.ech", "points.npy", "-o", "answers.npy"});
    write("half.ech", content("box.ech").substr(0, 1000));
    expect_failure(1, "half.ech: the map file is truncated",
                   {"query", "half.ech", "points.npy", "-o", "a.npy"});
    expect_failure(1, "standard input: not a map file", {"query", "-", "points.npy", "-o", "a.npy"}, "hello");
}

TEST_F(QueryCommand, RefusesOptionsThatMakeNoSense) {
    expect_failure(2, "--margin", {"query", "box.ech", "points.npy", "-o", "a.npy", "--margin", "-1"});
    expect_failure(2, "--margin", {"query", "box.ech", "points.npy", "-o", "a.npy", "--margin", "nan"});
    expect_failure(2, "--margin", {"query", "box.ech", "points.npy", "-o", "a.npy", "--margin", "inf"});
    expect_failure(2, "--output: must end in .npy or .csv, or be -; it is answers.txt",
                   {"query", "box.ech", "points.npy", "-o", "answers.txt"});
    expect_failure(2, "--output", {"query", "box.ech", "points.npy"});
    expect_failure(2, "POINTS", {"query", "box.ech", "-o", "a.npy"});
}

TEST_F(QueryCommand, LeavesNothingWhenTheAnswersCannotBeWritten) {
    expect_failure(1, "missing", {"query", "box.ech", "points.npy", "-o", "missing/a.npy"});
    if (!std::filesystem::exists("/dev/full")) return;
    std::filesystem::create_symlink("/dev/full", path("full.npy"));
    expect_failure(1, "No space left", {"query", "box.ech", "points.npy", "-o", "full.npy"});
}
