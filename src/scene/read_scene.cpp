#include "files/text.hpp"
#include "scene/json_object.hpp"
#include "scene/option_keys.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <span>

namespace echinus {

namespace fs = std::filesystem;

namespace {

/// Beyond 1e9 units a float no longer resolves details near the origin.
constexpr Range kCoordinate{-1e9, 1e9};
constexpr Range kLength{1e-9, 1e9};
constexpr Range kSegmentCount{1, 4096};
constexpr Range kDegrees{-1e6, 1e6};
constexpr Range kTime{-1e9, 1e9};
constexpr Range kMass{1e-9, 1e15};
/// Tolerance for the squared length of a quaternion.
constexpr double kUnitTolerance = 1e-4;
/// The default of a scene: the constraints need a smaller time step than the default of the options.
constexpr double kJakobsenTimeStep = 1.0 / 240;
constexpr double kRadiansPerDegree = std::numbers::pi / 180;

/// The words of CollisionMode, in its order.
constexpr std::array kModes{"particles", "surfaces", "surfaces_and_self"};

/// The number of edges for "small_holes" without "hole_edges".
constexpr std::uint32_t kUsualHoleEdges = 32;

/// A key of the paper's solver or of a solver in an earlier version, and what to write instead.
struct KeyWithoutEffect {
    const char* key;
    const char* instead;
};
constexpr const char* kNewtonHasNone =
    "under the newton solver, which converges; leave it out, or see newton_steps";
constexpr KeyWithoutEffect kOfTheScene[] = {{"iterations", kNewtonHasNone}};
constexpr KeyWithoutEffect kOfTheMaterial[] = {
    {"structural", "under the newton solver; write material.stretch_stiffness, in N/m"},
    {"shear", "under the newton solver; write material.shear_stiffness, in N/m"},
    {"bending", "under the newton solver; write material.bending_stiffness, in N m"},
    {"drag", "under the newton solver; write material.air_drag, in 1/s"},
};
/// Keys without effect for either solver.
constexpr KeyWithoutEffect kOfTheSceneBefore[] = {
    {"substeps", "any more; leave it out"},
    {"multilevel", "any more, since the newton solver converges at every resolution; leave it out"},
};
constexpr KeyWithoutEffect kOfTheMaterialBefore[] = {
    {"compliance",
     "any more; write material.stretch_stiffness, material.shear_stiffness and material.bending_stiffness"},
};
constexpr KeyWithoutEffect kOfTheClothBefore[] = {
    {"bending", "any more; newton computes bending from angles, and jakobsen from distance constraints"},
};

/// Warns of those keys that are present.
void ignore(JsonObject& object, std::span<const KeyWithoutEffect> keys, Scene& scene) {
    for (const auto& [key, instead] : keys)
        if (auto warning = object.ignore(key, instead)) scene.warnings.push_back(*std::move(warning));
}

using Counts = std::array<std::uint32_t, 2>;

SceneModel read_torus(JsonObject torus) {
    TorusModel model;
    Counts segments{model.major_segments, model.minor_segments};
    torus.read("major", model.major_radius, kLength);
    torus.read("minor", model.minor_radius, kLength);
    torus.read("segments", segments, kSegmentCount);
    torus.finish();
    model.major_segments = segments[0];
    model.minor_segments = segments[1];
    return model;
}

SceneModel read_sphere(JsonObject sphere) {
    SphereModel model;
    Counts segments{model.meridian_count, model.parallel_count};
    sphere.read("radius", model.radius, kLength);
    sphere.read("segments", segments, kSegmentCount);
    sphere.finish();
    model.meridian_count = segments[0];
    model.parallel_count = segments[1];
    return model;
}

SceneModel read_box(JsonObject box) {
    BoxModel model;
    box.read("size", model.size, kLength);
    box.read("segments", model.segments, kSegmentCount);
    box.finish();
    return model;
}

/// A file's name, or an object with the one key that names a generated shape.
/// @pre the key is present
SceneModel read_model(JsonObject& parent, const char* key) {
    if (parent.is_string(key)) {
        const std::string name = *parent.read_string(key);
        if (std::any_of(name.begin(), name.end(), [](char c) { return c >= 0 && c < ' '; }))
            parent.refuse(key, "a file's name, which has no control characters");
        return ModelFile{name};
    }
    std::optional<JsonObject> model = parent.object(key);
    std::vector<SceneModel> found;
    if (auto torus = model->object("torus")) found.push_back(read_torus(*torus));
    if (auto sphere = model->object("sphere")) found.push_back(read_sphere(*sphere));
    if (auto box = model->object("box")) found.push_back(read_box(*box));
    model->finish();
    if (found.size() != 1)
        parent.refuse(key, "a file's name or an object with one of the keys torus, sphere and box");
    return found.front();
}

RepairOptions read_repair(JsonObject& scene) {
    RepairOptions options;
    std::vector<std::string_view> words{"small_holes", "sheets"};
    for (const auto& [word, member] : kRepairWords) words.emplace_back(word);
    bool small_holes = false, sheets = false;
    for (const std::size_t word : scene.read_words("repair", words)) {
        if (word == 0)
            small_holes = true;
        else if (word == 1)
            sheets = true;
        else
            options.*kRepairWords[word - 2].second = true;
    }
    if (options.close_seams)
        scene.read("weld_distance", options.weld_distance, kLength);
    else if (scene.has("weld_distance"))
        scene.refuse("weld_distance", "left out, or \"repair\" must have the word \"seams\"");
    if (small_holes) {
        options.max_hole_edges = kUsualHoleEdges;
        scene.read("hole_edges", options.max_hole_edges, {3, RepairOptions::kMaxHoleEdges});
    } else if (scene.has("hole_edges")) {
        scene.refuse("hole_edges", "left out, or \"repair\" must have the word \"small_holes\"");
    }
    if (sheets) {
        scene.require("sheet_thickness");
        scene.read("sheet_thickness", options.sheet_thickness, kLength);
    } else if (scene.has("sheet_thickness")) {
        scene.refuse("sheet_thickness", "left out, or \"repair\" must have the word \"sheets\"");
    }
    return options;
}

ExactMapOptions read_exact_map(JsonObject& map) {
    ExactMapOptions options;
    constexpr double kMostCells = double{ExactMapOptions::kMaxDivisions} * ExactMapOptions::kMaxDivisions;
    std::uint32_t cells = 0;
    std::uint32_t budget = 0;
    map.read("cells_per_octant", cells, {0, kMostCells});
    map.read("budget", budget, {0, 4e9});
    if (cells != 0 && budget != 0) map.refuse("budget", "left out where map.cells_per_octant is given");
    options.divisions = static_cast<std::uint32_t>(std::sqrt(cells));
    options.byte_budget = budget;
    read_exact_map_options(map, options);
    return options;
}

MapOptions read_map(JsonObject map) {
    MapOptions options;
    if (map.read_word("kind", {"exact", "distance"}).value_or(0) == 0) {
        map.refuse_keys(kKeysOfDistanceMaps, "map.kind", "distance");
        options = read_exact_map(map);
    } else {
        map.refuse_keys(kKeysOfExactMaps, "map.kind", "exact");
        read_distance_map_options(map, options.emplace<DistanceMapOptions>());
    }
    map.finish();
    return options;
}

Rotation read_rotation(JsonObject& object) {
    if (object.is_array("rotation")) {
        std::array<double, 4> q{};
        object.read("rotation", q, {-1, 1});
        const double size_sq = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (std::abs(size_sq - 1) > kUnitTolerance)
            object.refuse("rotation", "a quaternion [w, x, y, z] of length 1");
        return Rotation{q[0], q[1], q[2], q[3]}.normalised();
    }
    auto rotation = object.object("rotation");
    if (!rotation) return {};
    Vec3d axis;
    double degrees = 0;
    rotation->require("axis");
    rotation->require("degrees");
    rotation->read("axis", axis, kCoordinate);
    rotation->read("degrees", degrees, kDegrees);
    if (length(axis) < 1e-9) rotation->refuse("axis", "a direction, longer than zero");
    rotation->finish();
    return Rotation::about(axis, degrees * kRadiansPerDegree);
}

RigidTransform read_pose(JsonObject& object) {
    RigidTransform pose;
    object.read("position", pose.translation, kCoordinate);
    pose.rotation = read_rotation(object);
    return pose;
}

/// One number for all axes, or one for each; a negative one mirrors.
void read_scale(JsonObject& collider, Vec3d& scale) {
    if (!collider.is_array("scale")) {
        double size = scale.x;
        collider.read("scale", size, kLength);
        scale = {size, size, size};
        return;
    }
    collider.read("scale", scale, {-kLength.most, kLength.most});
    for (const double size : {scale.x, scale.y, scale.z})
        if (std::abs(size) < kLength.least)
            collider.refuse("scale", "an array of 3 numbers, each from 1e-9 to 1e9 or from -1e9 to -1e-9");
}

/// Keyframes, each with a time and a pose.
std::vector<PoseKey> read_keyframes(JsonObject& collider) {
    std::vector<PoseKey> keys;
    for (JsonObject& object : collider.objects("keyframes")) {
        PoseKey& key = keys.emplace_back();
        object.require("time");
        object.read("time", key.time, kTime);
        key.pose = read_pose(object);
        object.finish();
        if (keys.size() > 1 && !(key.time > keys[keys.size() - 2].time))
            object.refuse("time", "later than that of the keyframe before it");
    }
    return keys;
}

/// A cache is given by a name or by an object with a name.
std::optional<CacheFile> read_cache(JsonObject& collider) {
    if (!collider.has("cache")) return std::nullopt;
    if (collider.is_string("cache")) {
        if (collider.read_string("cache")->empty()) collider.refuse("cache", "the name of a file or folder");
        return CacheFile{.name = *collider.read_string("cache")};
    }
    auto object = collider.object("cache");
    CacheFile cache;
    object->require("file");
    cache.name = *object->read_string("file");
    if (cache.name.empty()) object->refuse("file", "the name of a file or folder");
    object->read("frames_per_second", cache.frames_per_second, {1e-9, 1e9});
    if (object->has("animation")) cache.animation = *object->read_string("animation");
    object->finish();
    return cache;
}

/// Reads the pose of a collider and its motion.
void read_motion(JsonObject& object, SceneCollider& collider) {
    read_scale(object, collider.scale);
    collider.cache = read_cache(object);
    collider.keyframes = read_keyframes(object);
    object.read("mass", collider.mass, kMass);
    if (collider.mass && collider.cache) object.refuse("mass", "left out where the model deforms by a cache");
    if (!collider.keyframes.empty()) {
        for (const char* key : {"position", "rotation", "linear_velocity", "angular_velocity", "mass"})
            if (object.has(key)) object.refuse(key, "left out where there are keyframes");
        collider.pose = pose_at(collider.keyframes, 0);
        return;
    }
    Vec3d degrees_per_second;
    collider.pose = read_pose(object);
    object.read("linear_velocity", collider.linear_velocity, kCoordinate);
    object.read("angular_velocity", degrees_per_second, kDegrees);
    collider.angular_velocity = degrees_per_second * kRadiansPerDegree;
}

/// @pre the colliders have been read
Range numbers_of_colliders(const Scene& scene) {
    return {0, static_cast<double>(scene.colliders.size() - 1)};
}

/// One model, with the keys of its collider in a separate object; or an array of colliders with a model each.
void read_colliders(JsonObject& root, Scene& scene) {
    if (root.has("colliders")) {
        for (const char* key : {"model", "repair", "collider"})
            if (root.has(key)) root.refuse(key, "left out where there is the key \"colliders\"");
        for (JsonObject& object : root.objects("colliders")) {
            SceneCollider& collider = scene.colliders.emplace_back();
            object.require("model");
            collider.model = read_model(object, "model");
            collider.repair = read_repair(object);
            read_motion(object, collider);
            object.finish();
        }
        return;
    }
    SceneCollider& collider = scene.colliders.emplace_back();
    root.require("model", "colliders");
    collider.model = read_model(root, "model");
    collider.repair = read_repair(root);
    auto object = root.object("collider");
    if (!object) return;
    read_motion(*object, collider);
    object->finish();
}

/// Used for colliders and bodies. Angles in scenes are degrees.
SceneVelocity read_velocity(JsonObject& object) {
    SceneVelocity velocity;
    Vec3d degrees_per_second;
    object.read("velocity", velocity.linear, kCoordinate);
    object.read("angular_velocity", degrees_per_second, kDegrees);
    velocity.angular = degrees_per_second * kRadiansPerDegree;
    return velocity;
}

/// Particles that move with the first collider; or an array of objects, each with some particles and a
/// collider.
/// @param read_choice  (object, key) returns the choice under a key
/// @pre the colliders have been read
template <typename ReadChoice>
std::vector<SceneAttachment> read_attachments(JsonObject& object, const Scene& scene, const char* what,
                                              const ReadChoice& read_choice) {
    if (!object.has("attachments")) return {};
    if (!object.is_array_of_objects("attachments")) return {{read_choice(object, "attachments")}};
    std::vector<SceneAttachment> attachments;
    for (JsonObject& some : object.objects("attachments")) {
        SceneAttachment& attachment = attachments.emplace_back();
        some.require(what);
        some.require("collider");
        attachment.vertices = read_choice(some, what);
        some.read("collider", attachment.collider, numbers_of_colliders(scene));
        some.finish();
    }
    return attachments;
}

/// Handles, each with some particles, a path and a time.
/// @param what, read_choice  as in read_attachments()
/// @pre the solver has been read
template <typename ReadChoice>
std::vector<SceneHandle> read_handles(JsonObject& object, const Scene& scene, const char* what,
                                      const ReadChoice& read_choice) {
    if (scene.simulation.kind() != SolverKind::Newton) object.refuse_keys({"handles"}, "solver", "newton");
    std::vector<SceneHandle> handles;
    for (JsonObject& some : object.objects("handles")) {
        SceneHandle& handle = handles.emplace_back();
        some.require(what);
        handle.vertices = read_choice(some, what);
        handle.keyframes = read_keyframes(some);
        some.read("release", handle.release, kTime);
        some.finish();
    }
    return handles;
}

/// Particles of a sheet, by column and row, that are not pinned yet.
std::vector<std::uint32_t> read_particles(JsonObject& object, const char* key, const ClothOptions& options) {
    std::vector<Counts> places;
    object.read(key, places, {0, 1e6});
    std::vector<std::uint32_t> particles;
    for (const auto& [column, row] : places) {
        if (column >= options.column_count || row >= options.row_count)
            object.refuse(key, "[column, row] of particles that the cloth has");
        const std::uint32_t particle = row * options.column_count + column;
        if (std::find(options.pins.begin(), options.pins.end(), particle) != options.pins.end())
            object.refuse(key, "particles that are not among the pins");
        particles.push_back(particle);
    }
    return particles;
}

void read_sheet(JsonObject& cloth, Scene& scene) {
    for (const char* key : {"rest_mesh", "scale"})
        if (cloth.has(key)) cloth.refuse(key, "left out, or the cloth must have the key \"mesh\"");
    ClothOptions& options = scene.cloth;
    read_sheet_options(cloth, options);
    options.pose = read_pose(cloth);
    options.pins = read_particles(cloth, "pins", options);
    scene.cloth_attachments =
        read_attachments(cloth, scene, "particles", [&](JsonObject& object, const char* key) {
            return read_particles(object, key, options);
        });
    scene.cloth_handles = read_handles(cloth, scene, "particles", [&](JsonObject& object, const char* key) {
        return read_particles(object, key, options);
    });
}

/// An array of numbers, or a box.
VertexChoice read_vertices(JsonObject& cloth, const char* key) {
    if (!cloth.has(key) || cloth.is_array(key)) {
        std::vector<std::uint32_t> numbers;
        cloth.read(key, numbers, {0, 4e9});
        return numbers;
    }
    if (!cloth.is_object(key))
        cloth.refuse(key,
                     "an array of vertex numbers, or a box: an object with its corners \"from\" and \"to\"");
    VertexBox box;
    auto object = cloth.object(key);
    object->require("from");
    object->require("to");
    object->read("from", box.from, kCoordinate);
    object->read("to", box.to, kCoordinate);
    object->finish();
    return box;
}

void read_mesh_cloth(JsonObject& cloth, Scene& scene) {
    for (const char* key : {"size", "particles"})
        if (cloth.has(key)) cloth.refuse(key, "left out where the cloth has the key \"mesh\"");
    MeshCloth& made = scene.mesh_cloth.emplace();
    made.mesh = read_model(cloth, "mesh");
    if (cloth.has("rest_mesh")) made.rest_mesh = read_model(cloth, "rest_mesh");
    made.pose = read_pose(cloth);
    read_mesh_cloth_options(cloth, made);
    ignore(cloth, kOfTheClothBefore, scene);
    made.pins = read_vertices(cloth, "pins");
    scene.cloth_attachments = read_attachments(cloth, scene, "vertices", read_vertices);
    scene.cloth_handles = read_handles(cloth, scene, "vertices", read_vertices);
}

/// @pre the colliders have been read
std::vector<std::uint32_t> read_ignores(JsonObject& object, const Scene& scene) {
    std::vector<std::uint32_t> numbers;
    object.read("ignores", numbers, numbers_of_colliders(scene));
    return numbers;
}

/// Is it a file of tetrahedra? Decided by its extension, as in read_tetrahedra().
bool has_tetrahedra(const SceneModel& model) {
    const auto* file = std::get_if<ModelFile>(&model);
    if (file == nullptr) return false;
    std::string ending = utf8_path(file->name).extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending == ".msh" || ending == ".vtk" || ending == ".node" || ending == ".ele";
}

SceneBody read_body(JsonObject& object, const Scene& scene) {
    SceneBody body;
    object.require("mesh");
    body.mesh = read_model(object, "mesh");
    if (!has_tetrahedra(body.mesh)) {
        object.require("element");
        object.read("element", body.element, kLength);
    } else if (object.has("element")) {
        object.refuse("element", "left out where the mesh is a file of tetrahedra");
    }
    read_body_options(object, body.options);
    body.options.pose = read_pose(object);
    body.velocity = read_velocity(object);
    body.pins = read_vertices(object, "pins");
    body.attachments = read_attachments(object, scene, "vertices", read_vertices);
    body.handles = read_handles(object, scene, "vertices", read_vertices);
    body.ignores = read_ignores(object, scene);
    object.finish();
    return body;
}

void read_bodies(JsonObject& root, Scene& scene) {
    for (JsonObject& object : root.objects("bodies")) scene.bodies.push_back(read_body(object, scene));
    scene.has_cloth = scene.bodies.empty() || root.has("cloth");
}

/// @pre the map, the bodies and the solver have been read
void read_cloth(JsonObject& root, Scene& scene) {
    if (!scene.has_cloth) return;
    root.require("cloth");
    auto cloth = root.object("cloth");
    if (auto* newton = std::get_if<NewtonOptions>(&scene.simulation.solver))
        cloth->read("density", newton->material.density, {1e-6, 1e6});
    else
        cloth->refuse_keys({"density"}, "solver", "newton");
    scene.cloth_velocity = read_velocity(*cloth);
    read_thickness_options(*cloth, scene.simulation);
    scene.cloth_ignores = read_ignores(*cloth, scene);
    if (!std::holds_alternative<ExactMapOptions>(scene.map))
        cloth->refuse_keys({"self_thickness"}, "map.kind", "exact");
    cloth->has("mesh") ? read_mesh_cloth(*cloth, scene) : read_sheet(*cloth, scene);
    cloth->finish();
}

/// @pre the solver and the cloth have been read
void read_material(JsonObject& root, Scene& scene) {
    SimulationOptions& options = scene.simulation;
    auto material = root.object("material");
    if (!material) return;
    if (scene.has_cloth) {
        for (const char* key : {"thickness", "self_thickness"})
            if (material->has(key)) material->refuse(key, "in \"cloth\", where there is one");
    }
    read_thickness_options(*material, options);
    read_jakobsen_options(*material, options);
    read_newton_options(*material, options);
    read_material_options(*material, options);
    if (options.kind() == SolverKind::Newton) ignore(*material, kOfTheMaterial, scene);
    ignore(*material, kOfTheMaterialBefore, scene);
    material->finish();
}

/// The two keys that `collision` has replaced. @param newton  null if a different solver is chosen
void read_former_collision(JsonObject& root, NewtonOptions* newton, Scene& scene) {
    if (!root.has("surface_collision") && !root.has("self_collision")) return;
    bool surfaces = newton != nullptr && newton->collision != CollisionMode::Particles;
    root.read("surface_collision", surfaces);
    bool self = surfaces;
    root.read("self_collision", self);
    if (self && !surfaces) root.refuse("self_collision", "false, or \"surface_collision\" must be true");
    if (surfaces && newton == nullptr)
        root.refuse("surface_collision", "false, or \"solver\" must be \"newton\"");
    if (root.has("collision"))
        root.refuse("collision", "the only key of its kind: leave surface_collision and self_collision out");
    const CollisionMode mode = self       ? CollisionMode::SurfacesAndSelf
                               : surfaces ? CollisionMode::Surfaces
                                          : CollisionMode::Particles;
    if (newton != nullptr) newton->collision = mode;
    const std::string instead =
        std::string("\"collision\": \"") + kModes[static_cast<std::size_t>(mode)] + "\"";
    for (const char* key : {"surface_collision", "self_collision"})
        if (auto warning = root.warn_of_former(key, instead)) scene.warnings.push_back(*std::move(warning));
}

/// @pre the map and the solver have been read
void read_surfaces(JsonObject& root, Scene& scene) {
    const bool is_exact = std::holds_alternative<ExactMapOptions>(scene.map);
    SimulationOptions& options = scene.simulation;
    auto* const newton = std::get_if<NewtonOptions>(&options.solver);
    if (newton != nullptr && !is_exact) newton->collision = CollisionMode::Particles;
    read_former_collision(root, newton, scene);
    if (const auto mode = root.read_word("collision", {kModes.begin(), kModes.end()})) {
        if (newton != nullptr)
            newton->collision = static_cast<CollisionMode>(*mode);
        else if (*mode != 0)
            root.refuse("collision", "\"particles\", or \"solver\" must be \"newton\"");
    }
    const bool surfaces = options.surfaces_collide();
    for (const SceneCollider& collider : scene.colliders)
        if (collider.cache && !surfaces)
            root.refuse(newton == nullptr               ? "solver"
                        : root.has("collision")         ? "collision"
                        : root.has("surface_collision") ? "surface_collision"
                                                        : "map",
                        "set so that surfaces collide, since a collider has a vertex cache");
    bool untangles = false;
    root.read("untangle", untangles);
    if (newton != nullptr) newton->untangle = untangles;
    if (untangles && !surfaces)
        root.refuse("untangle", "false, or \"collision\" must be \"surfaces\" or \"surfaces_and_self\"");
}

/// @pre the bodies have been read
void read_solver(JsonObject& root, Scene& scene) {
    SimulationOptions& options = scene.simulation;
    constexpr std::size_t kJakobsen = 1, kVerlet = 2;
    const std::size_t solver = root.read_word("solver", {"newton", "jakobsen", "verlet", "xpbd"}).value_or(0);
    if (solver == kJakobsen) {
        if (!scene.bodies.empty()) root.refuse("solver", "\"newton\" or left out where there are bodies");
        options.solver = JakobsenOptions{};
        options.time_step = kJakobsenTimeStep;
    }
    if (solver >= kVerlet)
        scene.warnings.push_back(*root.ignore("solver",
                                              "as \"verlet\" and \"xpbd\" no longer exist, and newton is "
                                              "used; write \"newton\", or \"jakobsen\" for the "
                                              "paper's solver"));
    read_solver_options(root, options);
    for (const SceneCollider& collider : scene.colliders)
        if (collider.mass && options.kind() != SolverKind::Newton)
            root.refuse("solver", "\"newton\" or left out where a collider has a mass");
    if (options.kind() == SolverKind::Newton) ignore(root, kOfTheScene, scene);
    ignore(root, kOfTheSceneBefore, scene);
    if (options.wind != Vec3d{}) root.require("wind_rate");
}

/// @pre the colliders and the solver have been read
void read_teleports(JsonObject& root, Scene& scene) {
    if (scene.simulation.kind() != SolverKind::Newton) root.refuse_keys({"teleports"}, "solver", "newton");
    for (JsonObject& object : root.objects("teleports")) {
        Teleport& teleport = scene.teleports.emplace_back();
        object.require("time");
        object.read("time", teleport.time, kTime);
        object.read("displacement", teleport.motion.translation, kCoordinate);
        teleport.motion.rotation = read_rotation(object);
        object.read("colliders", teleport.colliders, numbers_of_colliders(scene));
        object.read("deformable", teleport.deformable);
        object.finish();
        if (!teleport.deformable && teleport.colliders.empty())
            object.refuse("deformable",
                          "true, or \"colliders\" must list some: otherwise nothing is teleported");
    }
}

void read_end(JsonObject& root, Scene& scene) {
    root.read("frame_limit", scene.frame_limit, {1, 1e9});
    auto rest = root.object("at_rest");
    if (!rest) return;
    read_rest_options(*rest, scene.simulation);
    rest->finish();
}

std::string read_text(const fs::path& path) {
    // A scene has a few hundred bytes; a device or a mesh named by mistake is thus refused early.
    constexpr std::size_t kLargest = std::size_t{1} << 20;
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        throw Error(ErrorCode::Unreadable, path.string() + ": is a directory, not a scene");
    std::ifstream file(path, std::ios::binary);
    std::string text(kLargest + 1, '\0');
    if (file) file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file.is_open() || file.bad())
        throw Error(ErrorCode::Unreadable, path.string() + ": cannot be read, or does not exist");
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (text.size() > kLargest)
        throw Error(ErrorCode::InvalidScene, path.string() + ": is larger than 1 MB, the limit for a scene");
    return text;
}

} // namespace

Scene parse_scene(std::string_view text, const std::string& name) {
    const nlohmann::json document = parse_json(text, name);
    JsonObject root(document, name, "");
    Scene scene;
    read_colliders(root, scene);
    if (auto map = root.object("map")) scene.map = read_map(*std::move(map));
    read_bodies(root, scene);
    read_solver(root, scene);
    read_cloth(root, scene);
    read_surfaces(root, scene);
    read_material(root, scene);
    read_teleports(root, scene);
    read_end(root, scene);
    root.finish();
    return scene;
}

MapOptions parse_map_options(std::string_view text, const std::string& name) {
    const nlohmann::json document = parse_json(text, name);
    return read_map(JsonObject(document, name, "map"));
}

Scene read_scene(const fs::path& path) {
    return parse_scene(read_text(path), path.string());
}

} // namespace echinus
