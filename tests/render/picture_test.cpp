#include "render/image.hpp"
#include "render/painted_surface.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

using namespace echinus;
using namespace echinus::render;

namespace {

constexpr Colour kGreen{0.1F, 0.8F, 0.1F};
constexpr Colour kBlue{0.1F, 0.1F, 0.8F};

struct Pixel {
    int red, green, blue;
    int brightness() const { return red + green + blue; }
};

Pixel pixel_at(const Image& image, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* rgb = &image.rgb[3 * (std::size_t{y} * image.width + x)];
    return {rgb[0], rgb[1], rgb[2]};
}

RenderOptions options_of(std::uint32_t width, std::uint32_t height, std::uint32_t samples) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples = samples;
    return options;
}

std::vector<RenderedObject> painted(const TriangleMesh& mesh, Colour colour) {
    RenderedObject object;
    object.mesh = mesh;
    object.colour = colour;
    return {object};
}

/// A picture of the objects from `view`.
Image picture(const std::vector<RenderedObject>& objects, const RenderOptions& options,
              const View& view = {}) {
    return render::render(objects, camera_for(objects, view, double(options.width) / options.height),
                          options);
}

TriangleMesh scaled(TriangleMesh mesh, float factor, const Vec3f& offset = {}) {
    for (Vec3f& vertex : mesh.vertices) vertex = vertex * factor + offset;
    return mesh;
}

} // namespace

TEST(Picture, ASphereCoversTheAreaOfItsSilhouette) {
    const auto objects = painted(make_sphere(1, 256, 128), kGreen);
    const RenderOptions options = options_of(200, 200, 4);
    const Camera camera = camera_for(objects, View{}, 1);
    const Image image = render::render(objects, camera, options);

    // Seen from distance d, the rim of a unit sphere lies at the angle asin(1 / d) from its middle.
    const double distance = length(camera.position);
    const double radius_px = 100 * std::tan(std::asin(1 / distance)) / camera.tan_half_height;
    int covered = 0;
    for (std::uint32_t y = 0; y < 200; ++y) {
        for (std::uint32_t x = 0; x < 200; ++x) {
            const Pixel pixel = pixel_at(image, x, y);
            // Half-covered pixels are about halfway between green and white.
            if (pixel.green - pixel.red > 60) ++covered;
        }
    }
    const double expected = std::numbers::pi * radius_px * radius_px;
    EXPECT_NEAR(covered / expected, 1, 0.01);
}

TEST(Picture, IsTheSameForEveryThreadCountAndOnEveryRun) {
    auto objects = painted(make_torus(1, 0.4, 24, 12), palette::kClay);
    objects.push_back(painted(make_box({0.5, 0.5, 2}), kBlue).front());
    objects.back().wire_width_px = 1;
    RenderOptions options = options_of(80, 60, 5);
    options.thread_count = 1;
    const Image reference = picture(objects, options);
    for (unsigned thread_count : {1U, 2U, 3U, 7U, 0U}) {
        options.thread_count = thread_count;
        EXPECT_EQ(picture(objects, options).rgb, reference.rgb) << thread_count << " threads";
    }
}

TEST(Picture, DoesNotDependOnTheUnitOfLength) {
    const TriangleMesh torus = make_torus(1, 0.4, 24, 12);
    const RenderOptions options = options_of(60, 40, 2);
    const Image reference = picture(painted(torus, kGreen), options);
    // Powers of two change no digit of any coordinate.
    EXPECT_EQ(picture(painted(scaled(torus, 0x1p30F), kGreen), options).rgb, reference.rgb);
    EXPECT_EQ(picture(painted(scaled(torus, 0x1p-30F), kGreen), options).rgb, reference.rgb);
}

TEST(Picture, ShowsAModelThatStandsFarFromTheOrigin) {
    const auto objects = painted(scaled(make_box({64, 64, 64}, 2), 1, {1e6F, -3e6F, 2e6F}), kGreen);
    const Pixel centre = pixel_at(picture(objects, options_of(40, 40, 4)), 20, 20);
    EXPECT_GT(centre.green, centre.red + 40);
}

TEST(Picture, HasAShadowOnTheSideAwayFromTheLamp) {
    View view;
    view.margin = 0.3;
    const Image image = picture(painted(make_box({1, 1, 1}), kGreen), options_of(120, 90, 16), view);
    int darkest_left = 765;
    int darkest_right = 765;
    for (std::uint32_t y = 0; y < 90; ++y) {
        for (std::uint32_t x = 0; x < 120; ++x) {
            const Pixel pixel = pixel_at(image, x, y);
            if (pixel.green - pixel.red > 10) continue; // the box itself
            int& darkest = x < 60 ? darkest_left : darkest_right;
            darkest = std::min(darkest, pixel.brightness());
        }
    }
    const int backdrop = pixel_at(image, 0, 0).brightness();
    EXPECT_LT(darkest_right, backdrop - 120);
    EXPECT_GT(darkest_left, darkest_right + 40);
}

TEST(Picture, FadesIntoAPaleBackdropWithoutAHorizon) {
    View view;
    view.margin = 0.35;
    view.elevation_deg = 3; // the horizon would cross the picture
    const Image image = picture(painted(make_sphere(1, 32, 16), kGreen), options_of(90, 60, 8), view);
    const Pixel top = pixel_at(image, 0, 0);
    const auto page = to_srgb8(to_linear(palette::kPage));
    EXPECT_EQ(top.red, page[0]);
    EXPECT_EQ(top.green, page[1]);
    EXPECT_EQ(top.blue, page[2]);
    for (std::uint32_t y = 0; y < 60; ++y) {
        EXPECT_NEAR(pixel_at(image, 0, y).brightness(), top.brightness(), 6) << "row " << y;
    }
}

TEST(Picture, PaintsEveryFaceWithItsColour) {
    auto objects = painted(make_box({1, 1, 1}), palette::kClay);
    const TriangleMesh& mesh = objects[0].mesh;
    for (const Triangle& face : mesh.faces) {
        const bool in_front =
            mesh.vertices[face[0]].x > 0 && mesh.vertices[face[1]].x > 0 && mesh.vertices[face[2]].x > 0;
        objects[0].face_colours.push_back(in_front ? kBlue : kGreen);
    }
    View view;
    view.azimuth_deg = 0;
    view.elevation_deg = 0;
    const Pixel front = pixel_at(picture(objects, options_of(20, 20, 4), view), 10, 10);
    EXPECT_GT(front.blue, front.green + 60);
    view.azimuth_deg = 180;
    const Pixel back = pixel_at(picture(objects, options_of(20, 20, 4), view), 10, 10);
    EXPECT_GT(back.green, back.blue + 60);
}

TEST(Picture, PaintsTheBackOfAClothDifferently) {
    auto objects =
        painted({{{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}}, {{0, 1, 2}, {0, 2, 3}}}, kGreen);
    objects[0].back_colour = kBlue;
    View view;
    view.elevation_deg = 0;
    view.azimuth_deg = 0; // the cloth's normal is +x
    const Pixel front = pixel_at(picture(objects, options_of(20, 20, 4), view), 10, 10);
    view.azimuth_deg = 180;
    const Pixel back = pixel_at(picture(objects, options_of(20, 20, 4), view), 10, 10);
    EXPECT_GT(front.green, front.blue + 40);
    EXPECT_GT(back.blue, back.green + 40);
    // Each side faces the lamp in its picture: neither is dark.
    EXPECT_NEAR(front.green, back.blue, 12);
}

TEST(Picture, PaintsMarkedFacesRedOnBothSidesAndNoOthers) {
    auto objects =
        painted({{{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}}, {{0, 1, 2}, {0, 2, 3}}}, kGreen);
    objects[0].back_colour = kBlue;
    objects[0].marked_faces = {0, 0};
    View view;
    view.elevation_deg = 0;
    for (const bool front : {true, false}) {
        view.azimuth_deg = front ? 0 : 180; // the cloth's normal is +x
        const Image image = picture(objects, options_of(20, 20, 4), view);
        const Pixel marked = pixel_at(image, front ? 13 : 6, 12), other = pixel_at(image, front ? 6 : 13, 6);
        EXPECT_GT(marked.red, marked.green + 60);
        EXPECT_GT(marked.red, marked.blue + 60);
        EXPECT_LT(other.red, front ? other.green : other.blue);
    }
}

TEST(Picture, DrawsWiresAlongEdges) {
    auto objects =
        painted({{{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}}, {{0, 1, 2}, {0, 2, 3}}}, kGreen);
    View view;
    view.elevation_deg = 0;
    view.azimuth_deg = 0;
    const RenderOptions options = options_of(41, 41, 16);
    const Image plain = picture(objects, options, view);
    objects[0].wire_width_px = 2;
    const Image wired = picture(objects, options, view);
    EXPECT_LT(pixel_at(wired, 20, 20).brightness(),
              pixel_at(plain, 20, 20).brightness() - 60); // the diagonal
    EXPECT_EQ(pixel_at(wired, 27, 20).brightness(), pixel_at(plain, 27, 20).brightness());
}

TEST(Picture, ReportsProgressUpToTheEnd) {
    std::vector<double> shares;
    RenderOptions options = options_of(10, 30, 1);
    options.progress = [&](double share) { shares.push_back(share); };
    picture(painted(make_box({1, 1, 1}), kGreen), options);
    ASSERT_EQ(shares.size(), 30U);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
}

TEST(CornerNormals, KeepTheEdgesOfABoxSharp) {
    const TriangleMesh box = make_box({1, 2, 3});
    const auto normals = corner_normals(box, 40);
    for (std::size_t f = 0; f < box.faces.size(); ++f) {
        for (const Vec3f& normal : normals[f]) {
            EXPECT_NEAR(length(Vec3d(normal) - face_normal(box, box.faces[f])), 0, 1e-6);
        }
    }
}

TEST(CornerNormals, PointAlongTheDiagonalsWhereABoxIsSmoothed) {
    // Weighted by angle, each of the three sides counts as a right angle, however its square is split.
    const TriangleMesh box = make_box({1, 1, 1});
    const auto normals = corner_normals(box, 180);
    for (std::size_t f = 0; f < box.faces.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d corner(box.vertices[box.faces[f][k]]);
            EXPECT_NEAR(length(Vec3d(normals[f][k]) - corner * (1 / length(corner))), 0, 1e-5);
        }
    }
}

TEST(CornerNormals, AreNearlyRadialOnASphere) {
    const TriangleMesh sphere = make_sphere(2, 48, 24);
    const auto normals = corner_normals(sphere, 40);
    for (std::size_t f = 0; f < sphere.faces.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_GT(dot(normals[f][k], sphere.vertices[sphere.faces[f][k]] * 0.5F), 0.999F);
        }
    }
}

TEST(CornerNormals, AreZeroOnAFaceWithoutArea) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(corner_normals(mesh, 40)[0][1], Vec3f{});
}

namespace {

const TriangleMesh kBox = make_box({1, 1, 1});
const Camera kCamera = camera_for(kBox.vertices, View{}, 1);

RenderOptions tiny_options() {
    RenderOptions options;
    options.width = options.height = 8;
    options.samples = 1;
    return options;
}

void expect_error(ErrorCode code, const std::vector<RenderedObject>& objects, const RenderOptions& options) {
    test::expect_error(code, "", [&] { render::render(objects, kCamera, options); });
}

RenderedObject object_with(const TriangleMesh& mesh) {
    RenderedObject object;
    object.mesh = mesh;
    return object;
}

} // namespace

TEST(RenderErrors, NothingToDraw) {
    expect_error(ErrorCode::InvalidMesh, {}, tiny_options());
    expect_error(ErrorCode::InvalidMesh, {object_with({})}, tiny_options());
}

TEST(RenderErrors, AMeshOfFacesWithoutArea) {
    const TriangleMesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 0, 1}}};
    const TriangleMesh point{{{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}, {{0, 1, 2}}};
    expect_error(ErrorCode::InvalidMesh, {object_with(line)}, tiny_options());
    expect_error(ErrorCode::InvalidMesh, {object_with(point)}, tiny_options());
    expect_error(ErrorCode::InvalidMesh, {object_with(kBox), object_with(line)}, tiny_options());
}

TEST(RenderErrors, AMeshThatIsNotValid) {
    TriangleMesh broken = kBox;
    broken.vertices[broken.faces[3][0]].y = std::numeric_limits<float>::quiet_NaN();
    expect_error(ErrorCode::InvalidMesh, {object_with(broken)}, tiny_options());
    broken = kBox;
    broken.faces[2][1] = 1'000'000;
    expect_error(ErrorCode::InvalidMesh, {object_with(broken)}, tiny_options());
}

TEST(RenderErrors, SizesBeyondAllSense) {
    for (const auto& [width, height] : {std::pair{0U, 8U}, std::pair{8U, 0U}, std::pair{100'000U, 8U},
                                        std::pair{16'384U, 16'384U}, std::pair{0xFFFFFFFFU, 0xFFFFFFFFU}}) {
        RenderOptions options = tiny_options();
        options.width = width;
        options.height = height;
        expect_error(ErrorCode::InvalidOptions, {object_with(kBox)}, options);
    }
}

TEST(RenderErrors, SampleCountsBeyondAllSense) {
    for (std::uint32_t samples : {0U, RenderOptions::kMaxSampleCount + 1}) {
        RenderOptions options = tiny_options();
        options.samples = samples;
        expect_error(ErrorCode::InvalidOptions, {object_with(kBox)}, options);
    }
}

TEST(RenderErrors, PaintThatDoesNotFitTheMesh) {
    RenderedObject object = object_with(kBox);
    object.face_colours.resize(5);
    expect_error(ErrorCode::InvalidOptions, {object}, tiny_options());
    object = object_with(kBox);
    object.marked_faces = {12};
    expect_error(ErrorCode::InvalidOptions, {object}, tiny_options());
    object = object_with(kBox);
    object.crease_angle_deg = std::numeric_limits<double>::quiet_NaN();
    expect_error(ErrorCode::InvalidOptions, {object}, tiny_options());
    object = object_with(kBox);
    object.wire_width_px = -1;
    expect_error(ErrorCode::InvalidOptions, {object}, tiny_options());
}

TEST(RenderErrors, AnExceptionOfTheProgressCallbackStopsTheWork) {
    RenderOptions options = tiny_options();
    options.progress = [](double) { throw std::runtime_error("enough"); };
    EXPECT_THROW(render::render(std::vector{object_with(kBox)}, kCamera, options), std::runtime_error);
}

namespace fs = std::filesystem;

TEST(Tone, EveryByteSurvivesTheWayToLinearLightAndBack) {
    for (int byte = 0; byte < 256; ++byte) {
        const float value = static_cast<float>(byte) / 255;
        const auto back = to_srgb8(to_linear({value, value, value}));
        EXPECT_EQ(back[0], byte);
        EXPECT_EQ(back[2], byte);
    }
}

TEST(Tone, ClampsWhatNoScreenCanShow) {
    const auto bytes = to_srgb8({-1, 7, 0.5F});
    EXPECT_EQ(bytes[0], 0);
    EXPECT_EQ(bytes[1], 255);
    EXPECT_EQ(bytes[2], 188); // IEC 61966-2-1: 0.5 is shown as 0.7354
}

TEST(Tone, LeavesTheColoursOfThePaletteAlone) {
    for (const Colour& colour : palette::kLayers) {
        EXPECT_EQ(compress_highlights(to_linear(colour)), to_linear(colour));
    }
}

TEST(Tone, BendsHighlightsSmoothlyAndNeverReachesWhite) {
    float last = 0;
    for (float light = 0.01F; light < 50; light *= 1.01F) {
        const float shown = compress_highlights({light, light, light}).x;
        EXPECT_GT(shown, last);
        EXPECT_LT(shown, 1);
        EXPECT_LE(shown, light * 1.0001F);
        last = shown;
    }
}

namespace {

Image gradient(std::uint32_t width, std::uint32_t height) {
    Image image{width, height, {}};
    for (std::uint32_t i = 0; i < 3 * width * height; ++i)
        image.rgb.push_back(static_cast<std::uint8_t>(i * 37));
    return image;
}

Image read_png(const fs::path& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&header, path.c_str()));
    header.format = PNG_FORMAT_RGB;
    Image image{header.width, header.height, {}};
    image.rgb.resize(PNG_IMAGE_SIZE(header));
    EXPECT_TRUE(png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr));
    return image;
}

class Png : public test::TemporaryFolderTest {};

} // namespace

TEST_F(Png, ReadsBackToTheSamePixels) {
    for (const auto& [width, height] : {std::pair{1U, 1U}, std::pair{17U, 5U}, std::pair{3U, 200U}}) {
        const Image image = gradient(width, height);
        write_png(path("p.png"), image);
        const Image back = read_png(path("p.png"));
        EXPECT_EQ(back.width, width);
        EXPECT_EQ(back.height, height);
        EXPECT_EQ(back.rgb, image.rgb);
    }
}

TEST_F(Png, RefusesAPictureThatContradictsItself) {
    Image image = gradient(4, 4);
    image.rgb.pop_back();
    EXPECT_THROW(write_png(path("p.png"), image), Error);
    EXPECT_THROW(write_png(path("p.png"), Image{}), Error);
    EXPECT_TRUE(fs::is_empty(path(".")));
}

TEST_F(Png, SaysSoWhenTheFolderIsMissing) {
    test::expect_error(ErrorCode::Unwritable, "p.png",
                       [this] { write_png(path("missing") / "p.png", gradient(2, 2)); });
}
