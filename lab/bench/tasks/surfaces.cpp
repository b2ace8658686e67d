// The task surfaces: the same cloth with contact of its particles only, and of its faces with the model and
// with each other. Judged exactly, on published positions.

#include "cloth_run.hpp"
#include "commands/verdict.hpp"
#include "compare/turns.hpp"
#include "judges/exact_judge.hpp"
#include "task.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus_scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

using namespace echinus;

namespace {

constexpr std::uint32_t kCgalStride = 10; // of the frames that CGAL judges, too

/// A cloth and its models, ready to be simulated with one contact or another.
struct Fall {
    std::string name;
    std::vector<TriangleMesh> models{};
    std::vector<Collider> colliders{};
    Deformable cloth;
    SimulationOptions options{};
    std::uint32_t frame_limit = 0;
    bool with_particles = false; ///< once more with contact of particles only
};

struct Method {
    const char* name;
    bool of_faces; ///< with models and with each other
};

// ---- The cloths ----

// Frames of a run, and particles of a side.
constexpr std::uint32_t kLimit = 1500, kTurningLimit = 180, kPullingLimit = 120, kFallLimit = 63,
                        kFineLimit = 200;
constexpr std::uint32_t kSide = 50, kFineSide = 100;

/// A scene of the repository, with the changes that a fall makes to it. Names have no commas, which records
/// drop.
struct SceneRun {
    std::string name;
    const char* file;
    double speed = 0;                   ///< of the cloth at the start, along gravity; units per second
    double thickness = 0;               ///< share of the model's radius; 0: as the scene has it
    double turn = 0;                    ///< of the model about the axis that is up, degrees per second
    std::uint32_t side = kSide;         ///< particles of each side
    std::uint32_t frame_limit = kLimit; ///< of a model that turns, nothing comes to rest
    bool with_particles = false;
};

std::vector<SceneRun> scene_runs() {
    std::vector<SceneRun> runs{
        {.name = "horse", .file = "horse.json", .with_particles = true},
        {.name = "torus", .file = "torus.json", .with_particles = true},
    };
    for (const int speed : {10, 100})
        runs.push_back({.name = fmt::format("horse at {} units/s", speed),
                        .file = "horse.json",
                        .speed = double(speed)});
    for (const double percent : {0.3, 0.05})
        runs.push_back({.name = fmt::format("horse and thickness {} % R", percent),
                        .file = "horse.json",
                        .thickness = percent / 100});
    runs.push_back({.name = "horse and 30 x 30 particles", .file = "horse.json", .side = 30});
    for (const int turn : {360, 720})
        runs.push_back({.name = fmt::format("horse that turns by {} degrees/s", turn),
                        .file = "horse.json",
                        .turn = double(turn),
                        .frame_limit = kTurningLimit});
    for (const std::uint32_t side : {30U, 50U, 70U, kFineSide}) // pages/plots.py draws them by their name
        runs.push_back({.name = "horse the fall alone",
                        .file = "horse.json",
                        .side = side,
                        .frame_limit = kFallLimit,
                        .with_particles = true});
    runs.push_back({.name = "horse and 100 x 100 particles",
                    .file = "horse.json",
                    .side = kFineSide,
                    .frame_limit = kFineLimit});
    return runs;
}

/// A short run is about the code: few particles, and a fall that has just arrived.
constexpr std::uint32_t kShortSide = 30, kShortLimit = 40;
constexpr double kShortSpeed = 3;

Fall fall_of(const SceneRun& run, const Setting& setting) {
    Scene scene = read_scene(setting.scenes / run.file);
    TriangleMesh model;
    if (const auto* torus = std::get_if<TorusModel>(&scene.colliders.front().model))
        model = make_mesh(*torus);
    else
        model = repair(read_mesh(setting.debian_horse), scene.colliders.front().repair).mesh;
    const ExactMap map = ExactMap::build(model);
    scene.cloth.column_count = scene.cloth.row_count = run.side;
    if (run.thickness != 0) scene.simulation.thickness = run.thickness * double{map.view().radius};
    double speed = run.speed;
    if (setting.is_short) {
        scene.cloth.column_count = scene.cloth.row_count = kShortSide;
        speed = std::max(speed, kShortSpeed);
    }
    const Vec3d down = scene.simulation.gravity * (1 / length(scene.simulation.gravity));
    scene.cloth_velocity.linear = down * speed;
    scene.colliders.front().angular_velocity = down * (-run.turn * std::numbers::pi / 180);
    const Simulation start = make_simulation(scene, map);
    Fall fall{.name = run.name, .cloth = start.deformable(), .options = scene.simulation};
    fall.models.push_back(std::move(model));
    fall.colliders.push_back(start.colliders()[0]);
    fall.frame_limit = setting.is_short ? kShortLimit : run.frame_limit;
    fall.with_particles = run.with_particles;
    return fall;
}

Fall fall_onto(std::string name, TriangleMesh model, Deformable cloth, const Setting& setting) {
    Fall fall{.name = std::move(name), .cloth = std::move(cloth)};
    fall.colliders.push_back({.map = ExactMap::build(model)});
    fall.models.push_back(std::move(model));
    fall.frame_limit = setting.is_short ? kShortLimit : kLimit;
    return fall;
}

/// Folds what lies at u > 0 over what lies at u < 0: half a circle about the axis at u = 0 and v = height,
/// and back. Lengths are kept at the distance `radius` from the axis. @pre v < height
void fold_over(float& u, float& v, float height, float radius) {
    if (u <= 0) return;
    const float offset = height - v; // from the axis
    const float half_circle = std::numbers::pi_v<float> * radius;
    const float angle = std::min(u, half_circle) / radius;
    const float beyond = std::max(0.0F, u - half_circle);
    u = offset * std::sin(angle) - beyond;
    v = height - offset * std::cos(angle);
}

/// A sheet, folded in four, falls onto a box, tilted a little.
Fall folded_fall(const Setting& setting) {
    const std::uint32_t side = setting.is_short ? kShortSide : kSide;
    const ClothOptions cloth{.column_count = side, .row_count = side, .width = 1.6, .height = 1.6};
    const auto spacing = static_cast<float>(cloth.width / (cloth.column_count - 1));
    const float gap = 1.25F * spacing; // of the layers
    Deformable folded = make_cloth(cloth);
    const Rotation tilt = Rotation::about({1, 1, 0}, 0.1);
    const double speed = setting.is_short ? kShortSpeed : 0;
    for (Vec3f& p : folded.positions) {
        fold_over(p.x, p.z, 0.5F * gap, 0.5F * gap);
        fold_over(p.y, p.z, 1.5F * gap, gap);
        p = Vec3f(tilt.apply(Vec3d(p)) + Vec3d{0.45, 0.4, 0.4});
    }
    folded.velocities.assign(folded.particle_count(), {0, 0, static_cast<float>(-speed)});
    return fall_onto("sheet folded in four", make_box({1, 1, 0.3}), std::move(folded), setting);
}

/// Its models share no surface.
TriangleMesh joined(const std::vector<TriangleMesh>& parts) {
    TriangleMesh all;
    for (const TriangleMesh& part : parts) {
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const Triangle& f : part.faces) all.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
    return all;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3f& by) {
    for (Vec3f& v : mesh.vertices) v = v + by;
    return mesh;
}

TriangleMesh comb() {
    std::vector<TriangleMesh> teeth;
    for (int i = -6; i <= 6; ++i)
        teeth.push_back(moved(make_box({0.02, 0.8, 0.6}), {0.08F * float(i), 0, 0}));
    return joined(teeth);
}

/// A level sheet over the middle of a model, which is brought to a bounding sphere with a radius of a metre;
/// the sheet is twice as large as that.
Fall sheet_over(std::string name, TriangleMesh model, const Setting& setting) {
    Vec3f low = model.vertices[0], high = low;
    for (const Vec3f& v : model.vertices) {
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    const double scale = 2 / length(Vec3d(high) - Vec3d(low));
    const Vec3d middle = (Vec3d(high) + Vec3d(low)) * 0.5;
    for (Vec3f& v : model.vertices) v = Vec3f((Vec3d(v) - middle) * scale);
    const std::uint32_t side = setting.is_short ? kShortSide : kSide;
    ClothOptions cloth{.column_count = side, .row_count = side, .width = 2, .height = 2};
    cloth.pose.translation = {0, 0, (double{high.z} - middle.z) * scale + 0.05};
    Fall fall = fall_onto(std::move(name), std::move(model), make_cloth(cloth), setting);
    fall.options.allow_open_colliders = true;
    return fall;
}

/// Ten sheets, one above the other.
Fall ten_layers(const Setting& setting) {
    const std::uint32_t side = setting.is_short ? 10 : 16;
    const ClothOptions layer{.column_count = side, .row_count = side};
    const auto spacing = static_cast<float>(layer.width / (layer.column_count - 1));
    const Deformable sheet = make_cloth(layer);
    std::vector<TriangleMesh> layers;
    for (int i = 0; i < 10; ++i)
        layers.push_back(
            moved({sheet.positions, sheet.faces}, {0.3F, 0.2F, 0.2F + 1.25F * spacing * float(i)}));
    return fall_onto("ten layers", make_box({1, 1, 0.3}), make_cloth(joined(layers), MeshClothOptions{}),
                     setting);
}

/// A closed bag falls into the hole of a torus.
Fall bag_fall(const Setting& setting) {
    MeshClothOptions options;
    options.pose.translation = {0, 0, 1.3};
    return fall_onto("closed bag", make_torus(1, 0.4, 60, 24), make_cloth(make_sphere(0.9, 60, 30), options),
                     setting);
}

/// A ball to which the middle of a sheet is tied pulls it down through a ring, which is a third as wide as
/// the sheet is long.
Fall ring_pull(const Setting& setting) {
    const std::uint32_t side = (setting.is_short ? kShortSide : kSide) + 1; // one is in the middle
    ClothOptions cloth{.column_count = side, .row_count = side, .width = 2, .height = 2};
    cloth.pose.translation = {0, 0, 0.3};
    Fall fall =
        fall_onto("sheet pulled through a ring", make_torus(0.6, 0.2, 60, 24), make_cloth(cloth), setting);
    const TriangleMesh ball = make_sphere(0.05, 12, 8);
    Collider pulling{.map = ExactMap::build(ball)};
    pulling.pose.translation = {0, 0, 0.2};
    pulling.linear_velocity = {0, 0, -1};
    fall.models.push_back(ball);
    fall.colliders.push_back(pulling);
    const auto middle = static_cast<std::uint32_t>(fall.cloth.particle_count() / 2);
    fall.cloth.attachments.push_back({.particle = middle, .collider = 1});
    fall.cloth.inverse_masses[middle] = 0;
    fall.frame_limit = std::min(fall.frame_limit, kPullingLimit);
    return fall;
}

std::vector<Fall> other_falls(const Setting& setting) {
    std::vector<Fall> falls{folded_fall(setting),
                            sheet_over("needle", make_box({0.01, 0.01, 1}), setting),
                            sheet_over("thin plate", make_box({1, 0.002, 0.6}), setting),
                            sheet_over("comb", comb(), setting),
                            ten_layers(setting),
                            bag_fall(setting),
                            ring_pull(setting)};
    for (const char* file : {"human_mannequin.obj", "scorpion.obj", "teapot.obj"})
        if (std::filesystem::exists(setting.meshes / file))
            falls.push_back(sheet_over(std::filesystem::path(file).stem().string(),
                                       weld(read_mesh(setting.meshes / file)), setting));
    return falls;
}

// ---- The judge ----

TriangleMesh placed(TriangleMesh mesh, const Collider& collider) {
    const Vec3d& scale = collider.scale;
    for (Vec3f& v : mesh.vertices)
        v = Vec3f(collider.pose.to_world(Vec3d(v.x * scale.x, v.y * scale.y, v.z * scale.z)));
    return mesh;
}

/// @param values  ascending, not empty
double percentile_99(const std::vector<double>& values) {
    return values[(values.size() - 1) * 99 / 100];
}

/// Of the particles outside, from the model; thicknesses. NaN where none is nearer than two of them.
double least_gap(const Simulation& simulation) {
    const double thickness = simulation.options().thickness.value();
    std::vector<Contact> contacts(simulation.positions().size());
    contacts_batch(simulation.colliders()[0], simulation.positions(), static_cast<float>(2 * thickness),
                   contacts);
    double least = std::numeric_limits<double>::quiet_NaN();
    for (const Contact& contact : contacts)
        if (contact.found() && !contact.inside) least = std::fmin(least, -double{contact.depth} / thickness);
    return least;
}

// ---- The runs ----

/// One cloth on its way.
class Runner {
  public:
    Runner(const Fall& fall, const Method& method)
        : fall_(fall), stride_(method.of_faces ? 1 : kCgalStride),
          simulation_(fall.cloth, fall.colliders, options_of(fall, method)) {}

    bool is_done() const { return simulation_.at_rest() || simulation_.frame() >= fall_.frame_limit; }

    void run_frame() {
        const std::uint64_t truncated_before = simulation_.profile().truncated_count;
        const double start = comparison::thread_seconds();
        simulation_.step();
        frame_ms_.push_back(1e3 * (comparison::thread_seconds() - start));
        truncated_most_ = std::max(truncated_most_, simulation_.profile().truncated_count - truncated_before);
        if (is_due(stride_)) judge();
    }

    double progress() const {
        return is_done() ? 1 : static_cast<double>(simulation_.frame()) / fall_.frame_limit;
    }

    double mean_ms() const {
        return std::accumulate(frame_ms_.begin(), frame_ms_.end(), 0.0) /
               static_cast<double>(frame_ms_.size());
    }

    Records::Record record() const {
        const Strain strain = material_strain(simulation_.deformable()).value();
        std::vector<double> times = frame_ms_;
        std::ranges::sort(times);
        const SimulationProfile& profile = simulation_.profile();
        return {
            {"scene", fall_.name},
            {"particles", fmt::format("{}", fall_.cloth.particle_count())},
            {"model_pairs", fmt::format("{}", model_pairs_)},
            {"own_pairs", fmt::format("{}", own_pairs_)},
            {"judged_frames", fmt::format("{}", judged_frames_)},
            {"cgal_frames", fmt::format("{}", cgal_frames_)},
            {"judges_differ", fmt::format("{}", judges_differ_)},
            {"frames", fmt::format("{}", simulation_.frame())},
            {"rested", simulation_.at_rest() ? "yes" : "no"},
            {"strain_mean", fmt::format("{:.4g}", strain.mean)},
            {"strain_99", fmt::format("{:.4g}", strain.percentile_99)},
            {"strain_largest", fmt::format("{:.4g}", strain.largest)},
            {"strain_ever", fmt::format("{:.4g}", strain_ever_)},
            {"truncated_mean", fmt::format("{:.4g}", double(profile.truncated_count) / simulation_.frame())},
            {"truncated_most", fmt::format("{}", truncated_most_)},
            {"unresolved", fmt::format("{}", profile.unresolved_count)},
            {"gap_least", fmt::format("{:.4g}", least_gap(simulation_))},
            {"frame_ms", fmt::format("{:.4g}", mean_ms())},
            {"frame_ms_99", fmt::format("{:.4g}", percentile_99(times))},
            {"frame_ms_worst", fmt::format("{:.4g}", times.back())}};
    }

  private:
    static SimulationOptions options_of(const Fall& fall, const Method& method) {
        SimulationOptions options = fall.options;
        options.newton().collision =
            method.of_faces ? CollisionMode::SurfacesAndSelf : CollisionMode::Particles;
        return options;
    }

    bool is_due(std::uint32_t stride) const { return simulation_.frame() % stride == 0 || is_done(); }

    void judge() {
        const Deformable& cloth = simulation_.deformable();
        const TriangleMesh surface{cloth.positions, cloth.faces};
        const bool asks_cgal = gap_got_less() || is_due(kCgalStride);
        std::size_t model_pairs = 0;
        for (std::size_t c = 0; c < fall_.models.size(); ++c) {
            const TriangleMesh model = placed(fall_.models[c], simulation_.colliders()[c]);
            const std::vector<FacePair> pairs = intersecting_pairs(surface, model);
            if (asks_cgal) judges_differ_ += pairs != test::intersecting_pairs_by_cgal(surface, model);
            model_pairs += pairs.size();
        }
        model_pairs_ = std::max(model_pairs_, model_pairs);
        const std::vector<FacePair> own = self_intersecting_pairs(surface);
        if (asks_cgal) judges_differ_ += own != test::self_intersecting_pairs_by_cgal(surface);
        own_pairs_ = std::max(own_pairs_, own.size());
        strain_ever_ = std::max(strain_ever_, material_strain(cloth)->largest);
        ++judged_frames_;
        cgal_frames_ += asks_cgal;
    }

    /// Is the least gap of this frame the least so far?
    bool gap_got_less() {
        const double gap = least_gap(simulation_);
        if (!(gap < gap_least_ever_)) return false;
        gap_least_ever_ = gap;
        return true;
    }

    const Fall& fall_;
    std::uint32_t stride_; ///< of the frames that are judged
    Simulation simulation_;
    std::vector<double> frame_ms_;
    std::size_t model_pairs_ = 0, own_pairs_ = 0; ///< of the worst frame
    std::uint32_t judged_frames_ = 0, cgal_frames_ = 0;
    std::uint32_t judges_differ_ = 0; ///< surfaces of a frame about which CGAL says otherwise
    std::uint64_t truncated_most_ = 0;
    double strain_ever_ = 0, gap_least_ever_ = std::numeric_limits<double>::infinity();
};

bool has(const Records& records, const Fall& fall) {
    const std::string particles = fmt::format("{}", fall.cloth.particle_count());
    return std::ranges::any_of(records.all(), [&](const Records::Record& record) {
        return record.at("scene") == fall.name && record.at("particles") == particles;
    });
}

void add_fall(const Fall& fall, const Setting& setting, Records& records) {
    if (has(records, fall)) return;
    std::vector<Method> methods{{"faces", true}};
    if (fall.with_particles) methods.insert(methods.begin(), {"particles", false});
    std::vector<Runner> runners;
    for (const Method& method : methods) runners.emplace_back(fall, method);
    run_in_turns(runners, [&](double progress) { setting.report_progress(fall.name, progress); });
    for (std::size_t k = 0; k < methods.size(); ++k) {
        Records::Record record = runners[k].record();
        record["method"] = methods[k].name;
        if (fall.with_particles)
            record["ratio"] = fmt::format("{:.4g}", runners[k].mean_ms() / runners[0].mean_ms());
        records.add(std::move(record));
    }
    setting.store(records);
}

} // namespace

Records measure_surfaces(const Setting& setting) {
    Records records({"scene",          "particles",   "method",         "model_pairs", "own_pairs",
                     "judged_frames",  "cgal_frames", "judges_differ",  "frames",      "rested",
                     "strain_mean",    "strain_99",   "strain_largest", "strain_ever", "truncated_mean",
                     "truncated_most", "unresolved",  "gap_least",      "frame_ms",    "frame_ms_99",
                     "frame_ms_worst", "ratio"});
    if (setting.earlier)
        for (const Records::Record& record : setting.earlier->all()) records.add(record);
    for (const SceneRun& run : scene_runs()) add_fall(fall_of(run, setting), setting, records);
    for (const Fall& fall : other_falls(setting)) add_fall(fall, setting, records);
    return records;
}
