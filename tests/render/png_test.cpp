#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus/render.hpp>

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>

using namespace echinus;

namespace {

namespace fs = std::filesystem;

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
