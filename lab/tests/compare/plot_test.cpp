#include "compare/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus::comparison;

namespace {

Plot small_plot() {
    return {
        "error & bytes", "MB", "%", {{.name = "a < b", .points = {{1, 10}, {10, 1}}, .colour = "#123456"}}};
}

std::size_t count(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
    return found;
}

} // namespace

TEST(Plot, DrawsACurveWithItsPointsAndItsName) {
    const std::string document = svg(small_plot());
    EXPECT_EQ(count(document, "<svg"), 1U);
    EXPECT_EQ(count(document, "</svg>"), 1U);
    EXPECT_EQ(count(document, "<polyline"), 1U);
    EXPECT_EQ(count(document, "<circle"), 2U);
    EXPECT_EQ(count(document, "#123456"), 4U); // line, two points, legend
}

TEST(Plot, EscapesWhatMarkupWouldTakeForItsOwn) {
    const std::string document = svg(small_plot());
    EXPECT_EQ(count(document, "a &lt; b"), 1U);
    EXPECT_EQ(count(document, "error &amp; bytes"), 1U);
    EXPECT_EQ(count(document, "a < b"), 0U);
}

TEST(Plot, OfNothingIsAnEmptyDiagram) {
    const std::string document = svg({"nothing", "x", "y", {}});
    EXPECT_EQ(count(document, "nan"), 0U);
    EXPECT_EQ(count(document, "inf"), 0U);
    EXPECT_EQ(count(document, "</svg>"), 1U);
}

TEST(Plot, FitsTheExponentOfAPowerLaw) {
    std::vector<PlotPoint> points;
    for (double x = 1; x < 1e4; x *= 3) points.push_back({x, 7 * std::pow(x, 1.5)});
    EXPECT_NEAR(fitted_exponent(points), 1.5, 1e-9);
    points.push_back({1e-3, 1e6}); // left out
    EXPECT_NEAR(fitted_exponent(points, 1), 1.5, 1e-9);
}
