#include "tools/command_line.hpp"

#include <png.h>

#include <cstdint>

using namespace echinus::test;

namespace {

/// Options for a picture that is drawn quickly.
const std::vector<std::string> kSmall{"--width", "60", "--height", "40", "--samples", "1"};

std::vector<std::string> render(std::vector<std::string> arguments,
                                const std::vector<std::string>& options = kSmall) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
}

std::uint32_t big_endian_at(const std::string& bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(offset + i));
    return value;
}

/// A PNG file begins with its signature and a header that holds width and height.
void expect_png(const std::string& bytes, std::uint32_t width, std::uint32_t height) {
    ASSERT_TRUE(bytes.starts_with("\x89PNG\r\n\x1A\n"));
    EXPECT_EQ(big_endian_at(bytes, 16), width);
    EXPECT_EQ(big_endian_at(bytes, 20), height);
}

/// Pixels that are red beyond any cloth or model.
std::size_t red_pixel_count(const std::filesystem::path& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&header, path.c_str()));
    header.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(header));
    EXPECT_TRUE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr));
    std::size_t count = 0;
    for (std::size_t i = 0; i < rgb.size(); i += 3)
        count += rgb[i] > 3 * rgb[i + 1] && rgb[i] > 2 * rgb[i + 2];
    return count;
}

/// A folder as echinus simulate writes it: two moments of one triangle over a box.
class RenderCommand : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        write("box.obj", box_text());
    }
    void write_simulation() const {
        std::filesystem::create_directory(path("run"));
        write("run/collider.obj", box_text());
        write("run/cloth.obj", "v -2 0 3\nv 2 -2 3\nv 2 2 3\nf 1 2 3\n");
        write("run/report.json",
              R"({"gravity": [0, 0, -9.81], "frames_to_rest": 1, "collider": {"mesh": "collider.obj",
            "poses": [{"frame": 0, "translation": [0, 0, 0], "rotation": [1, 0, 0, 0]}]}})");
        const float numbers[] = {0, 1};          // first frame, frames per sample
        const std::int32_t counts[] = {1, 3, 2}; // version, points, samples
        const float samples[] = {-2, 0, 3, 2, -2, 3, 2, 2, 3, -2, 0, 2.5F, 2, -2, 2.5F, 2, 2, 2.5F};
        std::string cache("POINTCACHE2\0", 12);
        cache.append(reinterpret_cast<const char*>(counts), 8);
        cache.append(reinterpret_cast<const char*>(numbers), 8);
        cache.append(reinterpret_cast<const char*>(counts + 2), 4);
        cache.append(reinterpret_cast<const char*>(samples), sizeof samples);
        write("run/cloth.pc2", cache);
    }
};

} // namespace

TEST_F(RenderCommand, DrawsAMesh) {
    expect_success(
        render({"mesh", "box.obj", "-o", "box.png", "--up", "y", "--view", "10,20", "--wire", "1"}));
    expect_png(content("box.png"), 60, 40);
}

TEST_F(RenderCommand, DrawsTheSamePictureAgainAndToStandardOutput) {
    expect_success(render({"mesh", "box.obj", "-o", "box.png"}));
    EXPECT_EQ(
        expect_success(render({"mesh", "-", "--format", "obj", "-o", "-", "--threads", "1"}), box_text()),
        content("box.png"));
}

TEST_F(RenderCommand, RefusesToWriteAPngUnderTheEndingOfAnotherFormat) {
    expect_failure(2, "ends in .jpg, but the output is png; name it x.png",
                   {"render", "mesh", "torus.obj", "-o", "x.jpg"});
    EXPECT_FALSE(std::filesystem::exists("x.jpg"));
}

TEST_F(RenderCommand, SeesADifferenceBetweenUpAxesAndBetweenViews) {
    expect_success(render({"mesh", "box.obj", "-o", "z.png"}));
    expect_success(render({"mesh", "box.obj", "-o", "x.png", "--up", "x"}));
    expect_success(render({"mesh", "box.obj", "-o", "back.png", "--view=-100,-5"}));
    EXPECT_NE(content("z.png"), content("x.png"));
    EXPECT_NE(content("z.png"), content("back.png"));
}

TEST_F(RenderCommand, DrawsAnExactMapBesideItsModel) {
    expect_success({"build", "box.obj", "-o", "box.ech"});
    expect_success(render({"map", "box.ech", "box.obj", "-o", "map.png"}));
    expect_png(content("map.png"), 60, 40);
}

TEST_F(RenderCommand, RefusesAMapOfAnotherMesh) {
    write("ball.obj", obj_text(echinus::make_sphere(1, 12, 6)));
    for (const char* kind : {"exact", "distance"}) {
        expect_success({"build", "box.obj", "--kind", kind, "-o", "box.ech"});
        expect_failure(1, "ball.obj: not the mesh from which box.ech was built",
                       render({"map", "box.ech", "ball.obj", "-o", "map.png"}));
    }
}

TEST_F(RenderCommand, DrawsAMapBesideItsModel) {
    expect_success({"build", "box.obj", "--kind", "distance", "--directions", "24x24", "-o", "box.ech"});
    expect_success(render({"map", "box.ech", "box.obj", "-o", "map.png"}));
    expect_png(content("map.png"), 60, 40);
}

TEST_F(RenderCommand, DrawsMomentsOfASimulation) {
    write_simulation();
    expect_success(render({"moment", "run", "-o", "last.png"}));
    expect_success(render({"moment", "run", "-o", "one.png", "--frame", "1"}));
    expect_success(render({"moment", "run", "-o", "first.png", "--frame", "0"}));
    EXPECT_EQ(content("last.png"), content("one.png"));
    EXPECT_NE(content("last.png"), content("first.png"));
}

TEST_F(RenderCommand, MarksTheFacesThatIntersect) {
    write_simulation();
    expect_success(render({"moment", "run", "-o", "apart.png"}));
    write("run/collider.obj", obj_text(echinus::make_box({1, 1, 8})));
    expect_success(render({"moment", "run", "-o", "cut.png", "--view", "35,60"}));
    EXPECT_GT(red_pixel_count(path("cut.png")), 50U);
    EXPECT_EQ(red_pixel_count(path("apart.png")), 0U);
}

TEST_F(RenderCommand, ShowsACloseUp) {
    write_simulation();
    write("run/collider.obj", obj_text(echinus::make_box({1, 1, 8})));
    expect_success(render({"moment", "run", "-o", "all.png"}));
    expect_success(render({"moment", "run", "-o", "all_too.png", "--close-up", "0,0,2.5,0"}));
    expect_success(render({"moment", "run", "-o", "close.png", "--close-up", "0,0,2.5,0.5"}));
    EXPECT_EQ(content("all.png"), content("all_too.png"));
    EXPECT_GT(red_pixel_count(path("close.png")), 4 * red_pixel_count(path("all.png")));
}

TEST_F(RenderCommand, DrawsASheetOfAllMomentsWhereThereAreFew) {
    write_simulation();
    expect_success(render({"sheet", "run", "-o", "sheet.png"}));
    expect_png(content("sheet.png"), 40, 20); // two pictures of a third by a half
}

TEST_F(RenderCommand, RefusesWhatItCannotRead) {
    write_simulation();
    write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    expect_failure(1, "missing.obj", render({"mesh", "missing.obj", "-o", "p.png"}));
    expect_failure(1, "line.obj", render({"mesh", "line.obj", "-o", "p.png"}));
    expect_failure(1, "box.obj", render({"map", "box.obj", "box.obj", "-o", "p.png"}));
    expect_failure(1, "cloth.pc2", render({"moment", ".", "-o", "p.png"}));
    write("run/report.json", "{}");
    expect_failure(1, "report.json", render({"sheet", "run", "-o", "p.png"}));
    write("run/cloth.pc2", "POINTCACHE2");
    expect_failure(1, "cloth.pc2", render({"moment", "run", "-o", "p.png"}));
}

TEST_F(RenderCommand, DrawsSeveralMeshesAndTheirIntersectingFacesInRed) {
    write("sheet.obj", "v -2 -2 0.1\nv 2 -2 0.1\nv 2 2 0.1\nv -2 2 0.1\nf 1 2 3\nf 1 3 4\n");
    expect_success(render({"mesh", "box.obj", "sheet.obj", "-o", "both.png"}));
    EXPECT_EQ(red_pixel_count(path("both.png")), 0U);
    expect_success(render({"mesh", "box.obj", "sheet.obj", "--intersections", "-o", "both.png"}));
    EXPECT_GT(red_pixel_count(path("both.png")), 100U);
    expect_success(render({"mesh", "box.obj", "--intersections", "-o", "both.png"}));
    EXPECT_EQ(red_pixel_count(path("both.png")), 0U);
    expect_failure(1, "none.obj", render({"mesh", "box.obj", "none.obj", "-o", "both.png"}));
}

TEST_F(RenderCommand, RefusesWhatItCannotWrite) {
    expect_failure(1, "missing/p.png", render({"mesh", "box.obj", "-o", "missing/p.png"}));
    expect_failure(1, "/dev/full", render({"mesh", "box.obj", "-o", "/dev/full"}));
    expect_failure(1, "box.png", render({"mesh", "box.obj", "-o", "box.png/box.png"}));
}

TEST_F(RenderCommand, RefusesOptionsThatMakeNoSense) {
    write_simulation();
    const auto refuses = [&](const std::string& words, const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"render", "mesh", "box.obj", "-o", "p.png"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        expect_failure(2, words, arguments);
    };
    refuses("--width", {"--width", "0"});
    refuses("--height", {"--height", "100000"});
    refuses("pixels", {"--width", "16384", "--height", "16384"});
    refuses("--samples", {"--samples", "0"});
    refuses("--view", {"--view", "30"});
    refuses("elevation", {"--view=30,90"});
    refuses("azimuth", {"--view=nan,10"});
    refuses("--up", {"--up", "w"});
    refuses("wire", {"--wire", "-1"});
    expect_failure(2, "MESH", {"render", "mesh", "-o", "p.png"});
    expect_failure(2, "A command (mesh, map, moment or sheet) is required", {"render"});
    for (const char* wrong : {"0,0,0", "0,0,0,-1", "nan,0,0,1", "0,0,0,inf"})
        expect_failure(2, "--close-up", render({"moment", "run", "-o", "p.png", "--close-up", wrong}));
    expect_failure(2, "frame 7", render({"moment", "run", "-o", "p.png", "--frame", "7"}));
}
