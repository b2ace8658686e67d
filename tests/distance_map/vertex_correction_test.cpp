#include <echinus/distance_map.hpp>

#include <gtest/gtest.h>

using namespace echinus;

namespace {

DistanceMap build(const TriangleMesh& mesh, VertexCorrection correction) {
    return DistanceMap::build(mesh,
                              {.longitude_count = 60, .colatitude_count = 30, .correction = correction});
}

/// The k-th entries of all directions come from layer k: on the torus rays enter at 0 and leave at 1.
template <typename Check>
void for_each_entry(const DistanceMapView& before, const DistanceMapView& after, Check check) {
    ASSERT_EQ(before.entry_count(), after.entry_count());
    for (std::size_t d = 0; d < before.direction_count(); ++d)
        for (std::uint32_t i = before.entry_offsets[d]; i < before.entry_offsets[d + 1]; ++i)
            check(i - before.entry_offsets[d], before.entries_float32[i], after.entries_float32[i]);
}

} // namespace

TEST(VertexCorrection, PaperOnlyIncreases) {
    const TriangleMesh torus = make_torus(1, 0.4, 17, 11);
    const DistanceMap plain = build(torus, VertexCorrection::None);
    const DistanceMap paper = build(torus, VertexCorrection::Paper);
    for_each_entry(plain, paper, [](std::uint32_t, float before, float after) { ASSERT_GE(after, before); });
    EXPECT_GT(paper.statistics().corrected_entries, 0U);
}

TEST(VertexCorrection, SignedGrowsTheSolidOnBothSides) {
    const TriangleMesh torus = make_torus(1, 0.4, 17, 11);
    const DistanceMap plain = build(torus, VertexCorrection::None);
    const DistanceMap corrected = build(torus, VertexCorrection::Signed);
    int decreased = 0, increased = 0;
    for_each_entry(plain, corrected, [&](std::uint32_t k, float before, float after) {
        if (k == 0)
            ASSERT_LE(after, before);
        else
            ASSERT_GE(after, before);
        decreased += after < before;
        increased += after > before;
    });
    EXPECT_GT(decreased, 0);
    EXPECT_GT(increased, 0);
    EXPECT_EQ(static_cast<unsigned>(decreased + increased), corrected.statistics().corrected_entries);
}

TEST(VertexCorrection, MakesTheMapReachEveryVertexOfAConvexMesh) {
    TriangleMesh ellipsoid = make_sphere(1, 13, 7);
    for (Vec3f& vertex : ellipsoid.vertices) vertex.x *= 0.7F;
    const DistanceMap plain = build(ellipsoid, VertexCorrection::None);
    const DistanceMap corrected = build(ellipsoid, VertexCorrection::Signed);
    int missed_before = 0;
    for (const Vec3f& vertex : ellipsoid.vertices) {
        if (length(vertex) > 0.95F) continue; // no room to grow inside the bounding sphere
        missed_before += !contains(plain, vertex * 0.9999F);
        EXPECT_TRUE(contains(corrected, vertex * 0.9999F));
    }
    EXPECT_GT(missed_before, 10);
}

// The paper: interpolation between samples of different faces "appears only in samples around the vertices of
// the object". It appears along whole edges, which no correction at vertices reaches (docs/paper.md).
TEST(VertexCorrection, LeavesTheErrorAlongEdgesFarFromTheirEnds) {
    const TriangleMesh box = make_box({1, 0.8, 0.6});
    const DistanceMap plain = build(box, VertexCorrection::None);
    const DistanceMap paper = build(box, VertexCorrection::Paper);
    const DistanceMap corrected = build(box, VertexCorrection::Signed);
    for (int i = -10; i <= 10; ++i) {
        const Vec3f under_an_edge{0.495F, 0.395F, 0.005F * static_cast<float>(i)};
        EXPECT_FALSE(contains(plain, under_an_edge));
        EXPECT_FALSE(contains(paper, under_an_edge));
        EXPECT_FALSE(contains(corrected, under_an_edge));
    }
    const Vec3f under_a_vertex{0.495F, 0.395F, 0.295F};
    EXPECT_FALSE(contains(plain, under_a_vertex));
    EXPECT_TRUE(contains(paper, under_a_vertex));
}

TEST(VertexCorrection, CountsWhatItClampsAtTheSphere) {
    // The vertices of a sphere mesh already lie at R, so the samples around them cannot grow by the full
    // error.
    const DistanceMap map = build(make_sphere(1, 200, 100), VertexCorrection::Paper);
    EXPECT_GT(map.statistics().clamped_entries, 0U);
    EXPECT_LE(map.statistics().clamped_entries, map.statistics().corrected_entries);
    EXPECT_EQ(build(make_sphere(1, 13, 7), VertexCorrection::None).statistics().corrected_entries, 0U);
}
