#include "measurements.hpp"
#include "rivals/compare/clock.hpp"
#include "rivals/compare/turns.hpp"

#include <echinus/mesh_io.hpp>
#include <echinus/scene.hpp>

#include <fmt/format.h>

using namespace echinus;
using namespace echinus::comparison;

namespace {

/// The scene of the cloth that falls on the horse, with `side` particles along each edge.
Simulation simulation_of(const Setting& setting, const MapOptions& map_options, std::uint32_t side) {
    Scene scene = read_scene(setting.scenes / "horse.json");
    scene.map = map_options;
    scene.cloth.column_count = scene.cloth.row_count = side;
    const TriangleMesh mesh = repair(read_mesh(setting.debian_horse), scene.repair).mesh;
    return make_simulation(scene, build_map(mesh, scene.map));
}

struct Kind {
    const char* name;
    MapOptions options;
};

void measure(const Setting& setting, const Kind& kind, std::uint32_t side, Records& records) {
    constexpr int kFalling = 180, kTimed = 40; // frames; the cloth lies on the horse's back after the first
    Simulation simulation = simulation_of(setting, kind.options, side);
    std::vector<double> frames;
    SimulationProfile before;
    for (int frame = 0; frame < kFalling + kTimed; ++frame) {
        if (frame == kFalling) before = simulation.profile();
        const double start = thread_seconds();
        simulation.step();
        if (frame >= kFalling) frames.push_back(thread_seconds() - start);
        setting.report_progress(fmt::format("cloth {} {} particles", kind.name, side * side),
                                static_cast<double>(frame + 1) / (kFalling + kTimed));
    }
    const SimulationProfile& after = simulation.profile();
    const auto per_frame = [](double seconds) { return fmt::format("{:.4g}", 1e3 * seconds / kTimed); };
    const double ms = 1e3 * median_of(frames);
    records.add({{"map", kind.name},
                 {"particles", fmt::format("{}", simulation.deformable().particle_count())},
                 {"iterations", fmt::format("{}", simulation.options().iteration_count)},
                 {"ms", fmt::format("{:.4g}", ms)},
                 {"frames_per_second", fmt::format("{:.4g}", 1e3 / ms)},
                 {"constraints_ms", per_frame(after.constraint_seconds - before.constraint_seconds)},
                 {"collision_ms", per_frame(after.collision_seconds - before.collision_seconds)},
                 {"contacts", fmt::format("{}", (after.contact_count - before.contact_count) / kTimed)},
                 {"lost", fmt::format("{}", after.lost_count)}});
}

} // namespace

Records measure_cloth(const Setting& setting) {
    Records records({"map", "particles", "iterations", "ms", "frames_per_second", "constraints_ms",
                     "collision_ms", "contacts", "lost"});
    for (const std::uint32_t side : {100U, 316U})
        for (const Kind& kind : {Kind{"exact", ExactMapOptions{}}, Kind{"distance", DistanceMapOptions{}}})
            measure(setting, kind, side, records);
    return records;
}
