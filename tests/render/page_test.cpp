#include "render/image.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using namespace echinus;
using namespace echinus::render;

namespace {

constexpr Colour kBlack{0, 0, 0};

Image white(std::uint32_t width, std::uint32_t height) {
    return {width, height, std::vector<std::uint8_t>(std::size_t{3} * width * height, 255)};
}

/// The ink in a rectangle of pixels: 1 for each fully black one.
double ink(const Image& image, std::uint32_t left, std::uint32_t top, std::uint32_t right,
           std::uint32_t bottom) {
    double sum = 0;
    for (std::uint32_t y = top; y < bottom; ++y) {
        for (std::uint32_t x = left; x < right; ++x) {
            sum += 1 - image.rgb[3 * (std::size_t{y} * image.width + x)] / 255.0;
        }
    }
    return sum;
}

double ink(const Image& image) {
    return ink(image, 0, 0, image.width, image.height);
}

} // namespace

TEST(Strokes, CoverTheirAreaToTheFractionOfAPixel) {
    Image image = white(60, 40);
    draw_strokes(image, std::vector<PageStroke>{{{10.3, 20.7}, {50.3, 20.7}}}, 5.5, kBlack);
    const double round_ends = 3.14159265 * 2.75 * 2.75;
    EXPECT_NEAR(ink(image), 40 * 5.5 + round_ends, 2);
}

TEST(Strokes, ThatOverlapLookLikeOneShape) {
    Image once = white(40, 40);
    Image twice = white(40, 40);
    const PageStroke stroke{{5, 6}, {30, 33}};
    draw_strokes(once, std::vector{stroke}, 3, kBlack);
    draw_strokes(twice, std::vector{stroke, stroke, PageStroke{{5, 6}, {5, 6}}}, 3, kBlack);
    EXPECT_EQ(once.rgb, twice.rgb);
}

TEST(Strokes, OutsideThePictureAreCutOff) {
    Image image = white(20, 20);
    draw_strokes(image, std::vector<PageStroke>{{{-1000, -50}, {-30, 1e6}}}, 8, kBlack);
    EXPECT_EQ(ink(image), 0);
    draw_strokes(image, std::vector<PageStroke>{{{-100, 10}, {100, 10}}}, 4, kBlack);
    EXPECT_NEAR(ink(image), 80, 1);
    draw_strokes(image, {}, 4, kBlack);
    EXPECT_NEAR(ink(image), 80, 1);
}

TEST(Text, HasAMarkForEveryPrintableCharacterButTheSpace) {
    for (char character = ' '; character <= '~'; ++character) {
        Image image = white(40, 40);
        draw_text(image, 10, 30, std::string(1, character), 16, kBlack);
        if (character == ' ') {
            EXPECT_EQ(ink(image), 0);
        } else {
            EXPECT_GT(ink(image), 2) << character;
        }
    }
}

TEST(Text, DrawsNoTwoCharactersAlike) {
    std::vector<std::vector<std::uint8_t>> pictures;
    for (char character = ' '; character <= '~'; ++character) {
        Image image = white(60, 60);
        draw_text(image, 15, 40, std::string(1, character), 24, kBlack);
        EXPECT_EQ(std::count(pictures.begin(), pictures.end(), image.rgb), 0) << character;
        pictures.push_back(image.rgb);
    }
}

TEST(Text, DrawsABoxForWhatItCannotSpell) {
    Image unknown = white(40, 40);
    Image other = white(40, 40);
    draw_text(unknown, 10, 30, "\xE4", 16, kBlack);
    draw_text(other, 10, 30, "\n", 16, kBlack);
    EXPECT_GT(ink(unknown), 10);
    EXPECT_EQ(unknown.rgb, other.rgb);
}

TEST(Text, StandsWhereItIsAnchored) {
    const double width = text_width("HHH", 20);
    for (const auto& [align, left] :
         {std::pair{TextAlign::Left, 100.0}, std::pair{TextAlign::Centre, 100 - width / 2},
          std::pair{TextAlign::Right, 100 - width}}) {
        Image image = white(200, 50);
        draw_text(image, 100, 40, "HHH", 20, kBlack, align);
        const auto begin = static_cast<std::uint32_t>(left - 3);
        const auto end = static_cast<std::uint32_t>(left + width + 3);
        EXPECT_GT(ink(image), 100);
        EXPECT_NEAR(ink(image, begin, 17, end, 43), ink(image), 1e-9);
    }
}

TEST(Text, IsAsWideAsItsParts) {
    EXPECT_EQ(text_width("", 20), 0);
    EXPECT_GT(text_width("mm", 20), 2 * text_width("m", 20));
    EXPECT_NEAR(text_width("frame 12", 40), 2 * text_width("frame 12", 20), 1e-9);
}

TEST(Arrange, PutsPicturesRowAfterRow) {
    std::vector<Image> pictures;
    for (int i = 0; i < 5; ++i) {
        pictures.push_back(white(4, 3));
        std::fill(pictures.back().rgb.begin(), pictures.back().rgb.end(), static_cast<std::uint8_t>(10 * i));
    }
    const Image page = arrange(pictures, 2);
    ASSERT_EQ(page.width, 8U);
    ASSERT_EQ(page.height, 9U);
    for (std::uint32_t y = 0; y < 9; ++y) {
        for (std::uint32_t x = 0; x < 8; ++x) {
            const std::uint32_t i = y / 3 * 2 + x / 4;
            const int expected = i < 5 ? static_cast<int>(10 * i) : 249; // the page's own colour
            EXPECT_EQ(page.rgb[3 * (y * 8 + x)], expected);
        }
    }
}

TEST(Arrange, RefusesWhatMakesNoPage) {
    EXPECT_THROW(arrange({}, 2), Error);
    EXPECT_THROW(arrange(std::vector{white(2, 2)}, 0), Error);
    EXPECT_THROW(arrange(std::vector{white(2, 2), white(2, 3)}, 2), Error);
    EXPECT_THROW(arrange(std::vector{Image{5, 5, {}}}, 1), Error);
    EXPECT_THROW(arrange(std::vector<Image>(9, white(RenderOptions::kMaxSide / 8, 1)), 9), Error);
}

namespace {

const TriangleMesh kTorus = make_torus(1, 0.4, 24, 12);

DistanceMap small_map(const TriangleMesh& mesh) {
    DistanceMapOptions options;
    options.longitude_count = 48;
    options.colatitude_count = 48;
    return DistanceMap::build(mesh, options);
}

RenderOptions small_options() {
    RenderOptions options;
    options.width = 200;
    options.height = 100;
    options.samples = 2;
    return options;
}

/// Pixels of one half of the figure whose green exceeds their red by more than grey ones can.
int count_greenish(const Image& image, std::uint32_t left, std::uint32_t right) {
    int count = 0;
    for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = left; x < right; ++x) {
            const std::uint8_t* rgb = &image.rgb[3 * (std::size_t{y} * image.width + x)];
            if (rgb[1] > rgb[0] + 40) ++count;
        }
    }
    return count;
}

} // namespace

TEST(MapFigure, ShowsTheModelInGreyAndTheLayersInTheirColours) {
    const DistanceMap map = small_map(kTorus);
    const Image figure = draw_map_figure(kTorus, map, View{}, small_options());
    ASSERT_EQ(figure.width, 200U);
    ASSERT_EQ(figure.height, 100U);
    EXPECT_EQ(count_greenish(figure, 0, 100), 0);
    EXPECT_GT(count_greenish(figure, 100, 200), 100); // the first layer, the torus seen from its hole
}

TEST(MapFigure, PaintsTheFacesOfAnExactMapByTheirLists) {
    const ExactMap map = ExactMap::build(kTorus, {.divisions = 1}); // few cells, so that lists are long
    const Image figure = draw_map_figure(kTorus, map, View{}, small_options());
    ASSERT_EQ(figure.width, 200U);
    int reddish = 0;
    for (std::uint32_t y = 0; y < figure.height; ++y) {
        for (std::uint32_t x = 100; x < 200; ++x) {
            const std::uint8_t* rgb = &figure.rgb[3 * (std::size_t{y} * figure.width + x)];
            if (rgb[0] > rgb[2] + 60) ++reddish;
        }
    }
    EXPECT_GT(reddish, 100);
}

TEST(MapFigure, ReportsTheProgressOfBothHalvesAsOne) {
    std::vector<double> shares;
    RenderOptions options = small_options();
    options.progress = [&](double share) { shares.push_back(share); };
    const DistanceMap map = small_map(kTorus);
    draw_map_figure(kTorus, map, View{}, options);
    ASSERT_EQ(shares.size(), 200U);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
}

TEST(MapFigure, RefusesAMapWithoutSurface) {
    DistanceMapView empty;
    const std::vector<std::uint32_t> offsets(17);
    empty.radius = 1;
    empty.longitude_count = empty.colatitude_count = 4;
    empty.entry_offsets = offsets;
    EXPECT_THROW(draw_map_figure(kTorus, empty, View{}, small_options()), Error);
}

TEST(MapFigure, RefusesAFigureOfOnePixel) {
    RenderOptions options = small_options();
    options.width = 1;
    const DistanceMap map = small_map(kTorus);
    EXPECT_THROW(draw_map_figure(kTorus, map, View{}, options), Error);
}
