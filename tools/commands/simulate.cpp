#include "commands/commands.hpp"
#include "commands/scene_model.hpp"
#include "commands/simulation_result.hpp"
#include "console/progress.hpp"
#include "input_file.hpp"
#include "mesh_io/point_cache.hpp"
#include "output.hpp"
#include "recording/player_page.hpp"
#include "recording/threads.hpp"
#include "run_program.hpp"

#include <echinus/mesh_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

constexpr const char* kCacheName = "cloth.pc2";
constexpr const char* kFramesName = "frames";

struct SimulateArguments {
    fs::path scene;
    fs::path target;                 ///< folder; empty for none
    fs::path page;                   ///< empty for none
    fs::path player;                 ///< empty for the installed one
    fs::path from_state, save_state; ///< empty for none
    std::vector<fs::path> model_folders;
    std::optional<std::uint32_t> frame_limit;
    std::optional<std::uint32_t> stride;
    std::optional<std::uint32_t> particle_count; ///< approximate number for the sheet
    /// The number of threads, instead of the scene's key and of all cores.
    std::optional<unsigned> thread_count;

    unsigned threads_around() const { return thread_count.value_or(0); }
    std::optional<CollisionMode> collision; ///< instead of the scene's
    bool judges_all = false;                ///< whether all saved frames are judged, not only the last
    bool obj = false;
    bool json = false;
};

/// The name of a collider's file in the folder, by the collider's number.
std::string collider_file(std::size_t number, const char* extension = "obj") {
    return number == 0 ? fmt::format("collider.{}", extension)
                       : fmt::format("collider_{}.{}", number, extension);
}

/// The output folder, with the positions of the cloth in every saved frame: as one point cache or as one OBJ
/// file for each frame; and with point caches of the colliders that deform.
class ResultFolder {
  public:
    ResultFolder(const fs::path& target, bool obj) : folder_(target), obj_(obj) {}

    /// @param colliders  must outlive this
    void begin(const Deformable& cloth, const LoadedColliders& colliders, std::uint32_t stride) {
        colliders_ = &colliders;
        surface_.emplace(cloth);
        write_mesh_and_edges(folder_.path_of("cloth.obj"), surface_->mesh(cloth.positions));
        for (std::size_t c = 0; c < colliders.maps.size(); ++c) {
            const TriangleMesh mesh = colliders.mesh_at(c, 0);
            write_mesh(folder_.path_of(collider_file(c)), mesh);
            collider_caches_.push_back(colliders.deforms(c) ? std::make_unique<PointCacheWriter>(
                                                                  folder_.path_of(collider_file(c, "pc2")),
                                                                  mesh.vertices.size(), stride)
                                                            : nullptr);
        }
        if (obj_) {
            fs::create_directory(folder_.path_of(kFramesName));
        } else {
            cache_.emplace(folder_.path_of(kCacheName), surface_->vertex_count(), stride);
        }
    }
    void add(const Simulation& simulation) {
        const double seconds = simulation.frame() * simulation.options().time_step;
        for (std::size_t c = 0; c < collider_caches_.size(); ++c)
            if (collider_caches_[c]) collider_caches_[c]->add(colliders_->mesh_at(c, seconds).vertices);
        if (cache_) return cache_->add(surface_->vertices(simulation.positions()));
        write_mesh_and_edges(folder_.path_of(kFramesName) /
                                 fmt::format("cloth_{:06}.obj", simulation.frame()),
                             surface_->mesh(simulation.positions()));
    }
    void commit(const Json& report) {
        if (cache_) cache_->commit();
        for (auto& cache : collider_caches_)
            if (cache) cache->commit();
        write_file(folder_.path_of("report.json"), report.indented());
        folder_.commit();
        folder_.remove_old(obj_ ? kCacheName : kFramesName);
    }

  private:
    OutputFolder folder_;
    bool obj_;
    std::optional<VisibleSurface> surface_;
    std::optional<PointCacheWriter> cache_;
    const LoadedColliders* colliders_ = nullptr;
    std::vector<std::unique_ptr<PointCacheWriter>> collider_caches_; ///< null if it does not deform
};

/// The output page. Constructed before the simulation, so that a missing player is reported at once.
struct Page {
    Page(const fs::path& target, const fs::path& player_path) : player(player_path), output(target) {}

    Player player;
    Output output;
    std::optional<Recording> recording;
};

/// The output of a simulation: a folder, a page, or both, and a state from which to continue.
struct Results {
    std::optional<ResultFolder> folder;
    std::optional<Page> page;
    std::optional<Output> state;

    /// To be called at the start and after each step.
    void watch(const Simulation& simulation, std::uint32_t stride) {
        if (folder && simulation.frame() % stride == 0) folder->add(simulation);
        if (page) page->recording->watch(simulation);
    }
};

struct Course {
    std::vector<std::vector<SavedPose>> poses; ///< [collider]
    std::vector<std::vector<SavedLoad>> loads; ///< [collider]
    std::uint64_t most_truncated = 0;          ///< the most vertices truncated in one frame
    std::optional<WorstFrames> worst;
};

bool has_moved(const RigidTransform& from, const RigidTransform& to) {
    const Rotation &a = from.rotation, &b = to.rotation;
    return from.translation != to.translation || a.w != b.w || a.x != b.x || a.y != b.y || a.z != b.z;
}

/// Averages the loads on colliders from one saved frame to the next.
class LoadMeter {
  public:
    explicit LoadMeter(const Simulation& simulation)
        : simulation_(&simulation), sums_(simulation.colliders().size()) {}

    void add_frame() {
        for (std::size_t c = 0; c < sums_.size(); ++c) {
            const Load load = simulation_->load_on(c);
            sums_[c].force += load.force;
            sums_[c].torque += load.torque;
        }
        ++frame_count_;
    }
    void save_to(std::vector<std::vector<SavedLoad>>& loads) {
        for (std::size_t c = 0; c < sums_.size(); ++c) {
            const auto& [force, torque] = std::exchange(sums_[c], {});
            loads[c].push_back(
                {simulation_->frame(), {force * (1.0 / frame_count_), torque * (1.0 / frame_count_)}});
        }
        frame_count_ = 0;
    }

  private:
    const Simulation* simulation_;
    std::vector<Load> sums_; ///< [collider]
    int frame_count_ = 0;
};

/// Counts the pairs of faces that intersect in a frame.
class FrameJudge {
  public:
    explicit FrameJudge(const LoadedColliders& colliders) : colliders_(&colliders) {
        for (std::size_t c = 0; c < colliders.maps.size(); ++c) models_.push_back(colliders.mesh_at(c, 0));
    }

    PairCounts count(const Simulation& simulation) {
        const double seconds = simulation.frame() * simulation.options().time_step;
        for (std::size_t c = 0; c < models_.size(); ++c)
            if (colliders_->deforms(c)) models_[c] = colliders_->mesh_at(c, seconds);
        return count_pairs(simulation, models_);
    }

  private:
    const LoadedColliders* colliders_;
    std::vector<TriangleMesh> models_; ///< scaled, but not moved
};

/// Steps until the cloth rests or the frame limit is reached; stops only after a frame that was saved, so
/// that the last sample is the final state.
/// @param judge  judges the saved frames; may be empty
Course run(Simulation& simulation, Results& results, std::uint32_t frame_limit, std::uint32_t stride,
           std::optional<FrameJudge> judge) {
    ProgressBar progress("simulating");
    const std::vector<Collider>& colliders = simulation.colliders();
    Course course;
    if (judge) course.worst.emplace();
    std::optional<PairCounts> pairs;
    const auto judge_frame = [&] {
        if (!judge) return;
        pairs = judge->count(simulation);
        course.worst->judge(simulation.frame(), *pairs);
        if (results.page) results.page->recording->add_pairs(simulation.frame(), *pairs);
    };
    for (const Collider& collider : colliders) course.poses.push_back({{simulation.frame(), collider.pose}});
    course.loads.resize(colliders.size());
    LoadMeter loads(simulation);
    results.watch(simulation, stride);
    judge_frame();
    while (simulation.frame() < frame_limit && !simulation.at_rest()) {
        do {
            const std::uint64_t truncated_before = simulation.profile().truncated_count;
            simulation.step();
            course.most_truncated =
                std::max(course.most_truncated, simulation.profile().truncated_count - truncated_before);
            loads.add_frame();
            results.watch(simulation, stride);
        } while (simulation.frame() % stride != 0);
        judge_frame();
        loads.save_to(course.loads);
        for (std::size_t c = 0; c < colliders.size(); ++c)
            if (has_moved(course.poses[c].back().pose, colliders[c].pose))
                course.poses[c].push_back({simulation.frame(), colliders[c].pose});
        progress(static_cast<double>(simulation.frame()) / frame_limit);
    }
    if (results.page) {
        results.page->recording->finish(simulation);
        if (pairs) results.page->recording->add_pairs(simulation.frame(), *pairs);
    }
    return course;
}

void require_target(const SimulateArguments& arguments) {
    if (arguments.scene == kStandardStream)
        throw WrongUse("SCENE",
                       "cannot be standard input (-), since a model's file is looked up next to the scene");
    if (arguments.target.empty() && arguments.page.empty())
        throw WrongUse("simulate", "needs -o DIR, --html FILE, or both");
    if (arguments.target.empty() && arguments.obj)
        throw WrongUse("--obj", "applies to the files in a folder, so it needs -o DIR");
    if (!arguments.from_state.empty() && !arguments.page.empty())
        throw WrongUse("--from-state",
                       "cannot be combined with --html, whose page shows all frames from the first");
    require_one_result(arguments.page, arguments.json);
    require_one_result(arguments.save_state, arguments.json);
    if (arguments.page == kStandardStream && arguments.save_state == kStandardStream)
        throw WrongUse("--save-state", "and --html cannot both go to standard output (-)");
    if (arguments.from_state == kStandardStream)
        throw WrongUse("--from-state", "cannot be standard input (-); name a file");
    require_another_file(arguments.scene, arguments.save_state);
    require_another_file(arguments.scene, arguments.page);
}

/// The frame stride of a page.
std::uint32_t page_stride(const SimulateArguments& arguments, const Scene& scene) {
    return arguments.stride.value_or(stride_for_display(scene.simulation.time_step));
}

/// Called before the simulation, so that output that cannot be written is refused at once.
void open(Results& results, const SimulateArguments& arguments, const Scene& scene,
          const ClothMeshes& cloth) {
    if (!arguments.target.empty()) results.folder.emplace(arguments.target, arguments.obj);
    if (!arguments.save_state.empty()) results.state.emplace(arguments.save_state);
    if (!arguments.page.empty()) {
        const auto make = [&] { return make_deformable(scene, cloth); };
        require_playable(made_as_scene_says(arguments.scene, "", make).particle_count(), scene.frame_limit,
                         page_stride(arguments, scene));
        results.page.emplace(arguments.page, arguments.player);
    }
}

/// If only particles collide, there is nothing to untangle.
void choose_collision(const SimulateArguments& arguments, Scene& scene) {
    if (!arguments.collision) return;
    auto* const newton = std::get_if<NewtonOptions>(&scene.simulation.solver);
    if (newton == nullptr && arguments.collision != CollisionMode::Particles)
        throw WrongUse("--collision",
                       "with the scene's jakobsen solver only particles collide; leave the option "
                       "out, or set \"solver\": \"newton\" in the scene");
    if (newton == nullptr) return;
    newton->collision = *arguments.collision;
    newton->untangle = newton->untangle && scene.simulation.surfaces_collide();
}

/// Replaces the scene's sheet by one with about this many particles and the same ratio of rows to columns.
/// The particles nearest to those that the scene holds are held.
void choose_particles(std::uint32_t particle_count, Scene& scene) {
    if (!scene.has_cloth || scene.mesh_cloth)
        throw WrongUse("--particles", "applies only to a sheet, and the scene has none; a cloth made from a "
                                      "mesh has the mesh's vertices");
    constexpr double kLeast = 2, kMost = 4096; // the limits of scenes
    ClothOptions& sheet = scene.cloth;
    const ClothOptions before = sheet;
    const double factor = std::sqrt(particle_count / (double{1} * sheet.column_count * sheet.row_count));
    const auto scaled = [&](std::uint32_t count) {
        return static_cast<std::uint32_t>(std::clamp(std::round(factor * count), kLeast, kMost));
    };
    sheet.column_count = scaled(sheet.column_count);
    sheet.row_count = scaled(sheet.row_count);
    std::set<std::uint32_t> held;
    const auto renumber = [&](std::vector<std::uint32_t>& particles) {
        for (std::uint32_t& particle : particles) {
            const auto nearest = [](std::uint32_t place, std::uint32_t from, std::uint32_t to) {
                return static_cast<std::uint32_t>(std::round(double{1} * place * (to - 1) / (from - 1)));
            };
            particle = nearest(particle / before.column_count, before.row_count, sheet.row_count) *
                           sheet.column_count +
                       nearest(particle % before.column_count, before.column_count, sheet.column_count);
        }
        // Particles that have become the same one are held only once.
        std::erase_if(particles, [&](std::uint32_t particle) { return !held.insert(particle).second; });
    };
    renumber(sheet.pins);
    for (SceneAttachment& attachment : scene.cloth_attachments)
        renumber(std::get<std::vector<std::uint32_t>>(attachment.vertices));
    for (SceneHandle& handle : scene.cloth_handles)
        renumber(std::get<std::vector<std::uint32_t>>(handle.vertices));
}

std::vector<ColliderResult> results_of(const LoadedColliders& colliders, Course& course) {
    std::vector<ColliderResult> results;
    for (std::size_t c = 0; c < colliders.maps.size(); ++c)
        results.push_back({.mesh_name = collider_file(c),
                           .cache_name = colliders.deforms(c) ? collider_file(c, "pc2") : "",
                           .model = inspect(colliders.judged[c].mesh),
                           .radius = inspect(colliders.mesh_at(c, 0)).bounding_sphere.radius,
                           .poses = std::move(course.poses[c]),
                           .loads = std::move(course.loads[c])});
    return results;
}

/// @throws WrongUse
void require_playable_colliders(const SimulateArguments& arguments, const Scene& scene) {
    for (const SceneCollider& collider : scene.colliders)
        if (collider.cache && !arguments.page.empty())
            throw WrongUse("--html", "cannot show a deforming collider, and the cache " +
                                         collider.cache->name + " deforms one; write a folder with -o DIR");
}

/// Continues from a saved state. A state of another scene is reported as a file of the wrong format, not as
/// an invalid option.
void go_on_from(const fs::path& state, std::uint32_t frame_limit, Simulation& simulation) {
    try {
        simulation.restore_state(state);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::InvalidOptions) throw;
        throw Error(ErrorCode::WrongFormat, error.what());
    }
    if (simulation.frame() >= frame_limit)
        throw WrongUse(
            "--from-state",
            fmt::format("{} was saved after frame {}, and the run ends at frame {}; set a larger --frames",
                        state.string(), simulation.frame(), frame_limit));
}

void write_state(const Simulation& simulation, Output& output) {
    const std::vector<std::byte> state = simulation.save_state();
    output.write(state.data(), state.size());
    output.commit();
}

void simulate(const SimulateArguments& arguments) {
    require_target(arguments);
    Scene scene = read_scene(arguments.scene);
    for (const std::string& warning : scene.warnings) warn(warning);
    if (arguments.frame_limit) scene.frame_limit = *arguments.frame_limit;
    scene.simulation.thread_count = arguments.thread_count.value_or(scene.simulation.thread_count);
    choose_collision(arguments, scene);
    if (arguments.particle_count) choose_particles(*arguments.particle_count, scene);
    require_playable_colliders(arguments, scene);
    // A page chooses its frames from all, so its last one is the end; the last frame of a folder must be a
    // saved one.
    const std::uint32_t stride = arguments.target.empty() ? 1 : arguments.stride.value_or(1);
    const ClothMeshes cloth = load_meshes(scene, arguments.scene, arguments.model_folders);
    Results results;
    open(results, arguments, scene, cloth);

    const LoadedColliders colliders =
        load_colliders(scene, arguments.scene, arguments.model_folders, arguments.threads_around());
    for (const fs::path& file : colliders.files)
        for (const fs::path& target : {arguments.page, arguments.save_state})
            require_another_file(file, target);
    Simulation simulation = made_as_scene_says(
        arguments.scene, "", [&] { return make_simulation(scene, colliders.maps, cloth, colliders.caches); });
    if (results.folder) results.folder->begin(simulation.deformable(), colliders, stride);
    if (!arguments.from_state.empty()) go_on_from(arguments.from_state, scene.frame_limit, simulation);
    std::vector<ExactMap> judges;
    for (const JudgedModel& model : colliders.judged) judges.push_back(model.map);
    if (results.page) results.page->recording.emplace(std::move(judges), page_stride(arguments, scene));
    std::optional<FrameJudge> frame_judge;
    if (arguments.judges_all) frame_judge.emplace(colliders);
    Course course = naming_file(arguments.scene.string(), ErrorCode::Diverged, [&] {
        return run(simulation, results, scene.frame_limit, stride, std::move(frame_judge));
    });

    const std::string scene_name = arguments.scene.string();
    const double seconds = simulation.frame() * simulation.options().time_step;
    const SimulationResult result{.scene_name = scene_name,
                                  .simulation = simulation,
                                  .colliders = results_of(colliders, course),
                                  .verdict = judge(simulation,
                                                   colliders.judged_at(seconds, arguments.threads_around()),
                                                   arguments.threads_around()),
                                  .most_truncated = course.most_truncated,
                                  .worst = course.worst};
    const Json report = to_json(result);
    std::vector<TriangleMesh> placed;
    for (std::size_t c = 0; c < colliders.maps.size(); ++c) placed.push_back(colliders.mesh_at(c, 0));
    if (results.page)
        write_player_page(results.page->output, results.page->player,
                          {.result = result,
                           .recording = *results.page->recording,
                           .scene_name = arguments.scene.filename().string(),
                           .model_name = colliders.names,
                           .notice = colliders.notice,
                           .colliders = placed});
    if (results.folder) results.folder->commit(report);
    if (results.state) write_state(simulation, *results.state);
    if (arguments.json)
        print(report.indented());
    else if (arguments.page != kStandardStream && arguments.save_state != kStandardStream)
        print(to_text(result));
}

void add_options(Command command, SimulateArguments& arguments) {
    command.add("SCENE", &arguments.scene, "Scene file (docs/scenes.md), which cannot be -")
        .required()
        .type_name("");
    command
        .add("-o,--output", &arguments.target,
             "Folder for cloth.obj, cloth.pc2, collider.obj and report.json")
        .type_name("DIR");
    command
        .add("--html", &arguments.page, "HTML page to write, a single file that plays the simulation, or -")
        .not_empty()
        .type_name("FILE");
    command
        .add("--player", &arguments.player,
             "Player from which the page is made, built by scripts/web; by default the installed one")
        .not_empty()
        .type_name("FILE");
    command
        .add("--models", &arguments.model_folders,
             "Folders in which the scene's model is looked up, before the scene's own, its ../models, and "
             "models")
        .type_name("DIR");
    command.add("--frames", &arguments.frame_limit, "Frame limit; overrides the scene's")
        .range(1, 1'000'000'000)
        .type_name("COUNT");
    command
        .add("--every", &arguments.stride,
             "Save every COUNT-th frame; by default all frames in a folder, and 60 per second in a page")
        .range(1, 1'000'000)
        .type_name("COUNT");
    command
        .add("--particles", &arguments.particle_count,
             "Replace the scene's sheet by one of about COUNT particles with the same proportions")
        .range(4, 4096 * 4096)
        .type_name("COUNT");
    command
        .add("--from-state", &arguments.from_state,
             "Resume from a state that --save-state wrote for the same scene with the same options")
        .not_empty()
        .type_name("FILE");
    command
        .add("--save-state", &arguments.save_state,
             "Write the final state, from which a run can resume, to a file or -")
        .not_empty()
        .type_name("FILE");
    const std::vector<std::pair<std::string, std::optional<CollisionMode>>> modes{
        {"particles", CollisionMode::Particles},
        {"surfaces", CollisionMode::Surfaces},
        {"surfaces_and_self", CollisionMode::SurfacesAndSelf}};
    add_choice(command, "--collision", arguments.collision, modes,
               "The parts that collide; overrides the scene's collision");
    command.add_former("--surfaces", "--collision surfaces; to turn it off, use --collision particles");
    command.add_former("--self", "--collision surfaces_and_self; to turn it off, use --collision surfaces");
    command
        .add("--threads", &arguments.thread_count,
             "Threads that build the map, simulate and test for intersections; 0: all cores. By default all "
             "cores build and test, and the simulation uses the scene's thread_count")
        .range(0, 1024)
        .type_name("COUNT");
    add_choice(command, "--judge", arguments.judges_all,
               std::vector<std::pair<std::string, bool>>{{"last", false}, {"all", true}},
               "Saved frames to test for intersecting faces");
    command.add_flag("--obj", arguments.obj, "Write frames/cloth_NUMBER.obj instead of cloth.pc2");
    command.add_flag("--json", arguments.json, "Print the report as one JSON object");
}

} // namespace

void add_simulate_command(Command program) {
    Command command = program.add_command("simulate", "Simulate a scene until it comes to rest");
    const auto arguments = std::make_shared<SimulateArguments>();
    add_options(command, *arguments);
    command.footer("Examples:\n  echinus simulate scenes/horse.json -o out/horse\n"
                   "  echinus simulate scenes/horse.json --html horse.html");
    command.action([arguments] { simulate(*arguments); });
}
