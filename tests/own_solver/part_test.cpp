// part(): a surface leaves models and itself, and tells what is left.

#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/surface_collision.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

/// A square sheet that stands upright, halfway in a box around the origin.
TriangleMesh standing_sheet() {
    TriangleMesh sheet = sheet_mesh(21, 21);
    for (Vec3f& v : sheet.vertices) v = {v.x, 0.013F, v.y + 0.3F};
    return sheet;
}

void expect_apart(const Parted& parted, const TriangleMesh& surface,
                  const std::vector<TriangleMesh>& models) {
    EXPECT_TRUE(parted.is_apart());
    const TriangleMesh moved{parted.vertices, surface.faces};
    EXPECT_TRUE(self_intersecting_pairs(moved).empty());
    for (const TriangleMesh& model : models) {
        EXPECT_TRUE(intersecting_pairs(moved, model).empty());
        const ExactMap map = ExactMap::build(model);
        for (const Vec3f& p : parted.vertices) EXPECT_FALSE(contains(map, p));
    }
}

} // namespace

TEST(Part, ReturnsTheFewestPairsOfASurfaceThatCannotBeParted) {
    const TriangleMesh bottle = klein_bottle();
    const std::size_t before = self_intersecting_pairs(bottle).size();
    ASSERT_GT(before, 0U);
    const Parted parted = part(bottle, {});
    EXPECT_FALSE(parted.is_apart());
    EXPECT_FALSE(parted.own_pairs.empty());
    EXPECT_LE(parted.own_pairs.size(), before);
    EXPECT_EQ(parted.own_pairs, self_intersecting_pairs({parted.vertices, bottle.faces}));
}

TEST(Part, MovesASheetOutOfABoxWithoutStretchingIt) {
    const std::vector<TriangleMesh> box{make_box({1.3, 1.1, 0.9})};
    const TriangleMesh sheet = standing_sheet();
    const Parted parted = part(sheet, box);
    expect_apart(parted, sheet, box);
    EXPECT_LT(parted.largest_stretch, 0.02);
    EXPECT_EQ(parted.stretched_share, 0);
}

TEST(Part, MovesASheetOutOfABodyThatIntersectsItself) {
    const TriangleMesh ball = make_sphere(0.3, 20, 10);
    const std::vector<TriangleMesh> body{joined({ball, translated(ball, {0.25F, 0.1F, 0.02F})})};
    ASSERT_FALSE(self_intersecting_pairs(body[0]).empty());
    const TriangleMesh sheet = translated(sheet_mesh(25, 25), {0.1F, 0, 0.1F});
    expect_apart(part(sheet, body), sheet, body);
}

TEST(Part, LiftsASheetOffARodThatComesThroughOneFace) {
    for (const float tip : {0.01F, 0.1F, 0.3F}) {
        const std::vector<TriangleMesh> rod{
            translated(make_box({0.03, 0.03, 1}), {0.06F, 0.035F, tip - 0.5F})};
        const TriangleMesh sheet = sheet_mesh(11, 11);
        SCOPED_TRACE(tip);
        expect_apart(part(sheet, rod), sheet, rod);
    }
}

TEST(Part, MovesModelsInOtherFramesToThatOfTheSurface) {
    TriangleMesh box = make_box({1.25, 1, 1}),
                 sheet = standing_sheet(); // whose coordinates floats hold after the move
    const Parted near = part(sheet, std::vector{box});
    for (Vec3f& v : box.vertices) v = v + Vec3f{64, 0, 0};
    sheet.origin = {1e6, 0, 0};
    box.origin = {1e6 - 64, 0, 0};
    EXPECT_EQ(part(sheet, std::vector{box}).vertices, near.vertices);
}

TEST(Part, ReturnsASurfaceThatIsApartAsItIs) {
    const TriangleMesh sheet = translated(sheet_mesh(9, 9), {0, 0, 2});
    const Parted parted = part(sheet, std::vector{make_box({1, 1, 1})});
    EXPECT_EQ(parted.vertices, sheet.vertices);
    EXPECT_TRUE(parted.is_apart());
    EXPECT_EQ(parted.largest_stretch, 0);
}

TEST(Part, LeavesPinnedVerticesAndTellsWhatThatLeavesInside) {
    const std::vector<TriangleMesh> box{make_box({1.3, 1.1, 0.9})};
    const TriangleMesh sheet = standing_sheet();
    PartOptions options;
    options.pinned.resize(sheet.vertices.size());
    std::uint32_t deepest = 0;
    for (std::uint32_t v = 0; v < sheet.vertices.size(); ++v)
        if (sheet.vertices[v].z < sheet.vertices[deepest].z) deepest = v;
    options.pinned[deepest] = 1;
    const Parted parted = part(sheet, box, options);
    EXPECT_FALSE(parted.is_apart());
    EXPECT_EQ(parted.vertices[deepest], sheet.vertices[deepest]);
    EXPECT_TRUE(std::ranges::count(parted.inside, deepest) == 1);
    EXPECT_FALSE(parted.model_pairs[0].empty());
}

TEST(Part, GivesTheSameBitsWithAnyNumberOfThreads) {
    const std::vector<TriangleMesh> box{make_box({1.3, 1.1, 0.9})};
    const Parted on_one = part(standing_sheet(), box);
    EXPECT_EQ(part(standing_sheet(), box, {.thread_count = 3}).vertices, on_one.vertices);
}

TEST(Part, ReportsProgressThatAnExceptionEnds) {
    const std::vector<TriangleMesh> box{make_box({1.3, 1.1, 0.9})};
    std::vector<double> shares;
    part(standing_sheet(), box, {.progress = [&](double share) { shares.push_back(share); }});
    ASSERT_GT(shares.size(), 3U);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_EQ(shares.back(), 1);
    struct Cancelled {};
    EXPECT_THROW(part(standing_sheet(), box, {.progress = [](double) { throw Cancelled(); }}), Cancelled);
}

TEST(Part, NamesTheModelOrTheOptionAtFault) {
    const TriangleMesh sheet = sheet_mesh(5, 5);
    const TriangleMesh point{{{0, 0, 0}}, {{0, 0, 0}}};
    expect_error(ErrorCode::InvalidMesh, "model 1: ", [&] {
        part(sheet, std::vector{make_box({1, 1, 1}), point});
    });
    expect_error(ErrorCode::InvalidOptions, "pinned has 3 entries; it needs one for each of the 25 vertices",
                 [&] {
                     part(sheet, {}, {.pinned = {0, 1, 0}});
                 });
    expect_error(ErrorCode::InvalidOptions, "the thickness is 0", [&] { part(sheet, {}, {.thickness = 0}); });
    expect_error(ErrorCode::InvalidMesh, "", [&] { part({}, {}); });
}
