#include "engine.hpp"

#include <echinus/simulation.hpp>
#include <echinus/version.h>

#include <fmt/format.h>

#include <cmath>

using namespace echinus;

namespace {

class EchinusEngine : public Engine {
  public:
    EchinusEngine(const Task& task, bool surfaces) : simulation_(make(task, surfaces)) {}

    std::string name() const override { return "Echinus"; }
    std::string version() const override { return ECHINUS_VERSION_STRING; }
    std::string configuration() const override {
        return simulation_.options().surface_collision ? "surfaces" : "particles only";
    }
    unsigned substeps() const override {
        return static_cast<unsigned>(std::lround(kFrameSeconds / simulation_.options().time_step));
    }
    std::map<std::string, std::string> settings() const override {
        const SimulationOptions& options = simulation_.options();
        return {{"solver", "Verlet"},
                {"time step", fmt::format("1/{:.0f} s", 1 / options.time_step)},
                {"iterations", fmt::format("{}", options.iteration_count)},
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
        options.surface_collision = options.self_collision = surfaces;
        if (task.is_matched) {
            options.time_step = kFrameSeconds;
            options.iteration_count = kMatchedIterations;
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
