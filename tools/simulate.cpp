#include "command.hpp"
#include "input_file.hpp"
#include "output.hpp"
#include "output_folder.hpp"
#include "point_cache.hpp"
#include "progress.hpp"
#include "scene_model.hpp"
#include "simulation_result.hpp"

#include <echinus/mesh_io.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <optional>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

constexpr const char* kCacheName = "cloth.pc2";
constexpr const char* kFramesName = "frames";

struct SimulateArguments {
    fs::path scene;
    fs::path target;
    std::vector<fs::path> model_folders;
    std::optional<std::uint32_t> frame_limit;
    std::uint32_t frames_per_sample = 1;
    unsigned thread_count = 0;
    bool obj = false;
    bool json = false;
};

/// The positions of the cloth in every saved frame: one point cache, or one OBJ for each.
class Samples {
  public:
    Samples(const OutputFolder& folder, const Deformable& cloth, const SimulateArguments& arguments)
        : frames_(folder.path_of(kFramesName)) {
        if (arguments.obj) {
            fs::create_directory(frames_);
        } else {
            cache_.emplace(folder.path_of(kCacheName), cloth.particle_count(), arguments.frames_per_sample);
        }
    }

    void add(const Simulation& simulation) {
        if (cache_) return cache_->add(simulation.positions());
        const Deformable& cloth = simulation.deformable();
        write_mesh(frames_ / fmt::format("cloth_{:06}.obj", simulation.frame()),
                   {cloth.positions, cloth.faces});
    }
    void commit() {
        if (cache_) cache_->commit();
    }

  private:
    fs::path frames_;
    std::optional<PointCacheWriter> cache_;
};

/// Steps until the cloth rests or the frame limit is reached, saving every so many frames; stops only after a
/// frame that was saved, so that the last sample is the end.
std::vector<SavedPose> run(Simulation& simulation, Samples& samples, std::uint32_t frame_limit,
                           std::uint32_t frames_per_sample) {
    ProgressBar progress("simulating");
    const Collider& collider = simulation.colliders().front();
    std::vector<SavedPose> poses{{0, collider.pose}};
    samples.add(simulation);
    while (simulation.frame() < frame_limit && !simulation.at_rest()) {
        for (std::uint32_t i = 0; i < frames_per_sample; ++i) simulation.step();
        samples.add(simulation);
        if (collider.moves()) poses.push_back({simulation.frame(), collider.pose});
        progress(static_cast<double>(simulation.frame()) / frame_limit);
    }
    return poses;
}

void write_report(const fs::path& path, const nlohmann::ordered_json& report) {
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    write_file(path, report.dump(2, ' ', false, kReplace) + "\n");
}

/// What is wrong with the options of a scene's map is wrong with the scene.
AnyMap map_of_scene(const Scene& scene, const TriangleMesh& mesh, const SimulateArguments& arguments) {
    try {
        return build_map(mesh, scene.map, arguments.thread_count);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::InvalidOptions) throw;
        throw Error(ErrorCode::InvalidScene, arguments.scene.string() + ": \"map\": " + error.what());
    }
}

void simulate(const SimulateArguments& arguments) {
    Scene scene = read_scene(arguments.scene);
    if (arguments.frame_limit) scene.frame_limit = *arguments.frame_limit;
    OutputFolder folder(arguments.target);
    const RepairedMesh model = load_model(scene, arguments.scene, arguments.model_folders);
    Simulation simulation = make_simulation(scene, map_of_scene(scene, model.mesh, arguments));
    const Deformable& cloth = simulation.deformable();
    write_mesh(folder.path_of("cloth.obj"), {cloth.positions, cloth.faces});
    write_mesh(folder.path_of("collider.obj"), scaled(model.mesh, scene.scale));

    Samples samples(folder, cloth, arguments);
    std::vector<SavedPose> poses = naming_file(arguments.scene.string(), ErrorCode::Diverged, [&] {
        return run(simulation, samples, scene.frame_limit, arguments.frames_per_sample);
    });
    samples.commit();

    const Collider& collider = simulation.colliders().front();
    const std::string scene_name = arguments.scene.string();
    const MeshReport model_report = inspect(model.mesh);
    const SimulationResult result{
        .scene_name = scene_name,
        .simulation = simulation,
        .model = model_report,
        .collider_radius = inspect(scaled(model.mesh, scene.scale)).bounding_sphere.radius,
        .verdict = judge(simulation.positions(), model.mesh, collider, arguments.thread_count),
        .poses = std::move(poses)};
    const nlohmann::ordered_json report = to_json(result);
    write_report(folder.path_of("report.json"), report);
    folder.commit();
    folder.remove_old(arguments.obj ? kCacheName : kFramesName);
    if (arguments.json) {
        print_json(report);
    } else {
        print(to_text(result));
    }
}

void add_options(CLI::App& command, SimulateArguments& arguments) {
    command.add_option("SCENE", arguments.scene, "Scene file (docs/scenes.md)")->required()->type_name("");
    command
        .add_option("-o,--output", arguments.target,
                    "Folder for cloth.obj, cloth.pc2, collider.obj and report.json")
        ->required()
        ->type_name("DIR");
    command
        .add_option(
            "--models", arguments.model_folders,
            "Folder to look for the scene's model in, before the scene's own, ../models beside it and models")
        ->type_name("DIR");
    command.add_option("--frames", arguments.frame_limit, "Frame limit in place of the scene's")
        ->check(CLI::Range(1U, 1'000'000'000U))
        ->type_name("COUNT");
    command.add_option("--every", arguments.frames_per_sample, "Save every so many frames")
        ->check(CLI::Range(1U, 1'000'000U))
        ->type_name("COUNT")
        ->capture_default_str();
    command
        .add_option("--threads", arguments.thread_count,
                    "Threads to build the map and judge the end on; 0: all cores. The simulation runs on one")
        ->check(CLI::Range(0U, 1024U))
        ->type_name("COUNT")
        ->capture_default_str();
    command.add_flag("--obj", arguments.obj, "Write frames/cloth_NUMBER.obj in place of cloth.pc2");
    command.add_flag("--json", arguments.json, "Print the report as one JSON object");
}

} // namespace

void add_simulate_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("simulate", "Let a cloth fall on a model, until it rests");
    const auto arguments = std::make_shared<SimulateArguments>();
    add_options(*command, *arguments);
    command->footer("Example:\n  echinus simulate scenes/horse.json -o out/horse");
    command->callback([arguments] { simulate(*arguments); });
}
