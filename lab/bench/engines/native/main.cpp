// The runner of the engines in C++: lab/bench/engines/runners.py has the contract.

#include "compare/turns.hpp"
#include "console/machine.hpp"
#include "engine.hpp"
#include "files/atomic_file.hpp"
#include "mesh_io/point_cache.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/simulation.hpp>
#include <echinus/version.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

constexpr int kMissing = 77;

struct Arguments {
    fs::path model, cloth, target;
    std::string setup, engine;
    std::uint32_t frame_count = 0;
    bool with_echinus = false;
};

std::unique_ptr<Engine> make_engine(const Arguments& arguments) {
    const Task task{.model = read_mesh(arguments.model),
                    .cloth = read_mesh(arguments.cloth),
                    .is_matched = arguments.setup == "matched",
                    .with_echinus = arguments.with_echinus};
    if (arguments.engine != "bullet") return make_echinus(task, arguments.engine == "surfaces");
#ifdef ECHINUS_BENCH_BULLET
    return make_bullet(task);
#else
    return nullptr;
#endif
}

int run(const Arguments& arguments) {
    const std::unique_ptr<Engine> engine = make_engine(arguments);
    if (engine == nullptr) {
        fmt::print(stderr, "Bullet was not found when this was built (Debian: libbullet-dev)\n");
        return kMissing;
    }
    PointCacheWriter cache(arguments.target / "cloth.pc2", engine->positions().size(), 1);
    cache.add(engine->positions());
    std::vector<double> seconds;
    for (std::uint32_t frame = 0; frame < arguments.frame_count; ++frame) {
        const double start = comparison::process_seconds();
        engine->run_frame();
        seconds.push_back(comparison::process_seconds() - start);
        cache.add(engine->positions());
    }
    cache.commit();
    const nlohmann::json report{{"engine", engine->name()},
                                {"version", engine->version()},
                                {"configuration", engine->configuration()},
                                {"platform", "native"},
                                {"substeps", engine->substeps()},
                                {"settings", engine->settings()},
                                {"frame_seconds", seconds}};
    write_file(arguments.target / "run.json", report.dump(1) + "\n");
    return 0;
}

} // namespace

int main(int argument_count, char** argument_values) {
    CLI::App app{"Lets a cloth fall on a model in an engine"};
    Arguments arguments;
    app.set_version_flag("--machine", describe_machine());
    app.add_option("--engine", arguments.engine)
        ->required()
        ->check(CLI::IsMember({"bullet", "particles", "surfaces"}));
    app.add_option("--model", arguments.model)->required();
    app.add_option("--cloth", arguments.cloth)->required();
    app.add_option("--setup", arguments.setup)->required()->check(CLI::IsMember({"recommended", "matched"}));
    app.add_option("--frames", arguments.frame_count)->required();
    app.add_option("--out", arguments.target)->required();
    app.add_flag("--echinus", arguments.with_echinus, "The engine's collider is an exact map");
    CLI11_PARSE(app, argument_count, argument_values);
    try {
        return run(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}

namespace {

class EchinusEngine : public Engine {
  public:
    EchinusEngine(const Task& task, bool surfaces) : simulation_(make(task, surfaces)) {}

    std::string name() const override { return "Echinus"; }
    std::string version() const override { return ECHINUS_VERSION_STRING; }
    std::string configuration() const override {
        return simulation_.options().surfaces_collide() ? "surfaces" : "particles only";
    }
    unsigned substeps() const override {
        return static_cast<unsigned>(std::lround(kFrameSeconds / simulation_.options().time_step));
    }
    std::map<std::string, std::string> settings() const override {
        const SimulationOptions& options = simulation_.options();
        const auto* newton = std::get_if<NewtonOptions>(&options.solver);
        return {{"solver", newton != nullptr ? "newton" : "jakobsen"},
                {"time step", fmt::format("1/{:.0f} s", 1 / options.time_step)},
                {"iterations", fmt::format("{}", newton != nullptr ? newton->step_count
                                                                   : options.jakobsen().iteration_count)},
                {"thickness", fmt::format("{:.4g} R", options.thickness.value())},
                {"friction", fmt::format("{}", options.friction)}};
    }
    void run_frame() override {
        for (unsigned i = 0; i < substeps(); ++i) simulation_.step();
    }
    std::vector<Vec3f> positions() const override {
        return {simulation_.positions().begin(), simulation_.positions().end()};
    }

  private:
    static Simulation make(const Task& task, bool surfaces) {
        SimulationOptions options;
        options.gravity = {0, -kGravity, 0};
        options.friction = kFriction;
        if (!surfaces) {
            options.solver = JakobsenOptions{};
            options.time_step = 1.0 / 240;
        }
        if (task.is_matched) {
            options.time_step = kFrameSeconds;
            if (!surfaces) options.jakobsen().iteration_count = kMatchedIterations;
            options.thickness = kMatchedThickness;
        }
        return {make_cloth(task.cloth, MeshClothOptions{}),
                {Collider{.map = ExactMap::build(task.model)}},
                options};
    }

    Simulation simulation_;
};

} // namespace

std::unique_ptr<Engine> make_echinus(const Task& task, bool surfaces) {
    return std::make_unique<EchinusEngine>(task, surfaces);
}
