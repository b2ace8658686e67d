// The native side of tests/wasm/speed.mjs: writes a model and its particles, then runs the task that each
// line of its input names once and answers with its processor time.

#include "support/point_sets.hpp"

#include <echinus/instruction_set.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus_scene/scene.hpp>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kParticleCount = 100'000;

template <typename T>
void write(const fs::path& path, const std::vector<T>& values) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(T)));
}

double processor_seconds(const std::function<void()>& work) {
    const auto now = [] {
        timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
    };
    const double start = now();
    work();
    return now() - start;
}

/// The tasks; a simulation continues from one line to the next.
class Tasks {
  public:
    Tasks(const fs::path& scene_path, const fs::path& model)
        : scene_(read_scene(scene_path)),
          mesh_(repair(read_mesh(model), scene_.colliders.front().repair).mesh),
          maps_{{"exact", build_map(mesh_, ExactMapOptions{}, 1)},
                {"distance", build_map(mesh_, DistanceMapOptions{}, 1)}},
          points_{{"U", test::uniform_points(mesh_, kParticleCount)},
                  {"S", test::surface_points(mesh_, kParticleCount)}} {}

    void write_inputs(const fs::path& folder) const {
        fs::create_directories(folder);
        write(folder / "vertices", mesh_.vertices);
        write(folder / "faces", mesh_.faces);
        for (const auto& [name, points] : points_) write(folder / ("particles_" + name), points);
    }

    double run(const std::string& set, const std::string& task, const std::string& kind,
               const std::string& particles) {
        use_instruction_set(set);
        const AnyMap& map = maps_.at(kind);
        if (task == "build") return processor_seconds([&] { build_map(mesh_, map_options(kind), 1); });
        if (task == "simulation") return processor_seconds([&] { simulation(set, map).step(); });
        const std::vector<Vec3f>& points = points_.at(particles);
        if (task == "contains") return processor_seconds([&] { contains_batch(map, points, inside_); });
        return processor_seconds([&] { contacts_batch(map, points, 0, contacts_); });
    }

  private:
    static MapOptions map_options(const std::string& kind) {
        if (kind == "exact") return ExactMapOptions{};
        return DistanceMapOptions{};
    }
    Simulation& simulation(const std::string& set, const AnyMap& map) {
        const auto found = simulations_.find(set);
        if (found != simulations_.end()) return found->second;
        return simulations_.emplace(set, make_simulation(scene_, map)).first->second;
    }

    Scene scene_;
    TriangleMesh mesh_;
    std::map<std::string, AnyMap> maps_;
    std::map<std::string, std::vector<Vec3f>> points_;
    std::map<std::string, Simulation> simulations_; // by instruction set
    std::vector<std::uint8_t> inside_ = std::vector<std::uint8_t>(kParticleCount);
    std::vector<Contact> contacts_ = std::vector<Contact>(kParticleCount);
};

} // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::cerr << "usage: echinus-wasm-speed SCENE MODEL FOLDER\n";
        return 2;
    }
    try {
        Tasks tasks(argv[1], argv[2]);
        tasks.write_inputs(argv[3]);
        std::cout << "ready" << std::endl;
        for (std::string line; std::getline(std::cin, line);) {
            std::string set, task, kind, particles;
            std::istringstream(line) >> set >> task >> kind >> particles;
            std::cout << tasks.run(set, task, kind, particles) << std::endl;
        }
    } catch (const std::exception& error) {
        std::cerr << "echinus-wasm-speed: " << error.what() << '\n';
        return 1;
    }
}
