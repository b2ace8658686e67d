#include "interface.hpp"

#include <echinus/error.hpp>
#include <echinus/scene.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <optional>

namespace echinus::python {

namespace {

using Vertices = py::array_t<float>;
using Faces = py::array_t<std::uint32_t>;
using Arrays = std::pair<Vertices, Faces>;
using Vector = std::array<double, 3>;

/// A simulation that several threads may call: one at a time computes, without Python's lock.
class SharedSimulation {
  public:
    explicit SharedSimulation(Simulation simulation) : simulation_(std::move(simulation)) {}

    /// Calls work(simulation) alone.
    template <typename Work>
    auto alone(const Work& work) {
        // Python's lock first: a thread that waited for the mutex with it would stop the one that computes.
        const py::gil_scoped_release released;
        const std::lock_guard guard(mutex_);
        return work(simulation_);
    }
    /// The same for work that goes on with the simulation, which is not possible once it has diverged.
    template <typename Work>
    void change(const Work& work) {
        alone([&](Simulation& simulation) {
            if (diverged_)
                throw Error(ErrorCode::Diverged, "the simulation has diverged; it can only be read");
            try {
                work(simulation);
            } catch (const Error& error) {
                diverged_ = error.code() == ErrorCode::Diverged;
                throw;
            }
        });
    }
    /// For what no step changes: options, faces, and where the positions lie.
    const Simulation& unchanging() const { return simulation_; }

  private:
    std::mutex mutex_;
    Simulation simulation_;
    bool diverged_ = false;
};

Vec3d vector_of(const Vector& v, const char* name) {
    for (const double c : v)
        if (!std::isfinite(c)) throw py::value_error(std::string(name) + " must be finite");
    return {v[0], v[1], v[2]};
}
py::tuple to_python(const Vec3d& v) {
    return py::make_tuple(v.x, v.y, v.z);
}

// ---- Scenes

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

TriangleMesh shape_of(const ModelFile& file) {
    throw Error(ErrorCode::InvalidScene, "the scene's model is the file " + file.name);
}
TriangleMesh shape_of(const auto& shape) {
    return make_mesh(shape);
}

/// The mesh of the scene's generated model.
py::tuple make_model(const Scene& scene) {
    return arrays_of(
        std::visit([](const auto& model) { return shape_of(model); }, scene.colliders.front().model));
}

py::tuple repair_model(const Scene& scene, const Vertices& vertices, const Faces& faces) {
    return arrays_of(repair(mesh_of(vertices, faces), scene.colliders.front().repair).mesh);
}

AnyMap build_model_map(const Scene& scene, const Vertices& vertices, const Faces& faces, int threads) {
    const unsigned workers = thread_count(threads);
    const TriangleMesh mesh = mesh_of(vertices, faces);
    const py::gil_scoped_release unlocked;
    return build_map(mesh, scene.map, workers);
}

void bind_scene(py::module_& module) {
    py::class_<Scene>(module, "Scene")
        .def_static("read", [](const std::filesystem::path& path) { return read_scene(path); })
        .def_static("parse",
                    [](const std::string& json, const std::string& name) { return parse_scene(json, name); })
        .def_property_readonly("model_file",
                               [](const Scene& scene) { return file_of(scene.colliders.front().model); })
        .def_property_readonly("cloth_file", cloth_file)
        .def_property_readonly("rest_file", rest_file)
        .def_readonly("frame_limit", &Scene::frame_limit)
        .def_property(
            "surface_collision", [](const Scene& scene) { return scene.simulation.surface_collision; },
            [](Scene& scene, bool on) { scene.simulation.surface_collision = on; })
        .def_property(
            "self_collision", [](const Scene& scene) { return scene.simulation.self_collision; },
            [](Scene& scene, bool on) { scene.simulation.self_collision = on; })
        .def_property(
            "untangle", [](const Scene& scene) { return scene.simulation.untangle; },
            [](Scene& scene, bool on) { scene.simulation.untangle = on; })
        .def_property(
            "allow_open_colliders", [](const Scene& scene) { return scene.simulation.allow_open_colliders; },
            [](Scene& scene, bool on) { scene.simulation.allow_open_colliders = on; })
        .def("make_model", make_model)
        .def("repair", repair_model)
        .def("build_map", build_model_map);
    module.def("find_model", [](const std::string& name, const std::vector<std::filesystem::path>& folders) {
        return find_model({name}, folders);
    });
}

// ---- Simulations

AnyMap map_of(const py::object& map) {
    if (py::isinstance<ExactMap>(map)) return map.cast<const ExactMap&>();
    return map.cast<const DistanceMap&>();
}

std::unique_ptr<SharedSimulation> make_shared_simulation(const Scene& scene, const py::object& model_map,
                                                         const std::optional<Arrays>& cloth,
                                                         const std::optional<Arrays>& rest,
                                                         std::vector<std::array<std::uint32_t, 2>> threads) {
    const auto mesh = [](const std::optional<Arrays>& arrays) {
        return arrays ? mesh_of(arrays->first, arrays->second) : TriangleMesh{};
    };
    const ClothMeshes meshes{mesh(cloth), mesh(rest), std::move(threads)};
    const AnyMap map = map_of(model_map);
    const py::gil_scoped_release unlocked;
    return std::make_unique<SharedSimulation>(make_simulation(scene, map, meshes));
}

/// Ctrl-C ends it between two frames.
void step(SharedSimulation& simulation, std::uint32_t frame_count) {
    for (std::uint32_t i = 0; i < frame_count; ++i) {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        simulation.change([](Simulation& s) { s.step(); });
    }
}

py::dict describe(const SimulationProfile& p) {
    py::dict result;
    result["integration_seconds"] = p.integration_seconds;
    result["constraint_seconds"] = p.constraint_seconds;
    result["collision_seconds"] = p.collision_seconds;
    result["query_count"] = p.query_count;
    result["contact_count"] = p.contact_count;
    result["map_query_count"] = p.map_query_count;
    result["rescued_count"] = p.rescued_count;
    result["lost_count"] = p.lost_count;
    result["truncated_count"] = p.truncated_count;
    result["searched_face_count"] = p.searched_face_count;
    result["measured_pair_count"] = p.measured_pair_count;
    result["squeezed_count"] = p.squeezed_count;
    return result;
}

py::dict describe(const SimulationOptions& o) {
    py::dict result;
    result["solver"] = o.solver == SolverKind::Verlet ? "verlet" : "xpbd";
    result["time_step"] = o.time_step;
    result["iteration_count"] = o.iteration_count;
    result["substep_count"] = o.substep_count;
    result["gravity"] = to_python(o.gravity);
    result["drag"] = o.drag;
    result["friction"] = o.friction;
    result["thickness"] = o.thickness;
    result["self_thickness"] = o.self_thickness;
    result["surface_collision"] = o.surface_collision;
    result["self_collision"] = o.self_collision;
    result["untangle"] = o.untangle;
    result["allow_open_colliders"] = o.allow_open_colliders;
    return result;
}

py::dict describe(const Collider& collider) {
    const Rotation& r = collider.pose.rotation;
    py::dict result;
    result["position"] = to_python(collider.pose.translation);
    result["rotation"] = py::make_tuple(r.w, r.x, r.y, r.z);
    result["scale"] = to_python(collider.scale);
    result["linear_velocity"] = to_python(collider.linear_velocity);
    result["angular_velocity"] = to_python(collider.angular_velocity);
    return result;
}

py::list describe_colliders(SharedSimulation& simulation) {
    py::list result;
    for (const Collider& collider : simulation.alone([](Simulation& s) { return s.colliders(); }))
        result.append(describe(collider));
    return result;
}

void require_below(std::size_t index, std::size_t count, const char* what) {
    if (index >= count)
        throw py::index_error("there is no " + std::string(what) + " " + std::to_string(index) +
                              "; there are " + std::to_string(count));
}

void bind_motion(py::class_<SharedSimulation>& simulation) {
    simulation
        .def("set_collider_velocity",
             [](SharedSimulation& shared, std::size_t index, const Vector& linear, const Vector& angular) {
                 require_below(index, shared.unchanging().colliders().size(), "collider");
                 const Vec3d l = vector_of(linear, "linear"), a = vector_of(angular, "angular");
                 shared.change([&](Simulation& s) { s.set_collider_velocity(index, l, a); });
             })
        .def("set_particle_velocity",
             [](SharedSimulation& shared, std::size_t particle, const Vector& velocity) {
                 require_below(particle, shared.unchanging().positions().size(), "particle");
                 const Vec3d v = vector_of(velocity, "velocity");
                 shared.change([&](Simulation& s) { s.set_particle_velocity(particle, v); });
             })
        .def("blow", [](SharedSimulation& shared, const Vector& wind, double rate) {
            if (!(rate >= 0) || !std::isfinite(rate))
                throw py::value_error("rate must be 0 or more, and finite");
            const Vec3d w = vector_of(wind, "wind");
            shared.change([&](Simulation& s) { s.blow(w, rate); });
        });
}

} // namespace

void bind_simulations(py::module_& module) {
    bind_scene(module);
    py::class_<SharedSimulation> simulation(module, "Simulation");
    simulation.def(py::init(&make_shared_simulation))
        .def("step", step)
        .def("copy",
             [](SharedSimulation& shared) {
                 return std::make_unique<SharedSimulation>(shared.alone([](Simulation& s) { return s; }));
             })
        .def("describe_colliders", describe_colliders)
        // Steps write into the same arrays, so views of them stay valid.
        .def_property_readonly("positions",
                               [](const py::object& self) {
                                   return view_of(self.cast<SharedSimulation&>().unchanging().positions(),
                                                  self);
                               })
        .def_property_readonly(
            "previous_positions",
            [](const py::object& self) {
                return view_of(self.cast<SharedSimulation&>().unchanging().deformable().previous_positions,
                               self);
            })
        .def_property_readonly("faces",
                               [](const py::object& self) {
                                   return view_of(
                                       self.cast<SharedSimulation&>().unchanging().deformable().faces, self);
                               })
        .def_property_readonly("options",
                               [](const SharedSimulation& s) { return describe(s.unchanging().options()); })
        .def_property_readonly("profile",
                               [](SharedSimulation& shared) {
                                   return describe(shared.alone([](Simulation& s) { return s.profile(); }));
                               })
        .def_property_readonly(
            "frame",
            [](SharedSimulation& shared) { return shared.alone([](Simulation& s) { return s.frame(); }); })
        .def_property_readonly(
            "at_rest",
            [](SharedSimulation& shared) { return shared.alone([](Simulation& s) { return s.at_rest(); }); })
        .def_property_readonly("largest_speed",
                               [](SharedSimulation& shared) {
                                   return shared.alone([](Simulation& s) { return s.largest_speed(); });
                               })
        .def_property_readonly("state_hash", [](SharedSimulation& shared) {
            return shared.alone([](Simulation& s) { return s.state_hash(); });
        });
    bind_motion(simulation);
}

} // namespace echinus::python
