#include "directions/face_cone.hpp"
#include "distance_map/build/vertex_correction.hpp"

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
