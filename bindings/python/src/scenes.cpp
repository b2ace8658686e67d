#include "arrays.hpp"
#include "colliders.hpp"
#include "interface.hpp"
#include "shared_simulation.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus_scene/scene.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace echinus::python {

namespace {

using Vertices = py::array; // float32, or float64 for a mesh with an origin
using Faces = py::array_t<std::uint32_t>;
using Arrays = std::pair<Vertices, Faces>;

std::optional<std::string> file_of(const SceneModel& model) {
    if (const auto* file = std::get_if<ModelFile>(&model)) return file->name;
    return std::nullopt;
}

std::optional<std::string> cloth_file(const Scene& scene) {
    return scene.mesh_cloth ? file_of(scene.mesh_cloth->mesh) : std::nullopt;
}

std::optional<std::string> rest_file(const Scene& scene) {
    return scene.mesh_cloth && scene.mesh_cloth->rest_mesh ? file_of(*scene.mesh_cloth->rest_mesh)
                                                           : std::nullopt;
}

/// [body_count]
std::vector<std::optional<std::string>> body_files(const Scene& scene) {
    std::vector<std::optional<std::string>> files;
    for (const SceneBody& body : scene.bodies) files.push_back(file_of(body.mesh));
    return files;
}

/// (name, frames per second, animation), or nothing
std::optional<std::tuple<std::string, double, std::string>> cache_file(const Scene& scene,
                                                                       std::size_t collider) {
    const std::optional<CacheFile>& cache = scene.colliders.at(collider).cache;
    if (!cache) return std::nullopt;
    return std::tuple(cache->name, cache->frames_per_second, cache->animation);
}

TriangleMesh shape_of(const ModelFile& file) {
    throw Error(ErrorCode::InvalidScene, "the scene's model is the file " + file.name);
}
TriangleMesh shape_of(const auto& shape) {
    return make_mesh(shape);
}

/// The mesh of a generated model.
py::tuple make_model(const Scene& scene, std::size_t collider) {
    return arrays_of(
        std::visit([](const auto& model) { return shape_of(model); }, scene.colliders.at(collider).model));
}

py::tuple repair_model(const Scene& scene, std::size_t collider, const Vertices& vertices,
                       const Faces& faces) {
    const TriangleMesh mesh = mesh_of(vertices, faces);
    return arrays_of(unlocked([&] { return repair(mesh, scene.colliders.at(collider).repair).mesh; }));
}

ColliderMap build_model_map(const Scene& scene, const Vertices& vertices, const Faces& faces, int threads) {
    const unsigned workers = thread_count(threads);
    const TriangleMesh mesh = mesh_of(vertices, faces);
    return unlocked([&] { return make_collider_map(scene, mesh, workers); });
}

/// The tetrahedra of a body from a file: those in it, or those that fill its surface.
TetrahedralMesh read_body(const SceneBody& body, const std::filesystem::path& path) {
    if (body.element == 0) return read_tetrahedra(path).mesh;
    return fill_body(body, read_mesh(path));
}

/// The simulation of a scene, from the contents of its files. They are None if the scene does not name a
/// file, and for colliders without a cache.
std::unique_ptr<SharedSimulation>
simulation_of_scene(const Scene& scene, const std::vector<ColliderMap>& maps,
                    const std::vector<std::optional<VertexCache>>& model_caches,
                    const std::optional<Arrays>& cloth, const std::optional<Arrays>& rest,
                    std::vector<std::array<std::uint32_t, 2>> threads,
                    const std::vector<std::optional<std::filesystem::path>>& bodies) {
    const auto mesh = [](const std::optional<Arrays>& arrays) {
        return arrays ? mesh_of(arrays->first, arrays->second) : TriangleMesh{};
    };
    ClothMeshes meshes{.mesh = mesh(cloth), .rest_mesh = mesh(rest), .threads = std::move(threads)};
    std::vector<VertexCache> caches;
    for (const std::optional<VertexCache>& cache : model_caches)
        caches.push_back(cache.value_or(VertexCache{}));
    return unlocked([&] {
        for (std::size_t i = 0; i < bodies.size(); ++i)
            meshes.bodies.push_back(bodies[i] ? read_body(scene.bodies.at(i), *bodies[i])
                                              : TetrahedralMesh{});
        return std::make_unique<SharedSimulation>(make_simulation(scene, maps, meshes, caches));
    });
}

constexpr std::array kCollisionModes{"particles", "surfaces", "surfaces_and_self"};

/// @param mode  one of kCollisionModes; if only particles collide, nothing is untangled
void choose_collision(Scene& scene, const std::string& mode) {
    const auto found = std::find(kCollisionModes.begin(), kCollisionModes.end(), std::string_view(mode));
    auto* const newton = std::get_if<NewtonOptions>(&scene.simulation.solver);
    const auto chosen = static_cast<CollisionMode>(found - kCollisionModes.begin());
    if (newton == nullptr && chosen != CollisionMode::Particles)
        throw Error(
            ErrorCode::InvalidOptions,
            "collision is '" + mode +
                "', and with the scene's jakobsen solver only particles collide; leave it out, or set "
                "\"solver\": \"newton\" in the scene");
    if (newton == nullptr) return;
    newton->collision = chosen;
    newton->untangle = newton->untangle && scene.simulation.surfaces_collide();
}

void bind_options(py::class_<Scene>& scene) {
    scene
        .def_property_readonly("surfaces_collide",
                               [](const Scene& s) { return s.simulation.surfaces_collide(); })
        .def("choose_collision", choose_collision)
        .def("choose_untangle",
             [](Scene& s, bool on) {
                 if (on && !s.simulation.surfaces_collide())
                     throw Error(ErrorCode::InvalidOptions,
                                 "untangle is True, and needs the collision of surfaces");
                 if (auto* newton = std::get_if<NewtonOptions>(&s.simulation.solver)) newton->untangle = on;
             })
        .def_property(
            "allow_open_colliders", [](const Scene& s) { return s.simulation.allow_open_colliders; },
            [](Scene& s, bool on) { s.simulation.allow_open_colliders = on; });
}

} // namespace

void bind_scenes(py::module_& module) {
    py::class_<ColliderMap>(module, "ColliderMap").def(py::init([](const py::object& map) {
        return ColliderMap(map_of(map));
    }));
    py::class_<Scene> scene(module, "Scene");
    scene.def_static("read", [](const std::filesystem::path& path) { return read_scene(path); })
        .def_static("parse",
                    [](const std::string& json, const std::string& name) { return parse_scene(json, name); })
        .def_property_readonly("collider_count", [](const Scene& s) { return s.colliders.size(); })
        .def("model_file",
             [](const Scene& s, std::size_t collider) { return file_of(s.colliders.at(collider).model); })
        .def("cache_file", cache_file)
        .def_property_readonly("cloth_file", cloth_file)
        .def_property_readonly("rest_file", rest_file)
        .def_property_readonly("body_files", body_files)
        .def_readonly("frame_limit", &Scene::frame_limit)
        .def_readonly("warnings", &Scene::warnings)
        .def("make_model", make_model)
        .def("repair", repair_model)
        .def("build_map", build_model_map)
        .def("simulate", simulation_of_scene);
    bind_options(scene);
    module.def("find_model", [](const std::string& name, const std::vector<std::filesystem::path>& folders) {
        return find_model({name}, folders);
    });
    module.def("find_cache", [](const std::string& name, const std::vector<std::filesystem::path>& folders) {
        return find_cache({.name = name}, folders);
    });
}

} // namespace echinus::python
