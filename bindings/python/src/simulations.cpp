#include "arrays.hpp"
#include "colliders.hpp"
#include "interface.hpp"
#include "options.hpp"
#include "shared_simulation.hpp"
#include "values.hpp"

#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace echinus::python {

namespace {

std::unique_ptr<SharedSimulation> simulation_of(const Deformable& deformable,
                                                const std::vector<ColliderArguments>& arguments,
                                                const py::dict& option_values) {
    const SimulationOptions options = options_of<SimulationOptions>(option_values);
    std::vector<Collider> colliders;
    for (const ColliderArguments& collider : arguments) colliders.push_back(collider_of(collider));
    return unlocked([&] {
        return std::make_unique<SharedSimulation>(Simulation(deformable, std::move(colliders), options));
    });
}

// ---- Simulations

/// Ctrl-C ends the loop between two frames.
void step(SharedSimulation& simulation, std::uint32_t frame_count) {
    for (std::uint32_t i = 0; i < frame_count; ++i) {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        simulation.change([](Simulation& s) { s.step(); });
    }
}

py::bytes save_state(SharedSimulation& shared) {
    const std::vector<std::byte> state = shared.alone([](Simulation& s) { return s.save_state(); });
    return {reinterpret_cast<const char*>(state.data()), state.size()};
}

/// Restores a copy: in place, views of the positions would become invalid.
std::unique_ptr<SharedSimulation> restored(SharedSimulation& shared, const py::bytes& state) {
    const std::string_view text = state;
    const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(text.data()), text.size());
    Simulation copy = shared.alone([](Simulation& s) { return s; });
    unlocked([&] { copy.restore_state(bytes); });
    return std::make_unique<SharedSimulation>(std::move(copy));
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
    result["measured_pair_count"] = p.measured_pair_count;
    result["unresolved_count"] = p.unresolved_count;
    return result;
}

py::dict describe(const Collider& collider) {
    py::dict result;
    result["position"] = to_python(collider.pose.translation);
    result["rotation"] = to_python(collider.pose.rotation);
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

std::size_t collider_at(const SharedSimulation& shared, std::int64_t index) {
    return index_below(shared.unchanging().colliders().size(), index, "collider");
}

/// (force, torque)
py::tuple load_on(SharedSimulation& shared, std::int64_t index) {
    const std::size_t collider = collider_at(shared, index);
    const Load load = shared.alone([&](Simulation& s) { return s.load_on(collider); });
    return py::make_tuple(to_python(load.force), to_python(load.torque));
}

/// [contact]: positions, normals, gaps, impulses, colliders, particles. Absent indices are -1.
py::tuple contact_points(SharedSimulation& shared) {
    const auto points = shared.alone([](Simulation& s) {
        return std::vector<ContactPoint>(s.contact_points().begin(), s.contact_points().end());
    });
    const auto count = static_cast<py::ssize_t>(points.size());
    py::array_t<double> positions({count, py::ssize_t{3}}), normals({count, py::ssize_t{3}}), gaps(count),
        normal_impulses(count), friction_impulses({count, py::ssize_t{3}});
    py::array_t<std::int64_t> colliders(count), particles({count, py::ssize_t{4}});
    const auto number = [](std::uint32_t n) { return n == kNoIndex ? std::int64_t{-1} : std::int64_t{n}; };
    for (py::ssize_t i = 0; i < count; ++i) {
        const ContactPoint& point = points[static_cast<std::size_t>(i)];
        const auto put = [&](py::array_t<double>& array, const Vec3d& v) {
            array.mutable_at(i, 0) = v.x;
            array.mutable_at(i, 1) = v.y;
            array.mutable_at(i, 2) = v.z;
        };
        put(positions, point.position);
        put(normals, point.normal);
        put(friction_impulses, point.friction_impulse);
        gaps.mutable_at(i) = point.gap;
        normal_impulses.mutable_at(i) = point.normal_impulse;
        colliders.mutable_at(i) = number(point.collider);
        for (py::ssize_t k = 0; k < 4; ++k)
            particles.mutable_at(i, k) = number(point.particles[static_cast<std::size_t>(k)]);
    }
    return py::make_tuple(positions, normals, gaps, normal_impulses, friction_impulses, colliders, particles);
}

void bind_colliders_of(py::class_<SharedSimulation>& simulation) {
    simulation
        .def("set_collider_velocity",
             [](SharedSimulation& shared, std::int64_t index, const Vector& linear, const Vector& angular) {
                 const std::size_t collider = collider_at(shared, index);
                 const Vec3d l = finite_vector_of(linear, "linear"), a = finite_vector_of(angular, "angular");
                 shared.change([&](Simulation& s) { s.set_collider_velocity(collider, l, a); });
             })
        .def("set_collider_pose",
             [](SharedSimulation& shared, std::int64_t index, const Vector& position,
                const Quaternion& rotation) {
                 const std::size_t collider = collider_at(shared, index);
                 shared.change(
                     [&](Simulation& s) { s.set_collider_pose(collider, pose_of(position, rotation)); });
             })
        .def("set_collider_keyframes",
             [](SharedSimulation& shared, std::int64_t index, const std::vector<KeyArguments>& keys) {
                 const std::size_t collider = collider_at(shared, index);
                 shared.change([&](Simulation& s) { s.set_collider_keyframes(collider, keys_of(keys)); });
             })
        .def("set_collider_vertices",
             [](SharedSimulation& shared, std::int64_t index, const py::array_t<float>& vertices) {
                 const std::size_t collider = collider_at(shared, index);
                 const std::span<const Vec3f> places(reinterpret_cast<const Vec3f*>(vertices.data()),
                                                     static_cast<std::size_t>(vertices.shape(0)));
                 shared.change([&](Simulation& s) { s.set_collider_vertices(collider, places); });
             })
        .def("set_collider_cache",
             [](SharedSimulation& shared, std::int64_t index, const VertexCache& cache) {
                 const std::size_t collider = collider_at(shared, index);
                 shared.change([&](Simulation& s) { s.set_collider_cache(collider, cache); });
             })
        .def("set_collider_free",
             [](SharedSimulation& shared, std::int64_t index, double mass) {
                 const std::size_t collider = collider_at(shared, index);
                 shared.change([&](Simulation& s) { s.set_collider_free(collider, mass); });
             })
        .def("load_on", load_on)
        .def("record_contacts",
             [](SharedSimulation& shared, bool is_on) {
                 shared.change([&](Simulation& s) { s.record_contacts(is_on); });
             })
        .def("contact_points", contact_points);
}

void bind_hands(py::class_<SharedSimulation>& simulation) {
    simulation
        .def("set_particle_velocity",
             [](SharedSimulation& shared, std::int64_t index, const Vector& velocity) {
                 const std::size_t particle =
                     index_below(shared.unchanging().positions().size(), index, "particle");
                 const Vec3d v = finite_vector_of(velocity, "velocity");
                 shared.change([&](Simulation& s) { s.set_particle_velocity(particle, v); });
             })
        .def("blow", [](SharedSimulation& shared, const Vector& wind, double rate) {
            if (!(rate >= 0) || !std::isfinite(rate))
                throw py::value_error("rate must be 0 or more, and finite");
            const Vec3d w = finite_vector_of(wind, "wind");
            shared.change([&](Simulation& s) { s.blow(w, rate); });
        });
}

} // namespace

void bind_simulations(py::module_& module) {
    module.def("option_defaults", [] {
        py::dict structs;
        for_each_struct([&](const char* name, const auto& o) { structs[name] = describe_options(o); });
        return structs;
    });
    py::class_<SharedSimulation> simulation(module, "Simulation");
    simulation.def(py::init(&simulation_of))
        .def("step", step)
        .def("copy",
             [](SharedSimulation& shared) {
                 return std::make_unique<SharedSimulation>(shared.alone([](Simulation& s) { return s; }));
             })
        .def("save_state", save_state)
        .def("restored", restored)
        .def("describe_colliders", describe_colliders)
        // Steps write into the same arrays, so views of them stay valid.
        .def_property_readonly("positions",
                               [](const py::object& self) {
                                   return view_of(self.cast<SharedSimulation&>().unchanging().positions(),
                                                  self);
                               })
        .def_property_readonly(
            "velocities",
            [](const py::object& self) {
                return view_of(self.cast<SharedSimulation&>().unchanging().deformable().velocities, self);
            })
        .def_property_readonly("faces",
                               [](const py::object& self) {
                                   return view_of(
                                       self.cast<SharedSimulation&>().unchanging().deformable().faces, self);
                               })
        .def_property_readonly(
            "tetrahedra",
            [](const py::object& self) {
                return view_of(self.cast<SharedSimulation&>().unchanging().deformable().tetrahedra, self);
            })
        .def_property_readonly(
            "options", [](const SharedSimulation& s) { return describe_options(s.unchanging().options()); })
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
        .def("residual",
             [](SharedSimulation& shared) {
                 const Residual residual = shared.alone([](Simulation& s) { return s.residual(); });
                 return std::pair(residual.root_mean_square, residual.largest);
             })
        .def_property_readonly("largest_speed",
                               [](SharedSimulation& shared) {
                                   return shared.alone([](Simulation& s) { return s.largest_speed(); });
                               })
        .def_property_readonly("state_hash", [](SharedSimulation& shared) {
            return shared.alone([](Simulation& s) { return s.state_hash(); });
        });
    bind_colliders_of(simulation);
    bind_hands(simulation);
}

} // namespace echinus::python
