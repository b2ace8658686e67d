// Scenes with soft bodies.

#include "support/expectations.hpp"

#include <echinus_scene/scene.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace echinus;

namespace {

Scene scene_with(const std::string& keys) {
    return parse_scene(R"({"model": {"box": {}}, )" + keys + "}", "a.json");
}

void expect_refusal(const std::string& words, const std::string& keys) {
    test::expect_error(ErrorCode::InvalidScene, words, [&] { scene_with(keys); });
}

double mass_of(const Deformable& deformable, std::size_t first, std::size_t count) {
    double mass = 0;
    for (std::size_t i = first; i < first + count; ++i) mass += 1 / double{deformable.inverse_masses[i]};
    return mass;
}

} // namespace

TEST(SceneBodies, AreMadeOfWhatTheirKeysSayAndNeedNoCloth) {
    const Scene scene = scene_with(R"("bodies": [{"mesh": {"box": {"size": [1, 2, 3]}}, "element": 0.5,
        "density": 900, "young_modulus": 2e4, "poisson_ratio": 0.25, "damping": 0.1, "scale": 0.5,
        "position": [0, 0, 2], "velocity": [0, 0, -1], "pins": {"from": [-9, -9, 1.5], "to": [9, 9, 1.5]}}])");
    EXPECT_FALSE(scene.has_cloth);
    EXPECT_EQ(scene.simulation.solver, SolverKind::Xpbd);
    EXPECT_EQ(scene.simulation.substep_count, 10u);
    const Deformable body = make_deformable(scene);
    ASSERT_EQ(body.particle_count(), 3u * 5 * 7);
    EXPECT_EQ(body.positions[0], Vec3f(-0.25F, -0.5F, 1.25F));
    EXPECT_EQ(body.inverse_masses.back(), 0);
    const ElasticTetrahedron& tetrahedron = body.tetrahedra.front();
    EXPECT_FLOAT_EQ(tetrahedron.mu, 8000);
    EXPECT_FLOAT_EQ(tetrahedron.lambda, 8000);
    EXPECT_FLOAT_EQ(tetrahedron.damping, 0.1F);
    EXPECT_NEAR(mass_of(body, 0, 3 * 5 * 6), 900 * 0.75 * 11 / 12, 0.1);
    EXPECT_NEAR(body.positions[0].z - body.previous_positions[0].z, -1.0 / 2400, 1e-6);
    EXPECT_EQ(body.positions.back(), body.previous_positions.back());
}

TEST(SceneBodies, FillGeneratedShapes) {
    const Deformable body = make_deformable(
        scene_with(R"("bodies": [{"mesh": {"sphere": {"radius": 0.5}}, "element": 0.2, "density": 1}])"));
    EXPECT_NEAR(mass_of(body, 0, body.particle_count()), 4 * 3.14159 / 3 / 8, 0.05);
}

TEST(SceneBodies, FillNoSurfaceThatIsOpen) {
    const SceneBody body = scene_with(R"("bodies": [{"mesh": "ball.off", "element": 0.3}])").bodies[0];
    TriangleMesh ball = make_sphere(1, 20, 10);
    EXPECT_FALSE(fill_body(body, ball).tetrahedra.empty());
    ball.faces.pop_back();
    test::expect_error(ErrorCode::InvalidMesh, "is not closed", [&] { fill_body(body, ball); });
}

TEST(SceneBodies, FollowTheClothWhoseDensityIsThenGiven) {
    const Scene scene = scene_with(R"("cloth": {"size": [2, 1], "particles": [4, 3], "density": 0.2},
        "bodies": [{"mesh": "ball.off", "element": 1, "position": [0, 0, 3]}, {"mesh": {"box": {}}, "element": 1}])");
    const TetrahedralMesh ball = make_solid_box({1, 1, 1}, {1, 1, 1});
    const Deformable all = make_deformable(scene, {.mesh = {}, .rest_mesh = {}, .bodies = {ball, {}}});
    ASSERT_EQ(all.particle_count(), 12u + 8 + 8);
    EXPECT_NEAR(mass_of(all, 0, 12), 0.4, 1e-6);
    EXPECT_NEAR(mass_of(all, 12, 8), 1000, 1e-3);
    EXPECT_EQ(all.positions[12], Vec3f(-0.5F, -0.5F, 2.5F));
}

TEST(SceneBodies, AndTheClothPassThroughTheCollidersThatTheyIgnore) {
    const std::string colliders = R"("colliders": [{"model": {"box": {}}}, {"model": {"sphere": {}}}])";
    const auto scene = [&](const std::string& of_cloth, const std::string& of_body) {
        return parse_scene("{" + colliders +
                               R"(, "cloth": {"size": [2, 1], "particles": [4, 3], "density": 1)" + of_cloth +
                               R"(}, "bodies": [{"mesh": {"box": {}}, "element": 1)" + of_body + "}]}",
                           "a.json");
    };
    const auto count = [](const std::vector<std::uint8_t>& passes) {
        return std::count(passes.begin(), passes.end(), std::uint8_t{1});
    };
    const Deformable all = make_deformable(scene(R"(, "ignores": [1])", R"(, "ignores": [0, 1])"));
    EXPECT_EQ(count(let_through(all, 0)), 8);
    EXPECT_EQ(count(let_through(all, 1)), 12 + 8);
    EXPECT_TRUE(let_through(make_deformable(scene("", "")), 0).empty());
    for (const char* words : {R"(, "ignores": [2])", R"(, "ignores": [-1])", R"(, "ignores": 0)"}) {
        test::expect_error(ErrorCode::InvalidScene, "cloth.ignores", [&] { scene(words, ""); });
        test::expect_error(ErrorCode::InvalidScene, "bodies[0].ignores", [&] { scene("", words); });
    }
}

TEST(SceneBodies, AreTakenAsTheyAreFromFilesOfTetrahedra) {
    for (const std::string name : {"ball.msh", "ball.VTK", "ball.node", "ball.Ele"}) {
        const Scene scene = scene_with(R"("bodies": [{"mesh": ")" + name + R"("}])");
        EXPECT_EQ(scene.bodies[0].element, 0);
        const Deformable body = make_deformable(
            scene, {.mesh = {}, .rest_mesh = {}, .bodies = {make_solid_box({1, 1, 1}, {1, 1, 1})}});
        EXPECT_EQ(body.particle_count(), 8u);
        expect_refusal("bodies[0].element is 1; it must be left out where the mesh is a file of tetrahedra",
                       R"("bodies": [{"mesh": ")" + name + R"(", "element": 1}])");
    }
    test::expect_error(ErrorCode::InvalidOptions, "bodies[0]: its mesh is the file ball.msh: read it",
                       [] { make_deformable(scene_with(R"("bodies": [{"mesh": "ball.msh"}])")); });
}

TEST(SceneBodies, ThatAreImpossibleAreRefused) {
    expect_refusal("the key bodies[0].mesh is missing", R"("bodies": [{}])");
    expect_refusal("bodies is", R"("bodies": [])");
    expect_refusal("the key bodies[1].element is missing",
                   R"("bodies": [{"mesh": "a.off", "element": 1}, {"mesh": {"torus": {}}}])");
    expect_refusal("bodies[0].poisson_ratio is 0.5",
                   R"("bodies": [{"mesh": "a.off", "element": 1, "poisson_ratio": 0.5}])");
    expect_refusal("the nearest is \"bodies[0].young_modulus\"",
                   R"("bodies": [{"mesh": "a.off", "element": 1, "young_modulu": 1}])");
    expect_refusal("the key cloth.density is missing",
                   R"("cloth": {"size": [1, 1]}, "bodies": [{"mesh": "a.off", "element": 1}])");
    expect_refusal("\"xpbd\" or left out",
                   R"("solver": "verlet", "bodies": [{"mesh": "a.off", "element": 1}])");
    expect_refusal("material.thickness", R"("cloth": {"size": [1, 1]}, "material": {"thickness": 1})");
    test::expect_error(ErrorCode::InvalidOptions, "bodies[0]: its mesh is the file a.off: read it",
                       [] { make_deformable(scene_with(R"("bodies": [{"mesh": "a.off", "element": 1}])")); });
}
