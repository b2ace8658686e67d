// The scenes that ship, each from ten starts that differ a little: no face meets another in any of them.
// scripts/test falls runs this program, which takes minutes.

#include "commands/scene_model.hpp"
#include "commands/verdict.hpp"

#include <echinus/simulation.hpp>
#include <echinus_scene/scene.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <ostream>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace echinus::test {
namespace {

struct Fall {
    const char* scene;
    std::uint32_t side; ///< particles of a sheet's side; 0: as the scene has it
    int frame_count;

    friend std::ostream& operator<<(std::ostream& out, const Fall& fall) { return out << fall.scene; }
};

constexpr std::uint32_t kSeeds = 10;
constexpr double kSpeed = 0.02; ///< m/s, by which particles begin differently
constexpr int kFramesPerJudgement = 3;

class Falls : public testing::TestWithParam<std::tuple<Fall, std::uint32_t>> {};

TEST_P(Falls, KeepAllFacesApartFromWhateverStart) {
    const auto& [fall, seed] = GetParam();
    const std::filesystem::path path =
        std::filesystem::path(ECHINUS_SCENES) / (fall.scene + std::string(".json"));
    Scene scene = read_scene(path);
    if (fall.side > 0) scene.cloth.column_count = scene.cloth.row_count = fall.side;
    const LoadedColliders loaded = load_colliders(scene, path, {}, 1);
    Simulation simulation = make_simulation(scene, loaded.maps, load_meshes(scene, path, {}), loaded.caches);
    std::mt19937 random(seed);
    std::normal_distribution<double> speed(0, kSpeed);
    for (std::size_t i = 0; i < simulation.positions().size(); ++i) {
        const Vec3d velocity(simulation.deformable().velocities[i]);
        simulation.set_particle_velocity(i, velocity + Vec3d{speed(random), speed(random), speed(random)});
    }
    for (int frame = 1; frame <= fall.frame_count; ++frame) {
        simulation.step();
        if (frame % kFramesPerJudgement != 0) continue;
        std::vector<TriangleMesh> models;
        for (std::size_t c = 0; c < loaded.maps.size(); ++c)
            models.push_back(loaded.mesh_at(c, simulation.frame() * simulation.options().time_step));
        const PairCounts pairs = count_pairs(simulation, models);
        ASSERT_EQ(pairs.with_models + pairs.own, 0u) << "in frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Falls,
    testing::Combine(testing::Values(Fall{"torus", 30, 120}, Fall{"horse", 30, 120},
                                     Fall{"turning_torus", 30, 120}, Fall{"bag", 0, 120},
                                     Fall{"ball_in_hammock", 0, 90}, Fall{"balls_on_cloth", 0, 90},
                                     Fall{"carried_cloth", 0, 120}, Fall{"jumping_cape", 0, 120},
                                     Fall{"inflated_cushion", 0, 90}, Fall{"flag", 0, 60},
                                     Fall{"thin_plate", 40, 60}, Fall{"stack", 0, 60},
                                     Fall{"soft_torus", 0, 90}, Fall{"soft_torus_through_ring", 0, 60},
                                     Fall{"organ_and_cloth", 0, 60}),
                     testing::Range(0U, kSeeds)),
    [](const testing::TestParamInfo<Falls::ParamType>& run) {
        return std::string(std::get<0>(run.param).scene) + "_from_start_" +
               std::to_string(std::get<1>(run.param));
    });

} // namespace
} // namespace echinus::test
