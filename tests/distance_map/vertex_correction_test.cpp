#include "directions/face_cone.hpp"
#include "distance_map/build/vertex_correction.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>

using namespace echinus;

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
