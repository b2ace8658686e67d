#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <gtest/gtest.h>

#include <algorithm>

using namespace echinus;

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
