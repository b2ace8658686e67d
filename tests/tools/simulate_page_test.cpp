#include "tools/command_line.hpp"

#include <nlohmann/json.hpp>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace echinus::test {

/// The contents of a page of `simulate --html`, read as docs/command_line.md describes it, without the
/// program's code.
struct PlayerPage {
    using Point = std::array<double, 3>;

    nlohmann::json description;
    std::vector<float> model_vertices;
    std::vector<std::uint32_t> model_faces, cloth_faces;
    std::vector<std::vector<Point>> positions; ///< of each frame

    explicit PlayerPage(const std::string& html);
};

namespace {

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t first = text.find(begin);
    const std::size_t last = text.find(end, first);
    if (first == std::string::npos || last == std::string::npos) throw std::runtime_error("no " + begin);
    return text.substr(first + begin.size(), last - first - begin.size());
}

std::uint32_t digit(char c) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    return static_cast<std::uint32_t>(digits.find(c));
}

std::vector<std::uint8_t> from_base64(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    std::uint32_t bits = 0, bit_count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6U | digit(c);
        if ((bit_count += 6) < 8) continue;
        bit_count -= 8;
        bytes.push_back(static_cast<std::uint8_t>(bits >> bit_count));
    }
    return bytes;
}

std::vector<std::uint8_t> inflated(const std::vector<std::uint8_t>& compressed, std::size_t size) {
    std::vector<std::uint8_t> bytes(size);
    uLongf length = size;
    if (uncompress(bytes.data(), &length, compressed.data(), compressed.size()) != Z_OK || length != size)
        throw std::runtime_error("the data do not have the size that the description says");
    return bytes;
}

template <typename T>
std::vector<T> take(const std::uint8_t*& bytes, std::size_t count) {
    std::vector<T> values(count);
    std::memcpy(values.data(), bytes, count * sizeof(T));
    bytes += count * sizeof(T);
    return values;
}

/// Differences of either sign from small numbers.
std::int64_t unfolded(std::int64_t code) {
    return code % 2 == 0 ? code / 2 : -(code + 1) / 2;
}

} // namespace

PlayerPage::PlayerPage(const std::string& html) {
    description = nlohmann::json::parse(
        between(html, "<script type=\"application/json\" id=\"description\">", "</script>"));
    const std::size_t vertices = description["model"]["vertices"], faces = description["model"]["faces"];
    const std::size_t cloth = description["cloth_faces"], particles = description["figures"]["particles"];
    const nlohmann::json& frames = description["frames"];
    const std::vector<std::uint8_t> data =
        inflated(from_base64(between(html, "<script type=\"text/plain\" id=\"data\">", "</script>")),
                 12 * (vertices + faces + cloth) + 6 * particles * frames.size());
    const std::uint8_t* next = data.data();
    model_vertices = take<float>(next, 3 * vertices);
    model_faces = take<std::uint32_t>(next, 3 * faces);
    cloth_faces = take<std::uint32_t>(next, 3 * cloth);

    std::vector<std::int64_t> last(3 * particles), before(3 * particles);
    for (const nlohmann::json& frame : frames) {
        std::vector<Point>& points = positions.emplace_back(particles);
        for (std::size_t i = 0; i < 3 * particles; ++i) {
            const std::int64_t now =
                2 * last[i] - before[i] + unfolded(next[i] + 256 * next[3 * particles + i]);
            before[i] = last[i];
            last[i] = now;
            const std::int64_t origin = frame["origin"][i / particles];
            const std::int64_t above = ((now - origin) % 65536 + 65536) % 65536;
            points[i % particles][i / particles] =
                static_cast<double>(origin + above) * description["lattice_step"].get<double>();
        }
        next += 6 * particles;
    }
}

} // namespace echinus::test

using namespace echinus::test;
using nlohmann::json;

namespace {

const std::string kFallingSheet = R"({"model": {"box": {"size": [1, 1, 1]}},
    "cloth": {"particles": [5, 4], "size": [1, 1], "position": [0, 0, 0.52]}, "frame_limit": 50,
    "time_step": 0.004166666666666667})";

/// Pages that `simulate --html` writes, of a player that is no more than its place.
class SimulatePage : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        write("player.html", "<!doctype html>\n<p>before</p>\n<!-- recording -->\n<p>after</p>\n");
        write("scene.json", kFallingSheet);
    }
    PlayerPage play(const std::string& scene, const std::vector<std::string>& options = {}) const {
        expect_success(arguments(scene, options));
        return PlayerPage(content("run.html"));
    }
    static std::vector<std::string> arguments(const std::string& scene,
                                              const std::vector<std::string>& options = {}) {
        std::vector<std::string> all{"simulate", scene, "--html", "run.html", "--player", "player.html"};
        all.insert(all.end(), options.begin(), options.end());
        return all;
    }
    /// Positions of all samples of run/cloth.pc2.
    std::vector<float> cached_positions() const {
        const std::string cache = content("run/cloth.pc2");
        std::vector<float> values((cache.size() - 32) / sizeof(float));
        std::memcpy(values.data(), cache.data() + 32, cache.size() - 32);
        return values;
    }
    /// Every coordinate is that of the cache to within half a step.
    void expect_positions_of_the_cache(const PlayerPage& page) const {
        const std::vector<float> expected = cached_positions();
        const double bound = 0.5000001 * page.description["lattice_step"].get<double>();
        const std::size_t count = page.positions.front().size();
        ASSERT_EQ(expected.size(), 3 * count * page.positions.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
            ASSERT_LE(std::abs(page.positions[i / 3 / count][i / 3 % count][i % 3] - double{expected[i]}),
                      bound)
                << i;
    }
};

} // namespace

TEST_F(SimulatePage, HoldsThePlayerAndTheRecordingInItsPlace) {
    const PlayerPage page = play("scene.json");
    const std::string html = content("run.html");
    EXPECT_TRUE(html.starts_with("<!doctype html>\n<p>before</p>\n<script"));
    EXPECT_TRUE(html.ends_with("</script>\n<p>after</p>\n"));
    const json& description = page.description;
    EXPECT_EQ(description["format"], 1);
    EXPECT_EQ(description["version"], ECHINUS_VERSION);
    EXPECT_EQ(description["scene"], "scene.json");
    EXPECT_EQ(description["model"]["name"], "box");
    EXPECT_EQ(description["model"]["notice"], "");
    EXPECT_EQ(page.model_vertices.size(), 3 * 8u);
    EXPECT_EQ(page.model_faces.size(), 3 * 12u);
    EXPECT_EQ(page.cloth_faces.size(), 3 * 24u);
    EXPECT_EQ(description["figures"]["particles"], 20);
    EXPECT_GT(description["figures"]["ms_per_frame"]["total"], 0);
}

TEST_F(SimulatePage, HoldsTheFacesOfAClothOfAnyShape) {
    write("bag.json", R"({"model": {"box": {}}, "frame_limit": 8,
        "cloth": {"mesh": {"sphere": {"radius": 0.5, "segments": [6, 4]}}, "position": [0, 0, 1.2]}})");
    const PlayerPage page = play("bag.json");
    EXPECT_EQ(page.description["figures"]["particles"], 6 * 3 + 2);
    EXPECT_EQ(page.cloth_faces.size(), 3 * 6 * 6u);
}

TEST_F(SimulatePage, EndsAtTheFrameLimitHoweverFewOfTheFramesItHas) {
    const PlayerPage page = play("scene.json", {"--frames", "10", "--every", "500"});
    EXPECT_EQ(page.description["figures"]["frames"], 10);
    EXPECT_EQ(page.description["frames"].back()["number"], 10);
}

TEST_F(SimulatePage, LeavesTheSceneAloneWhenItsNameIsGivenForThePage) {
    expect_failure(2, "scene.json: is an input file",
                   {"simulate", "scene.json", "--html", "./scene.json", "--player", "player.html"});
    EXPECT_EQ(content("scene.json"), kFallingSheet);
}

TEST_F(SimulatePage, HasThePositionsOfThePointCacheToHalfAStep) {
    const PlayerPage page = play("scene.json", {"-o", "run", "--every", "3"});
    ASSERT_EQ(page.positions.size(), 18u);
    EXPECT_LT(page.description["lattice_step"].get<double>(), 1.5 / 65534);
    expect_positions_of_the_cache(page);
}

TEST_F(SimulatePage, HasThePositionsOfAClothThatFallsFarToTheSameError) {
    write("far.json", R"({"model": {"box": {}}, "cloth": {"particles": [3, 3], "size": [1, 1],
        "position": [4, 0, 0], "velocity": [0, 300, -900]}, "frame_limit": 200})");
    const PlayerPage page = play("far.json", {"-o", "run", "--every", "7"});
    EXPECT_LT(page.description["lattice_step"].get<double>(), 3.0 / 65534);
    EXPECT_LT(page.positions.back().front()[2], -100);
    expect_positions_of_the_cache(page);
}

TEST_F(SimulatePage, RecordsSixtyFramesPerSecondAndTheLast) {
    const PlayerPage page = play("scene.json", {"-o", "run"}); // 240 steps per second, 50 of them
    std::vector<int> numbers;
    for (const json& frame : page.description["frames"]) numbers.push_back(frame["number"]);
    EXPECT_EQ(numbers, (std::vector<int>{0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40, 44, 48, 50}));
    EXPECT_EQ(content("run/cloth.pc2").size(), 32 + 51 * 20 * 12u);
}

TEST_F(SimulatePage, CountsTheParticlesInsideInEachFrame) {
    write("inside.json", R"({"model": {"box": {"size": [1, 1, 1]}}, "frame_limit": 40,
        "cloth": {"particles": [2, 2], "size": [0.5, 0.5], "position": [0, 0, 0.3]},
        "solver": "jakobsen"})");
    const PlayerPage page = play("inside.json");
    EXPECT_EQ(page.description["frames"].front()["inside"], 4);
    EXPECT_EQ(page.description["frames"].back()["inside"], 0);
}

TEST_F(SimulatePage, HasThePairsOfFacesThatIntersectInEachFrameWhereAllAreJudged) {
    write("cut.json", R"({"model": {"box": {"size": [1, 1, 1]}}, "frame_limit": 42,
        "cloth": {"particles": [2, 2], "size": [4, 4], "position": [0, 0, 0.6]},
        "solver": "jakobsen"})");
    const PlayerPage page = play("cut.json", {"--judge", "all"});
    EXPECT_EQ(page.description["frames"].front()["intersecting_pairs"], 0);
    EXPECT_EQ(page.description["frames"].back()["number"], 42);
    EXPECT_GT(page.description["frames"].back()["intersecting_pairs"], 0);
    for (const json& frame : page.description["frames"]) EXPECT_EQ(frame["self_intersecting_pairs"], 0);
    EXPECT_FALSE(play("cut.json").description["frames"].back().contains("intersecting_pairs"));
}

TEST_F(SimulatePage, HasAPoseForEachFrameOfAModelThatMoves) {
    write("turning.json", R"({"model": {"box": {}}, "collider": {"angular_velocity": [0, 0, 90]},
        "cloth": {"particles": [2, 2], "size": [1, 1], "position": [0, 0, 2]}, "frame_limit": 24,
        "time_step": 0.004166666666666667})");
    const PlayerPage page = play("turning.json");
    for (const json& frame : page.description["frames"]) {
        const double half_angle = std::acos(-1) / 4 * frame["number"].get<double>() / 240;
        EXPECT_NEAR(frame["pose"]["rotation"][3].get<double>(), std::sin(half_angle), 1e-9);
    }
}

TEST_F(SimulatePage, HasTheNoticeThatLiesBesideTheModel) {
    write("NOTICE", "box.obj: by Jane </script><b>& others\n");
    write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    write("file.json", R"({"model": "box.obj", "frame_limit": 4,
        "cloth": {"particles": [2, 2], "size": [1, 1], "position": [0, 0, 2]}})");
    const PlayerPage page = play("file.json");
    EXPECT_EQ(page.description["model"]["name"], "box.obj");
    EXPECT_EQ(page.description["model"]["notice"], "box.obj: by Jane </script><b>& others\n");
}

TEST_F(SimulatePage, LetsNoNameBreakOutOfItsScript) {
    const std::string name = "<!--<script>alert(1)<b>'\"&\xff.json";
    write(name, kFallingSheet);
    const PlayerPage page = play(name);
    EXPECT_EQ(page.description["scene"], "<!--<script>alert(1)<b>'\"&\uFFFD.json");
    EXPECT_EQ(content("run.html").find("alert(1)<"), std::string::npos);
    EXPECT_EQ(content("run.html").find("<!--"), std::string::npos);
}

TEST_F(SimulatePage, IsTheSameForTheSameSimulationButForTimes) {
    PlayerPage one = play("scene.json"), other = play("scene.json");
    for (PlayerPage* page : {&one, &other})
        for (const char* time : {"ms_per_frame", "ns_per_query"}) page->description["figures"].erase(time);
    EXPECT_EQ(one.description, other.description);
    EXPECT_EQ(one.positions, other.positions);
}

TEST_F(SimulatePage, GoesToStandardOutputAlone) {
    const std::string html =
        expect_success({"simulate", "scene.json", "--html", "-", "--player", "player.html"});
    EXPECT_EQ(PlayerPage(html).positions.size(), 14u);
    EXPECT_TRUE(html.ends_with("<p>after</p>\n"));
    expect_failure(2, "--json", {"simulate", "scene.json", "--html", "-", "--json"});
}

TEST_F(SimulatePage, SaysHowToGetAPlayer) {
    expect_failure(
        1, "nowhere.html: ", {"simulate", "scene.json", "--html", "run.html", "--player", "nowhere.html"});
    expect_failure(1, "scripts/web --build-only",
                   {"simulate", "scene.json", "--html", "run.html", "--player", "nowhere.html"});
}

TEST_F(SimulatePage, RefusesAPlayerWithoutItsPlaceOrWithTwo) {
    write("player.html", "<!doctype html>\n");
    expect_failure(1, "player.html: is not a player", arguments("scene.json"));
    write("player.html", "<!-- recording --><!-- recording -->");
    expect_failure(1, "<!-- recording --> once", arguments("scene.json"));
}

TEST_F(SimulatePage, RefusesMoreThanABrowserHoldsBeforeItSimulates) {
    write("large.json", R"({"model": {"box": {}}, "frame_limit": 30000,
        "cloth": {"particles": [300, 300], "size": [1, 1], "position": [0, 0, 2]}})");
    expect_failure(2, "record fewer with --every 64", arguments("large.json"));
    expect_failure(2, "up to 30002 frames", arguments("large.json", {"--every", "1"}));
}

TEST_F(SimulatePage, LeavesTheOldPageWhereItCannotBeWrittenOrTheSimulationDiverges) {
    expect_failure(
        1, "no/such/folder",
        {"simulate", "scene.json", "--html", "no/such/folder/run.html", "--player", "player.html"});
    write("wild.json", R"({"model": {"box": {}}, "time_step": 1000,
        "cloth": {"particles": [4, 4], "size": [1, 1], "position": [9, 0, 2]}})");
    write("run.html", "old");
    expect_failure(1, "wild.json: the simulation diverged in frame", arguments("wild.json"));
    EXPECT_EQ(content("run.html"), "old");
}

TEST_F(SimulatePage, IsNotTheOnlyResultButThereMustBeOne) {
    expect_failure(2, "needs -o DIR, --html FILE, or both", {"simulate", "scene.json"});
    expect_failure(2, "--obj", arguments("scene.json", {"--obj"}));
    expect_failure(2, "--html", {"simulate", "scene.json", "--html", ""});
}
