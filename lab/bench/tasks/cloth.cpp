// The task cloth: the same cloth falls on each system, and the time of a larger one's frame.

#include "cloth_run.hpp"
#include "compare/systems.hpp"
#include "compare/turns.hpp"
#include "rivals/classified_grid/classified_grid.hpp"
#include "rivals/dense_grid/dense_grid.hpp"
#include "rivals/maps/maps.hpp"
#include "task.hpp"

#include <echinus/mesh_io.hpp>

#include <fmt/format.h>

#include <algorithm>

using namespace echinus;
using namespace echinus::rivals;

namespace {

/// The paper's figures for the horse (section 2.3).
constexpr std::size_t kPaperBytes = 630'000;

/// Along a ray the surface is farther than it is; a simulation looks four times as far along those of a
/// distance map, so it does for any system that measures along rays.
constexpr float kAlongRays = 4;

/// Queries a system for contacts only.
class AskedSystem final : public CustomMap {
  public:
    AskedSystem(comparison::Built system, float margin_factor)
        : system_(std::move(system)), margin_factor_(margin_factor) {}

    void contains_batch(std::span<const Vec3f> points,
                        std::span<std::uint8_t> inside) const noexcept override {
        system_->contains_batch(points, inside);
    }
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const noexcept override {
        system_->contacts_batch(points, margin_factor_ * margin, contacts);
    }

  private:
    comparison::Built system_;
    float margin_factor_;
};

ClothSystem asked(std::string name, std::string setting, comparison::Built system, float margin_factor = 1) {
    const std::size_t bytes = system->byte_count();
    return {std::move(name), std::move(setting), bytes,
            std::make_shared<AskedSystem>(std::move(system), margin_factor)};
}

ClothSystem distance(const char* name, std::string setting, const TriangleMesh& mesh,
                     const DistanceMapOptions& options) {
    DistanceMap map = DistanceMap::build(mesh, options);
    const std::size_t bytes = map.view().byte_count();
    return {name, std::move(setting), bytes, std::move(map)};
}

/// Padded by the thickness, without which a grid has no contacts above the model's highest point.
ClothSystem dense(const char* name, const TriangleMesh& mesh, SampleFormat format, double thickness) {
    DenseGrid grid = DenseGrid::with_bytes(mesh, kPaperBytes, {.format = format, .padding = thickness});
    const std::string setting =
        fmt::format("{} x {} x {} samples", grid.node_count(0), grid.node_count(1), grid.node_count(2));
    return asked(name, setting, std::make_unique<const DenseGrid>(std::move(grid)));
}

/// A system of the list that this build may not have.
void add_if_there(std::string_view name, std::string setting, const TriangleMesh& mesh, float margin_factor,
                  std::vector<ClothSystem>& all) {
    for (const comparison::SystemType& type : comparison::all_systems()) {
        if (type.name != name || !type.available()) continue;
        const auto sizes = type.on(mesh, {.segment_count = 17}, [](std::string_view, double) {});
        all.push_back(asked(std::string(type.title), std::move(setting), sizes->within(kPaperBytes).build(),
                            margin_factor));
    }
}

ClothScene read_cloth_scene(const Setting& setting, const char* file) {
    ClothScene result{read_scene(setting.scenes / file), {}};
    result.mesh = repair(read_mesh(setting.debian_horse), result.scene.colliders.front().repair).mesh;
    return result;
}

void add_runs(const Setting& setting, const ClothScene& scene, const std::vector<ClothSystem>& systems,
              const ClothLimits& limits, Records& records) {
    const std::size_t particles = std::size_t{scene.scene.cloth.column_count} * scene.scene.cloth.row_count;
    const std::vector<ClothOutcome> outcomes = run_cloths(scene, systems, limits, [&](double fraction) {
        setting.report_progress(fmt::format("cloth of {} particles", particles), fraction);
    });
    for (std::size_t k = 0; k < systems.size(); ++k) {
        const ClothOutcome& outcome = outcomes[k];
        records.add({{"system", systems[k].name},
                     {"setting", systems[k].setting},
                     {"particles", fmt::format("{}", particles)},
                     {"bytes", fmt::format("{}", systems[k].bytes)},
                     {"frame_ms", fmt::format("{:.4g}", outcome.frame_ms)},
                     {"constraint_ms", fmt::format("{:.4g}", outcome.constraint_ms)},
                     {"collision_ms", fmt::format("{:.4g}", outcome.collision_ms)},
                     {"frames", fmt::format("{}", outcome.frames)},
                     {"rested", outcome.rested ? "yes" : "no"},
                     {"inside_at_end", fmt::format("{}", outcome.inside_at_end)},
                     {"deepest_at_end", fmt::format("{:.3g}", outcome.deepest_at_end)},
                     {"deepest", fmt::format("{:.3g}", outcome.deepest)}});
    }
}

} // namespace

std::vector<ClothSystem> cloth_systems(const TriangleMesh& mesh, double thickness) {
    ExactMap map = ExactMap::build(mesh);
    const std::size_t bytes = map.view().byte_count();
    std::vector<ClothSystem> all;
    all.push_back({"exact map", "with sweeps and memory", bytes, std::move(map)});
    all.push_back(asked("exact map contacts only", "asked like the others", exact_map(mesh)));
    DistanceMapOptions options;
    options.pole_axis = PoleAxis::Y; // the axis that is up, with which the paper's map errs least
    all.push_back(distance("distance map", "200 x 200 directions", mesh, options));
    options.grid = DirectionGrid::Octahedral;
    options.divisions = 135;
    all.push_back(distance("octahedral distance map", "135 divisions", mesh, options));
    all.push_back(dense("dense grid", mesh, SampleFormat::Float32, thickness));
    all.push_back(dense("dense grid 16 bit", mesh, SampleFormat::Snorm16, thickness));
    add_if_there("superquadric", "17 segments", mesh, kAlongRays, all);
    add_if_there("openvdb", "three voxels deep outside", mesh, 1, all);
    add_if_there("classified", "cells as the bytes allow", mesh, 1, all);
    all.back().only_timed = true; // its answers are those of the exact map, and it takes minutes
    add_if_there("embree", "parity of a ray and point query", mesh, 1, all);
    add_if_there("bullet", "first hit of a ray and contacts of a sphere", mesh, 1, all);
    return all;
}

Records measure_cloth(const Setting& setting) {
    Records records({"system", "setting", "particles", "bytes", "frame_ms", "constraint_ms", "collision_ms",
                     "frames", "rested", "inside_at_end", "deepest_at_end", "deepest"});
    ClothScene scene = read_cloth_scene(setting, "horse.json");
    if (setting.is_short) scene.scene.cloth.column_count = scene.scene.cloth.row_count = 30;
    ClothLimits limits;
    if (setting.is_short) limits = {.frame_limit = 220, .first_timed = 180, .timed_count = 40};
    add_runs(setting, scene, cloth_systems(scene.mesh, scene.scene.simulation.thickness.value()), limits,
             records);
    if (setting.is_short) return records;
    // Ten times as many particles in the same sheet, on our maps, timed only.
    scene.scene.cloth.column_count = scene.scene.cloth.row_count = 316;
    std::vector<ClothSystem> ours = cloth_systems(scene.mesh, scene.scene.simulation.thickness.value());
    std::erase_if(ours, [](const ClothSystem& system) {
        return system.name != "exact map" && system.name != "distance map";
    });
    add_runs(setting, scene, ours, {.frame_limit = 220, .first_timed = 180, .timed_count = 40}, records);
    return records;
}

namespace {

/// The maps are compared by what keeps particles out, which all of them can.
Scene of_particles(Scene scene) {
    scene.simulation.solver = JakobsenOptions{};
    scene.simulation.time_step = 1.0 / 240;
    return scene;
}

/// One cloth on its way.
class Runner {
  public:
    Runner(const ClothScene& scene, const ClothSystem& system, const ExactMap& judge,
           const ClothLimits& limits)
        : system_(system), judge_(judge), limits_(limits),
          simulation_(make_simulation(of_particles(scene.scene), system.map)) {}

    bool is_done() const {
        const std::uint32_t frame = simulation_.frame();
        return simulation_.at_rest() || frame >= limits_.frame_limit ||
               (system_.only_timed && frame >= limits_.first_timed + limits_.timed_count);
    }

    void run_frame() {
        const std::uint32_t frame = simulation_.frame();
        if (frame == limits_.first_timed) before_ = simulation_.profile();
        const double start = comparison::thread_seconds();
        simulation_.step();
        if (frame >= limits_.first_timed && frame < limits_.first_timed + limits_.timed_count) {
            timed_.push_back(comparison::thread_seconds() - start);
            after_ = simulation_.profile();
        }
        judge_places();
    }

    double progress() const {
        return is_done() ? 1 : static_cast<double>(simulation_.frame()) / limits_.frame_limit;
    }

    ClothOutcome outcome() const {
        ClothOutcome result = outcome_;
        result.frames = simulation_.frame();
        result.rested = simulation_.at_rest();
        const auto per_frame = [&](double seconds) {
            return timed_.empty() ? 0 : 1e3 * seconds / static_cast<double>(timed_.size());
        };
        result.frame_ms = 1e3 * comparison::median_of(timed_);
        result.constraint_ms = per_frame(after_.constraint_seconds - before_.constraint_seconds);
        result.collision_ms = per_frame(after_.collision_seconds - before_.collision_seconds);
        return result;
    }

  private:
    void judge_places() {
        const auto& positions = simulation_.deformable().positions;
        contacts_.resize(positions.size());
        Collider collider = simulation_.colliders().front();
        collider.map = judge_;
        contacts_batch(collider, std::span(positions), 0, contacts_);
        outcome_.inside_at_end = 0;
        outcome_.deepest_at_end = 0;
        for (const Contact& contact : contacts_) {
            if (!contact.inside) continue;
            ++outcome_.inside_at_end;
            outcome_.deepest_at_end =
                std::max(outcome_.deepest_at_end, double{contact.depth} / double{judge_.view().radius});
        }
        outcome_.deepest = std::max(outcome_.deepest, outcome_.deepest_at_end);
    }

    const ClothSystem& system_;
    const ExactMap& judge_;
    const ClothLimits& limits_;
    Simulation simulation_;
    SimulationProfile before_, after_;
    std::vector<double> timed_;
    std::vector<Contact> contacts_;
    ClothOutcome outcome_;
};

} // namespace

std::vector<ClothOutcome> run_cloths(const ClothScene& scene, const std::vector<ClothSystem>& systems,
                                     const ClothLimits& limits,
                                     const std::function<void(double)>& report_progress) {
    const ExactMap judge = ExactMap::build(scene.mesh);
    std::vector<Runner> runners;
    runners.reserve(systems.size());
    for (const ClothSystem& system : systems) runners.emplace_back(scene, system, judge, limits);
    run_in_turns(runners, report_progress);
    std::vector<ClothOutcome> outcomes;
    for (const Runner& runner : runners) outcomes.push_back(runner.outcome());
    return outcomes;
}
