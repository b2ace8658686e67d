#include "compare/columns.hpp"
#include "compare/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace echinus;
using namespace echinus::comparison;

namespace {

Figures figures_of(const char* name, std::size_t bytes, double wrong_share) {
    Figures figures{&system_named(name), bytes, "samples", {}, 12.345, {}};
    SetFigures near{"S", {7.25, 0, {}}, {123.4, 0, {}}, {}};
    near.errors.wrong_share = wrong_share;
    near.errors.depth = {100, 0.000'000'1, 0.01, 0.5};
    figures.sets.push_back(near);
    return figures;
}

Comparison small_comparison() {
    return {720, 1.4, {"U", "S"}, {figures_of("dense", 630'000, 0.0329)}, {}, false, {}};
}

std::string row(const std::vector<Column>& columns, const Figures& figures) {
    std::string text;
    for (const Column& column : columns) text += column.head + ' ' + column.cell(figures) + '|';
    return text;
}

} // namespace

TEST(Columns, ShowThreeDigitsAndADashWhereNothingWasAskedOrJudged) {
    const Comparison comparison = small_comparison();
    EXPECT_EQ(row(time_columns(comparison), comparison.systems[0]), "MB 0.630|ms 12.3|U -|S 7.25|U -|S 123|");
    EXPECT_EQ(row(error_columns(comparison), comparison.systems[0]),
              "U -|S 3.29|mean <0.0001|99 % 1.00|worst 50.0|mean -|99 % -|");
}

TEST(Columns, HaveRemarksOnWhoExceedsTheBudgetAndWhoRefused) {
    Comparison comparison = small_comparison();
    EXPECT_TRUE(remarks_on(comparison).empty());
    comparison.systems[0].excess = "the coarsest has 9";
    comparison.parts_overlap = true;
    comparison.refusals.push_back({&system_named("classified"), "too small"});
    const std::vector<std::string> remarks = remarks_on(comparison);
    ASSERT_EQ(remarks.size(), 3U);
    EXPECT_NE(remarks[0].find("dense grid: more bytes than it may take; the coarsest has 9"),
              std::string::npos);
    EXPECT_NE(remarks[2].find("Parts of the mesh overlap"), std::string::npos);
    EXPECT_NE(remarks[1].find("classified grid: left out; too small"), std::string::npos);
}

TEST(CurvePlots, PutAnErrorOfZeroAtTheEdgeAndLeaveOutWhatHasNoSizes) {
    Comparison comparison = small_comparison();
    comparison.curves = {{figures_of("exact", 300'000, 0), figures_of("exact", 600'000, 0)}, {}};
    const std::vector<Plot> plots = curve_plots(comparison);
    ASSERT_EQ(plots.size(), 4U);
    for (const Plot& plot : plots) {
        ASSERT_EQ(plot.curves.size(), 1U) << plot.title;
        EXPECT_EQ(plot.curves[0].points.size(), 2U) << plot.title;
        for (const PlotPoint& p : plot.curves[0].points) EXPECT_GT(std::min(p.x, p.y), 0) << plot.title;
    }
}

TEST(CurvePlots, HaveAColourForEachSystem) {
    std::set<std::string> colours;
    for (const SystemType& system : all_systems()) colours.insert(line_style_of(system).colour);
    EXPECT_EQ(colours.size(), all_systems().size());
    EXPECT_FALSE(colours.contains("#444444")); // that of a system without one
}

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
