#include "directions/face_cone.hpp"
#include "distance_map/build/vertex_correction.hpp"
#include "support/expectations.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace echinus;

namespace {

std::vector<float> entries_of(const DistanceMapView& map, std::size_t direction) {
    return {map.entries_float32.begin() + map.entry_offsets[direction],
            map.entries_float32.begin() + map.entry_offsets[direction + 1]};
}

void expect_refused(ErrorCode code, const TriangleMesh& mesh, const DistanceMapOptions& options = {}) {
    test::expect_error(code, "", [&] { DistanceMap::build(mesh, options); });
}

} // namespace

TEST(DistanceMapBuild, GivesASphereOneEntryNearItsRadiusEverywhere) {
    const DistanceMap map =
        DistanceMap::build(make_sphere(2, 200, 100), {.correction = VertexCorrection::None});
    EXPECT_TRUE(map.view().centre_inside);
    EXPECT_EQ(map.view().entry_count(), 40'000U);
    const double sagitta = 2 * (1 - std::cos(std::numbers::pi / 100)); // a facet's distance below the sphere
    for (float entry : map.view().entries_float32) {
        EXPECT_LE(entry, 2.00001F);
        EXPECT_GE(entry, 2 - sagitta);
    }
}

TEST(DistanceMapBuild, GivesATorusTwoEntriesWhereItsRayMeetsTheTube) {
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    const DistanceMap map = DistanceMap::build(torus, {.correction = VertexCorrection::None});
    EXPECT_FALSE(map.view().centre_inside);
    EXPECT_EQ(map.statistics().max_entries, 2U);
    const auto histogram = entry_histogram(map);
    ASSERT_EQ(histogram.size(), 3U);
    EXPECT_EQ(histogram[1], 0U);
    // In the half plane of one longitude the ray at elevation a meets the circle of the tube where cos(a) -+
    // sqrt(0.16 - sin(a)^2); the facets lie at most 0.02 inside it.
    for (std::uint32_t j = 0; j < 200; ++j)
        for (std::uint32_t i = 0; i < 200; ++i) {
            const double elevation = std::numbers::pi * (0.5 - (j + 0.5) / 200);
            const double under_root = 0.16 - std::sin(elevation) * std::sin(elevation);
            const auto entries = entries_of(map, j * 200 + i);
            if (under_root < 0) ASSERT_TRUE(entries.empty());
            if (under_root < 0.02) continue;
            ASSERT_EQ(entries.size(), 2U);
            ASSERT_NEAR(entries[0], std::cos(elevation) - std::sqrt(under_root), 0.03);
            ASSERT_NEAR(entries[1], std::cos(elevation) + std::sqrt(under_root), 0.03);
        }
}

TEST(DistanceMapBuild, KeepsEntriesSortedInTheSphereForEveryCorrectionAndFormat) {
    for (const TriangleMesh& mesh :
         {make_torus(1, 0.4, 24, 10), make_box({1, 2, 0.1}, 3), make_sphere(1, 9, 5)})
        for (auto correction : {VertexCorrection::None, VertexCorrection::Paper, VertexCorrection::Signed})
            for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
                const DistanceMap map = DistanceMap::build(mesh, {.longitude_count = 64,
                                                                  .colatitude_count = 33,
                                                                  .correction = correction,
                                                                  .pole_axis = axis});
                for (std::size_t d = 0; d < map.view().direction_count(); ++d) {
                    const auto entries = entries_of(map, d);
                    ASSERT_TRUE(std::is_sorted(entries.begin(), entries.end()));
                    for (float entry : entries) ASSERT_TRUE(entry >= 0 && entry <= map.view().radius);
                }
            }
}

TEST(DistanceMapBuild, GivesTheSameBytesForEveryNumberOfThreads) {
    const TriangleMesh mesh = make_torus(1, 0.4, 60, 24);
    const DistanceMap one = DistanceMap::build(mesh, {.thread_count = 1});
    for (unsigned thread_count : {0U, 2U, 3U}) {
        const DistanceMap many = DistanceMap::build(mesh, {.thread_count = thread_count});
        EXPECT_TRUE(std::ranges::equal(many.view().entry_offsets, one.view().entry_offsets));
        EXPECT_TRUE(std::ranges::equal(many.view().entries_float32, one.view().entries_float32));
        EXPECT_EQ(many.source_hash(), one.source_hash());
    }
}

TEST(DistanceMapBuild, StoresUnorm16EntriesWithinTheStatedError) {
    const TriangleMesh mesh = make_torus(1, 0.4, 60, 24);
    const DistanceMap exact = DistanceMap::build(mesh);
    const DistanceMap small = DistanceMap::build(mesh, {.entry_format = EntryFormat::Unorm16});
    const DistanceMapView& view = small;
    ASSERT_EQ(view.entries_unorm16.size(), exact.view().entry_count());
    EXPECT_TRUE(view.entries_float32.empty());
    for (std::size_t i = 0; i < view.entries_unorm16.size(); ++i)
        ASSERT_NEAR(static_cast<float>(view.entries_unorm16[i]) / 65535 * view.radius,
                    exact.view().entries_float32[i], view.radius / 131070 * 1.01F);
    EXPECT_EQ(view.byte_count(), exact.view().byte_count() - 2 * view.entries_unorm16.size());
}

TEST(DistanceMapBuild, ReportsTheShareOfDirectionsThatLookThroughAHole) {
    TriangleMesh open = make_sphere(1, 40, 20);
    std::erase_if(open.faces, [&](const Triangle& face) {
        return open.vertices[face[0]].z + open.vertices[face[1]].z + open.vertices[face[2]].z > 2.4F;
    });
    const DistanceMap map = DistanceMap::build(open);
    EXPECT_TRUE(map.view().centre_inside);
    const auto histogram = entry_histogram(map);
    EXPECT_FLOAT_EQ(map.statistics().wrong_parity_share, static_cast<float>(histogram[0]) / 40'000);
    EXPECT_GT(map.statistics().wrong_parity_share, 0.01F);
    EXPECT_EQ(DistanceMap::build(make_sphere(1, 40, 20)).statistics().wrong_parity_share, 0);
}

TEST(DistanceMapBuild, IdentifiesItsSource) {
    const TriangleMesh mesh = make_box({1, 1, 1});
    const auto hash = [&](const DistanceMapOptions& options) {
        return DistanceMap::build(mesh, options).source_hash();
    };
    EXPECT_EQ(hash({}), hash({.thread_count = 1}));
    EXPECT_NE(hash({}), hash({.pole_axis = PoleAxis::X}));
    EXPECT_NE(hash({}), hash({.correction = VertexCorrection::None}));
    EXPECT_NE(hash({}), DistanceMap::build(make_box({1, 1, 2})).source_hash());
}

TEST(DistanceMapBuild, RefusesBadOptionsAndBadMeshes) {
    const TriangleMesh box = make_box({1, 1, 1});
    expect_refused(ErrorCode::InvalidOptions, box, {.longitude_count = 3});
    expect_refused(ErrorCode::InvalidOptions, box, {.colatitude_count = 8193});
    expect_refused(ErrorCode::InvalidMesh, {});
    TriangleMesh broken = box;
    broken.vertices[2].y = std::numeric_limits<float>::quiet_NaN();
    expect_refused(ErrorCode::InvalidMesh, broken);
    broken = box;
    broken.faces[5][1] = 1000;
    expect_refused(ErrorCode::InvalidMesh, broken);
    expect_refused(ErrorCode::InvalidMesh, {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}});
}

TEST(DistanceMapBuild, AcceptsOneFaceHugeAndTinyCoordinatesAndNeedles) {
    const TriangleMesh one_face{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const DistanceMap flat = DistanceMap::build(one_face);
    EXPECT_FALSE(flat.view().centre_inside);
    for (double size : {1e9, 1e-9}) {
        const DistanceMap map = DistanceMap::build(make_box({size, size, size}));
        EXPECT_TRUE(contains(map, Vec3f(Vec3d{0.49, 0.49, 0.49} * size)));
        EXPECT_FALSE(contains(map, Vec3f(Vec3d{0.51, 0.4, 0.4} * size)));
    }
    const DistanceMap needle = DistanceMap::build(make_box({1, 1e-6, 1e-6}));
    EXPECT_TRUE(needle.view().centre_inside);
    EXPECT_EQ(needle.statistics().wrong_parity_share, 0);
}

namespace {

/// Searches all faces one by one.
VertexLayer layer_by_brute_force(const LatticeMesh& lattice, std::uint32_t vertex, Facing facing) {
    VertexLayer layer{.facing = facing};
    const LatticePoint& d = lattice.vertices[vertex];
    for (const Triangle& face : lattice.faces) {
        const FaceCone cone(lattice.vertices[face[0]], lattice.vertices[face[1]], lattice.vertices[face[2]]);
        if (cone.edge_on() || !cone.meets(d)) continue;
        ++layer.crossing_count;
        const bool is_corner = std::count(face.begin(), face.end(), vertex) > 0;
        layer.crossings_before += !is_corner && cone.parameter(d) < 1 ? 1 : 0;
    }
    return layer;
}

} // namespace

TEST(VertexLayers, AreThoseOfASearchThroughAllFacesWhateverTheGrid) {
    TriangleMesh torus = make_torus(1, 0.4, 21, 13);
    for (Vec3f& vertex : torus.vertices) vertex = {vertex.z + 0.1F * vertex.x, vertex.x, vertex.y};
    const LatticeMesh lattice = snap_to_lattice(torus);
    for (const auto& [columns, rows] : {std::pair{200U, 200U}, {31U, 7U}, {4U, 4U}})
        for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
            const std::vector<VertexLayer> layers =
                layers_of_vertices(lattice, SphericalGrid(columns, rows, axis));
            for (std::uint32_t i = 0; i < layers.size(); ++i) {
                const VertexLayer expected = layer_by_brute_force(lattice, i, layers[i].facing);
                ASSERT_EQ(layers[i].crossing_count, expected.crossing_count) << "vertex " << i;
                ASSERT_EQ(layers[i].crossings_before, expected.crossings_before) << "vertex " << i;
            }
        }
}

TEST(VertexLayers, NumberTheSidesOfNestedBoxesFromTheCentre) {
    TriangleMesh nested;
    for (float size : {1.0F, 2.0F, 3.0F}) {
        const auto offset = static_cast<std::uint32_t>(nested.vertices.size());
        const TriangleMesh box = make_box({size, size, size});
        for (const Vec3f& vertex : box.vertices) nested.vertices.push_back(vertex);
        for (const Triangle& face : box.faces)
            nested.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
    }
    const std::vector<VertexLayer> layers =
        layers_of_vertices(snap_to_lattice(nested), SphericalGrid(20, 20, PoleAxis::Z));
    for (std::size_t i = 0; i < layers.size(); ++i) {
        EXPECT_EQ(layers[i].facing, Facing::Outward);
        EXPECT_EQ(layers[i].crossings_before, i / 8);
        EXPECT_EQ(layers[i].crossing_count, 3U);
    }
}

TEST(VertexLayers, DistinguishTheTwoSidesOfATorusFromItsSilhouette) {
    const std::vector<VertexLayer> layers =
        layers_of_vertices(snap_to_lattice(make_torus(1, 0.4, 40, 20)), SphericalGrid(50, 50, PoleAxis::Z));
    const auto count = [&](Facing facing) {
        return std::count_if(layers.begin(), layers.end(),
                             [&](const VertexLayer& layer) { return layer.facing == facing; });
    };
    EXPECT_EQ(count(Facing::None), 0);
    EXPECT_EQ(count(Facing::Both), 2 * 40); // a ring above and one below
    for (const VertexLayer& layer : layers) {
        if (layer.facing == Facing::Inward) EXPECT_EQ(layer.crossings_before, 0U);
        if (layer.facing == Facing::Outward) EXPECT_EQ(layer.crossings_before, 1U);
    }
}

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
