// Exact maps are right at every tested point of small nasty meshes. echinus-check tests millions, of large
// meshes too; docs/accuracy.md has its results.

#include "judges/nasty_meshes.hpp"
#include "oracle/expect_right_map.hpp"
#include "oracle/test_meshes.hpp"
#include "support/crowded_meshes.hpp"

using namespace echinus;

TEST(ExactMapOracle, IsRightAboutNastyMeshes) {
    for (const std::string& name : test::nasty_mesh_names())
        if (name != "million" && name != "rings") // too slow for a test
            test::expect_right_map(name, test::make_nasty_mesh(name), {}, 20'000);
}

TEST(ExactMapOracle, IsRightWhereTheDefaultIsLimited) {
    for (const auto& [name, mesh] : test::crowded_meshes())
        if (name != "triangles") // which are open
            test::expect_right_map(name, mesh, {}, 4'000);
}

TEST(ExactMapOracle, KeepsWithinTheDefaultLimitOnNastyMeshes) {
    for (const std::string& name : test::nasty_mesh_names()) {
        if (name == "million") continue;
        const TriangleMesh mesh = test::make_nasty_mesh(name);
        const ExactMap map = ExactMap::build(mesh);
        EXPECT_LE(map.view().byte_count(), 512 * mesh.faces.size() + 65'536) << name;
    }
}

TEST(ExactMapOracle, IsRightAtEveryResolution) {
    for (const std::uint32_t divisions : {1U, 2U, 7U, 64U})
        for (const auto& [name, mesh] : test::generated_meshes())
            test::expect_right_map(name, mesh, {.divisions = divisions}, 4'000);
}

TEST(ExactMapOracle, IsRightFromASearchedCentre) {
    for (const auto& [name, mesh] : test::generated_meshes())
        test::expect_right_map(name, mesh, {.centre = CentreChoice::Search}, 4'000);
}

TEST(ExactMapOracle, IsRightFarFromTheOriginAndInAnyUnit) {
    for (const float scale : {1e-6F, 1.0F, 1e6F}) {
        TriangleMesh mesh = test::translated(test::turned(make_torus(1, 0.4, 40, 16)), {3, -50, 80});
        for (Vec3f& vertex : mesh.vertices) vertex *= scale;
        test::expect_right_map("moved torus", mesh, {}, 4'000);
    }
}
