#include "compare/comparison_report.hpp"

#include <gtest/gtest.h>

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
