#include "compare/compare.hpp"
#include "compare/comparison_report.hpp"
#include "compare/systems.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

using namespace echinus;
using namespace echinus::comparison;

namespace {

TriangleMesh torus() {
    return make_torus(1, 0.4, 30, 12);
}

CompareOptions quick(std::vector<std::string> systems) {
    CompareOptions options;
    options.systems = std::move(systems);
    options.byte_budget = 100'000;
    options.point_count = 2500;
    return options;
}

const SetFigures& on(const Figures& figures, const std::string& set) {
    return *std::ranges::find(figures.sets, set, &SetFigures::set);
}

} // namespace

TEST(Compare, FindsTheExactMapWithoutErrorAndASampledOneWith) {
    const Comparison result = compare(torus(), quick({"exact", "dense", "distance"}));
    ASSERT_EQ(result.systems.size(), 3U);
    EXPECT_EQ(result.face_count, 720U);
    EXPECT_NEAR(result.radius, 1.4, 1e-6);
    for (const char* set : {"U", "S", "C"}) {
        const SetFigures& exact = on(result.systems[0], set);
        EXPECT_EQ(exact.errors.wrong_share, 0) << set;
        EXPECT_LT(exact.errors.depth.worst, 1e-6) << set;
        EXPECT_EQ(exact.errors.asked_count, 2500U) << set;
        EXPECT_GT(exact.errors.normal.count, 100U) << set;
        EXPECT_LT(exact.errors.normal.mean, 0.1) << set; // the judge itself, rounded
    }
    for (const std::size_t sampled : {1U, 2U}) {
        EXPECT_GT(on(result.systems[sampled], "S").errors.wrong_share, 0.001);
        EXPECT_LT(on(result.systems[sampled], "S").errors.wrong_share, 0.2);
        EXPECT_GT(on(result.systems[sampled], "C").errors.wrong_share, 0.001);
    }
    // Along the ray from the centre is not the nearest way out, along the field's gradient is.
    EXPECT_GT(on(result.systems[2], "S").errors.depth.mean, 2 * on(result.systems[1], "S").errors.depth.mean);
}

TEST(Compare, MeasuresWhatASystemTakes) {
    const Comparison result = compare(torus(), quick({"dense", "exact"}));
    EXPECT_EQ(result.systems[0].system->name, "dense"); // in the order that was asked for
    for (const Figures& figures : result.systems) {
        EXPECT_GT(figures.byte_count, 10'000U);
        EXPECT_GT(figures.build_ms, 0);
        EXPECT_FALSE(figures.counted.empty());
        for (const SetFigures& set : figures.sets) {
            EXPECT_GT(set.contains.ns, 0);
            EXPECT_GT(set.contacts.ns, 0);
        }
    }
}

TEST(Compare, KeepsTheErrorsOfARunForTheNext) {
    const CompareOptions options = quick({"dense", "distance"});
    const Comparison a = compare(torus(), options), b = compare(torus(), options);
    for (std::size_t k = 0; k < a.systems.size(); ++k)
        for (std::size_t s = 0; s < a.set_names.size(); ++s) {
            EXPECT_EQ(a.systems[k].sets[s].errors.wrong_share, b.systems[k].sets[s].errors.wrong_share);
            EXPECT_EQ(a.systems[k].sets[s].errors.depth.mean, b.systems[k].sets[s].errors.depth.mean);
            EXPECT_EQ(a.systems[k].sets[s].errors.normal.mean, b.systems[k].sets[s].errors.normal.mean);
        }
}

TEST(Compare, DrawsCurvesThatFallWithTheBytes) {
    CompareOptions options = quick({"dense", "exact"});
    options.curve_length = 4;
    const Comparison result = compare(torus(), options);
    ASSERT_EQ(result.curves.size(), 2U);
    const std::vector<Figures>& dense = result.curves[0];
    ASSERT_EQ(dense.size(), 4U);
    for (std::size_t k = 1; k < dense.size(); ++k) {
        EXPECT_GT(dense[k].byte_count, dense[k - 1].byte_count);
        EXPECT_LT(dense[k].sets[0].errors.depth.mean, dense[k - 1].sets[0].errors.depth.mean);
    }
    EXPECT_LE(dense.back().byte_count, 800'000U);
    for (const Figures& figures : result.curves[1]) EXPECT_EQ(figures.sets[0].errors.wrong_share, 0);
}

TEST(Compare, LeavesOutWhoDoesNotFitAndSaysWhy) {
    CompareOptions options = quick({"dense", "exact", "classified"});
    options.byte_budget = 1000;
    const Comparison result = compare(torus(), options);
    ASSERT_EQ(result.refusals.size(), 1U);
    EXPECT_EQ(result.refusals[0].system->name, "classified");
    EXPECT_FALSE(result.refusals[0].reason.empty());
    ASSERT_EQ(result.systems.size(), 2U);
    EXPECT_LE(result.systems[0].byte_count, 1000U);
    EXPECT_GT(result.systems[1].byte_count, 1000U); // the exact map at its usual size
    EXPECT_NE(result.systems[1].excess.find("coarsest"), std::string::npos);
    EXPECT_TRUE(result.systems[0].excess.empty());
    options.systems = {"classified"};
    test::expect_error(ErrorCode::InvalidOptions, "no system fits", [&] { (void)compare(torus(), options); });
}

TEST(Compare, DrawsTheExactMapInAscendingSizesWithoutTheOnesThatDoNotFit) {
    CompareOptions options = quick({"exact"});
    options.byte_budget = 20'000;
    options.curve_length = 8;
    const Comparison result = compare(torus(), options);
    for (std::size_t k = 1; k < result.curves[0].size(); ++k)
        EXPECT_GT(result.curves[0][k].byte_count, result.curves[0][k - 1].byte_count);
    ASSERT_FALSE(result.curves[0].empty());
    EXPECT_LE(result.curves[0].back().byte_count, 160'000U);
}

/// More parts than a superquadric map can be cut from in useful time.
TriangleMesh crowd_of_tetrahedra() {
    TriangleMesh mesh;
    constexpr std::uint32_t kSide = 19; // 27 436 faces
    for (std::uint32_t i = 0; i < kSide * kSide * kSide; ++i) {
        const Vec3f corner{2.0F * static_cast<float>(i % kSide), 2.0F * static_cast<float>(i / kSide % kSide),
                           2.0F * static_cast<float>(i / kSide / kSide)};
        for (const Vec3f& step : {Vec3f{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
            mesh.vertices.push_back(corner + step);
        for (const Triangle& face : {Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
            mesh.faces.push_back({4 * i + face[0], 4 * i + face[1], 4 * i + face[2]});
    }
    return mesh;
}

TEST(Compare, GoesOnWithoutASystemThatCannotHaveTheMesh) {
    if (!std::ranges::find(all_systems(), "superquadric", &SystemType::name)->available())
        GTEST_SKIP() << "built without superquadric maps";
    CompareOptions options = quick({"dense", "superquadric"});
    options.point_count = 100;
    const Comparison result = compare(crowd_of_tetrahedra(), options);
    ASSERT_EQ(result.systems.size(), 1U);
    ASSERT_EQ(result.refusals.size(), 1U);
    EXPECT_EQ(result.refusals[0].system->name, "superquadric");
    EXPECT_NE(result.refusals[0].reason.find("too long"), std::string::npos);
}

/// A box is flat on top, so that half of the set C lies on it.
TEST(Compare, CallsNobodyWrongAboutParticlesOnTheSurfaceItself) {
    CompareOptions options = quick({"exact", "classified"});
    options.byte_budget = 630'000;
    for (const Figures& figures : compare(make_box({1, 1, 1}), options).systems)
        for (const SetFigures& set : figures.sets) EXPECT_EQ(set.errors.wrong_share, 0) << set.set;
    if (!system_named("embree").available()) GTEST_SKIP() << "without Embree";
    options.systems = {"embree"};
    EXPECT_EQ(on(compare(make_box({1, 1, 1}), options).systems[0], "C").errors.wrong_share, 0);
}

TEST(Compare, SaysWhenPartsOverlapSoThatInsideHasTwoMeanings) {
    EXPECT_FALSE(compare(torus(), quick({"exact"})).parts_overlap);
    TriangleMesh nested = make_box({1, 1, 1});
    const TriangleMesh inner = make_box({0.5, 0.5, 0.5});
    for (const Triangle& face : inner.faces) nested.faces.push_back({face[0] + 8, face[1] + 8, face[2] + 8});
    nested.vertices.insert(nested.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    EXPECT_TRUE(compare(nested, quick({"exact"})).parts_overlap);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
    TriangleMesh open = torus();
    open.faces.pop_back();
    test::expect_error(ErrorCode::InvalidMesh, "not closed", [&] { (void)compare(open, quick({"exact"})); });
    TriangleMesh point = torus();
    for (Vec3f& p : point.vertices) p = {1, 1, 1};
    test::expect_error(ErrorCode::InvalidMesh, "", [&] { (void)compare(point, quick({"exact"})); });
    test::expect_error(ErrorCode::InvalidMesh, "", [&] { (void)compare({}, quick({"exact"})); });
    test::expect_error(ErrorCode::InvalidOptions, "octree",
                       [&] { (void)compare(torus(), quick({"octree"})); });
    test::expect_error(ErrorCode::InvalidOptions, "'exact' is named twice", [&] {
        (void)compare(torus(), quick({"exact", "dense", "exact"}));
    });
    CompareOptions options = quick({"exact"});
    options.byte_budget = 0;
    test::expect_error(ErrorCode::InvalidOptions, "budget", [&] { (void)compare(torus(), options); });
    options.byte_budget = CompareOptions::kMaxBytes + 1;
    test::expect_error(ErrorCode::InvalidOptions, "budget", [&] { (void)compare(torus(), options); });
    options = quick({"exact"});
    options.point_count = 99;
    test::expect_error(ErrorCode::InvalidOptions, "point_count", [&] { (void)compare(torus(), options); });
}

TEST(Compare, TellsOfItsProgressAndStopsWhenTheListenerThrows) {
    CompareOptions options = quick({"exact"});
    std::string stages;
    options.report_progress = [&](const std::string& what, double fraction) {
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1.000001);
        if (!stages.ends_with(what)) stages += "|" + what;
    };
    (void)compare(torus(), options);
    EXPECT_EQ(stages,
              "|judging the particles|building: exact map|asking about U|asking about S|asking about C");
    options.report_progress = [](const std::string& what, double) {
        if (what == "asking about S") throw std::runtime_error("stop");
    };
    EXPECT_THROW((void)compare(torus(), options), std::runtime_error);
}

namespace {

SystemOptions few_segments() {
    return {.segment_count = 3};
}

} // namespace

TEST(Systems, HaveNamesOfOneWordThatNoTwoShare) {
    std::set<std::string_view> names;
    for (const SystemType& system : all_systems()) {
        EXPECT_TRUE(names.insert(system.name).second) << system.name;
        EXPECT_EQ(system.name.find_first_of(" ,"), std::string_view::npos) << system.name;
        EXPECT_EQ(&system_named(system.name) == &system, true) << system.name;
        EXPECT_EQ(system.available() || !system.package.empty(), true) << system.name;
    }
    for (const char* part : {"superquadric", "dense", "openvdb", "embree", "exact", "distance"})
        EXPECT_TRUE(std::ranges::any_of(names, [&](std::string_view name) {
            return name.find(part) != std::string_view::npos;
        })) << part;
}

TEST(Systems, ThatDoNotExistAreRefusedByNameWithThoseThatDo) {
    test::expect_error(ErrorCode::InvalidOptions, "exact, distance", [] { (void)system_named("octree"); });
}

TEST(Systems, KeepWithinTheirBudgetAndUseMostOfIt) {
    const TriangleMesh torus = make_torus(1, 0.4, 30, 12);
    constexpr std::size_t kBudget = 400'000;
    for (const SystemType& system : all_systems()) {
        if (!system.available()) continue;
        const auto sizes = system.on(torus, few_segments(), {});
        const Built built = sizes->within(kBudget).build();
        EXPECT_LE(built->byte_count(), kBudget) << system.name;
        if (system.has_sizes && system.name != "exact") // whose cells come in few sizes
            EXPECT_GE(built->byte_count(), kBudget * 8 / 10) << system.name;
    }
}

TEST(Systems, BuildTheSameAgain) {
    const TriangleMesh torus = make_torus(1, 0.4, 20, 10);
    for (const SystemType& system : all_systems()) {
        if (!system.available()) continue;
        const Builder builder = system.on(torus, few_segments(), {})->within(350'000);
        EXPECT_EQ(builder.build()->byte_count(), builder.build()->byte_count()) << system.name;
    }
}

TEST(Systems, RefuseABudgetBelowTheirCoarsestButForThoseWithoutSizes) {
    const TriangleMesh torus = make_torus(1, 0.4, 20, 10);
    for (const SystemType& system : all_systems()) {
        if (!system.available()) continue;
        const auto sizes = system.on(torus, few_segments(), {});
        EXPECT_EQ(sizes->usual().has_value(), system.name == "exact");
        if (!system.has_sizes)
            EXPECT_GT(sizes->within(15).build()->byte_count(), 15U) << system.name;
        else
            test::expect_error(ErrorCode::InvalidOptions, "", [&] { (void)sizes->within(15).build(); });
    }
}

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
    EXPECT_NE(remarks[0].find("dense grid: exceeds the size limit; the coarsest has 9"), std::string::npos);
    EXPECT_NE(remarks[2].find("Parts of the mesh overlap"), std::string::npos);
    EXPECT_NE(remarks[1].find("classified grid: left out; too small"), std::string::npos);
}
