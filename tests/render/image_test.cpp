#include "render/image.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>

using namespace echinus;
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
