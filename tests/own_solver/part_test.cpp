// part(): a surface leaves models and itself, and tells what is left.

#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/surface_collision.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
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

/// Sheets of 21 x 21 vertices that are waves across each other: neither is on one side of the other.
TriangleMesh crossing_waves(std::size_t count) {
    TriangleMesh all;
    for (std::size_t i = 0; i < count; ++i) {
        TriangleMesh wave = sheet_mesh(21, 21);
        for (Vec3f& v : wave.vertices)
            v = v + Vec3f{0.0031F * static_cast<float>(i), 0.0017F,
                          0.04F * std::sin(9 * v.x + 2.1F * static_cast<float>(i))};
        all = joined({all, wave});
    }
    return all;
}

/// A tube around the z axis without caps, whose normals point outward. The radius depends on the place.
TriangleMesh make_tube(std::uint32_t segments, std::uint32_t rings, float length, const auto& radius) {
    TriangleMesh tube;
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t i = 0; i < segments; ++i) {
            const float angle =
                2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(segments);
            const float z = length * (static_cast<float>(ring) / static_cast<float>(rings - 1) - 0.5F);
            const float r = radius(angle, z);
            tube.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
        }
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring)
        for (std::uint32_t i = 0; i < segments; ++i) {
            const std::uint32_t a = ring * segments + i, b = ring * segments + (i + 1) % segments;
            tube.faces.push_back({a, b, a + segments});
            tube.faces.push_back({b, b + segments, a + segments});
        }
    return tube;
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

TEST(Part, BringsLayersIntoTheOrderOfTheirNumbers) {
    const TriangleMesh waves = crossing_waves(3);
    ASSERT_FALSE(self_intersecting_pairs(waves).empty());
    const std::size_t size = waves.vertices.size() / 3;
    for (const std::array<std::uint8_t, 3>& numbers : {std::array<std::uint8_t, 3>{0, 1, 2}, {7, 3, 200}}) {
        PartOptions options;
        for (const std::uint8_t number : numbers) options.layers.insert(options.layers.end(), size, number);
        const Parted parted = part(waves, {}, options);
        expect_apart(parted, waves, {});
        EXPECT_LT(parted.largest_stretch, 0.02);
        for (std::size_t v = 0; v < size; ++v) // without the borders, where sheets may pass each other
            for (std::size_t a = 0; a < 3; ++a)
                for (std::size_t b = 0; b < 3; ++b)
                    if (const std::size_t x = v % 21, y = v / 21;
                        numbers[a] < numbers[b] && x > 2 && x < 18 && y > 2 && y < 18)
                        ASSERT_LT(parted.vertices[a * size + v].z, parted.vertices[b * size + v].z) << v;
    }
}

TEST(Part, MovesAnOuterLayerOutOfAnInnerOneThatItDoesNotIntersect) {
    const TriangleMesh inner = sheet_mesh(21, 21),
                       outer = translated(sheet_mesh(11, 11), {0.011F, 0.007F, -0.05F});
    const TriangleMesh both = joined({inner, outer});
    PartOptions options;
    options.layers.assign(inner.vertices.size(), 0);
    options.layers.resize(both.vertices.size(), 1);
    const Parted parted = part(both, {}, options);
    expect_apart(parted, both, {});
    const std::size_t middle = inner.vertices.size() + outer.vertices.size() / 2;
    EXPECT_GT(parted.vertices[middle].z, parted.vertices[inner.vertices.size() / 2].z);
    std::swap(options.layers.front(), options.layers.back());
    options.layers.assign(inner.vertices.size(), 1);
    options.layers.resize(both.vertices.size(), 0);
    EXPECT_EQ(part(both, {}, options).vertices, both.vertices) << "in order";
}

TEST(Part, FindsTheOuterSideOfLayersByTheBodyAndNotByTheirFaces) {
    const std::vector<TriangleMesh> body{make_sphere(0.2, 24, 16)};
    const auto waves = [](float phase) {
        return make_tube(36, 15, 0.25F, [=](float angle, float z) {
            return std::sqrt(0.05F - z * z) + 0.02F * std::sin(5 * angle + 20 * z + phase);
        });
    };
    const TriangleMesh inner = waves(0), outer = turned_inside_out(waves(1.3F));
    const TriangleMesh both = joined({inner, outer});
    PartOptions options;
    options.layers.assign(inner.vertices.size(), 0);
    options.layers.resize(both.vertices.size(), 1);
    const Parted parted = part(both, body, options);
    expect_apart(parted, both, body);
    const std::size_t size = inner.vertices.size();
    const ExactMap moved_inner = ExactMap::build(
        {std::vector(parted.vertices.begin(), parted.vertices.begin() + std::ptrdiff_t(size)), inner.faces});
    for (std::size_t v = size + 3 * 36; v < 2 * size - 3 * 36; ++v) // without the borders
        ASSERT_TRUE(sweep(moved_inner, {}, parted.vertices[v]).found()) << v;
}

TEST(Part, BringsTrousersIntoOrderOnTwoLegsThatAreNearEachOther) {
    const auto leg = [](std::size_t number) { // an ellipsoid
        TriangleMesh mesh = make_sphere(1, 24, 16);
        for (Vec3f& v : mesh.vertices)
            v = {0.5F * v.x + (number == 0 ? -0.56F : 0.56F), 0.5F * v.y, 1.5F * v.z};
        return mesh;
    };
    const std::vector<TriangleMesh> legs{leg(0), leg(1)};
    const auto trousers = [](float phase) {
        const TriangleMesh tube = make_tube(28, 14, 1.8F, [=](float angle, float z) {
            return 0.52F * std::sqrt(1 - z * z / 2.25F) + 0.03F * std::sin(5 * angle + 9 * z + phase);
        });
        return joined({translated(tube, {-0.56F, 0, 0}), translated(tube, {0.56F, 0, 0})});
    };
    const TriangleMesh both = joined({trousers(0), trousers(2)});
    PartOptions options;
    options.layers.assign(both.vertices.size() / 2, 0);
    options.layers.resize(both.vertices.size(), 1);
    const Parted parted = part(both, legs, options);
    expect_apart(parted, both, legs);
    EXPECT_LT(parted.largest_displacement, 0.2) << "no leg is thrown off";
    EXPECT_LT(parted.largest_stretch, 0.1);
}

TEST(Part, MovesASleeveOutOfTheChestWhereItWentIn) {
    const auto ellipsoid = [](float radius) {
        TriangleMesh mesh = make_sphere(1, 32, 24);
        for (Vec3f& v : mesh.vertices) v = {radius * v.x, radius * v.y, 0.4F * v.z};
        return mesh;
    };
    const auto garment = [](std::uint32_t segments, float radius, float gap) {
        return make_tube(segments, 24, 0.4F,
                         [=](float, float z) { return radius * std::sqrt(1 - z * z / 0.16F) + gap; });
    };
    const Vec3f to_chest{0.206F, 0, 0};
    const std::vector<TriangleMesh> body{joined({ellipsoid(0.05F), translated(ellipsoid(0.15F), to_chest)})};
    const TriangleMesh shirt =
        joined({garment(24, 0.05F, 0.02F), translated(garment(60, 0.15F, 0.01F), to_chest)});
    ASSERT_FALSE(intersecting_pairs(shirt, body[0]).empty());
    const Parted parted = part(shirt, body);
    expect_apart(parted, shirt, body);
    EXPECT_LT(parted.largest_stretch, 0.02);
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
    expect_error(ErrorCode::InvalidOptions, "layers has 1 entries; it needs one for each of the 25 vertices",
                 [&] { part(sheet, {}, {.layers = {1}}); });
    PartOptions mixed;
    mixed.layers.resize(25);
    mixed.layers[24] = 1;
    expect_error(ErrorCode::InvalidOptions, "face 30 are in different layers",
                 [&] { part(sheet, {}, mixed); });
    TriangleMesh turned = sheet;
    std::swap(turned.faces[7][0], turned.faces[7][1]);
    expect_error(ErrorCode::InvalidMesh, "3 edges have faces that face opposite sides (first at face ",
                 [&] { part(turned, {}, {.layers = std::vector<std::uint8_t>(25)}); });
    TriangleMesh hostile = sheet;
    hostile.faces[3][1] = 400;
    expect_error(ErrorCode::InvalidMesh, "", [&] { part(hostile, {}, mixed); });
    expect_error(ErrorCode::InvalidOptions, "the thickness is more than four times the mean edge length",
                 [&] { part(sheet, {}, {.thickness = 2}); });
    expect_error(ErrorCode::InvalidOptions, "the thickness is 0", [&] { part(sheet, {}, {.thickness = 0}); });
    expect_error(ErrorCode::InvalidMesh, "", [&] { part({}, {}); });
}
