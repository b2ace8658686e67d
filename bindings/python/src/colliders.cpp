#include "colliders.hpp"

#include "arrays.hpp"
#include "interface.hpp"

#include <echinus/mesh_io.hpp>

#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

namespace echinus::python {

Collider collider_of(const ColliderArguments& arguments) {
    const auto& [map, position, rotation, scale, linear, angular, name] = arguments;
    return {.map = map_of(map),
            .pose = pose_of(position, rotation),
            .scale = vector_of(scale),
            .linear_velocity = vector_of(linear),
            .angular_velocity = vector_of(angular),
            .name = name};
}

AnyMap map_of(const py::object& map) {
    if (py::isinstance<ExactMap>(map)) return map.cast<const ExactMap&>();
    return map.cast<const DistanceMap&>();
}

std::vector<PoseKey> keys_of(const std::vector<KeyArguments>& keys) {
    std::vector<PoseKey> result;
    for (const auto& [time, position, rotation] : keys) result.push_back({time, pose_of(position, rotation)});
    return result;
}

namespace {

using Samples = py::array_t<float>;

/// @param samples  [sample_count, vertex_count, 3]
VertexCache cache_of(const py::object& samples, double start_time, double sample_seconds) {
    const Points points(samples, "samples");
    if (points.shape().size() != 2 || points.size() == 0)
        throw py::value_error(
            "samples must have the shape (samples, vertices, 3), with at least one of each");
    if (!std::isfinite(start_time) || !std::isfinite(sample_seconds) || !(sample_seconds > 0))
        throw py::value_error("start_time and sample_seconds must be finite, and sample_seconds positive");
    std::vector<Vec3f> copy(points.size());
    const auto vertex_count = static_cast<std::size_t>(points.shape()[1]);
    for (std::size_t i = 0; i < copy.size(); ++i) {
        copy[i] = points.span()[i];
        if (!is_finite(copy[i]))
            throw py::value_error("samples must be finite; vertex " + std::to_string(i % vertex_count) +
                                  " of sample " + std::to_string(i / vertex_count) + " is not");
    }
    return {.start_time = start_time,
            .sample_seconds = sample_seconds,
            .vertex_count = vertex_count,
            .samples = std::make_shared<const std::vector<Vec3f>>(std::move(copy))};
}

py::array samples_of(const py::object& self) {
    const auto& cache = self.cast<const VertexCache&>();
    Samples view({static_cast<py::ssize_t>(cache.sample_count()),
                  static_cast<py::ssize_t>(cache.vertex_count), py::ssize_t{3}},
                 reinterpret_cast<const float*>(cache.samples->data()), self);
    view.attr("setflags")(false);
    return view;
}

py::array sampled(const VertexCache& cache, double seconds) {
    if (!std::isfinite(seconds)) throw py::value_error("seconds must be finite");
    const std::vector<Vec3f> places = unlocked([&] { return vertices_at(cache, seconds); });
    py::array_t<float> result({static_cast<py::ssize_t>(places.size()), py::ssize_t{3}});
    std::memcpy(result.mutable_data(), places.data(), places.size() * sizeof(Vec3f));
    return result;
}

/// Checks the preconditions of pose_at(); a simulation makes these checks by itself.
void require_valid(const std::vector<PoseKey>& keys) {
    constexpr double kTolerance = 1e-4;
    if (keys.empty()) throw py::value_error("there is no key");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto& [time, pose] = keys[i];
        const auto& [w, x, y, z] = pose.rotation;
        const std::string name = "key " + std::to_string(i);
        if (!std::isfinite(time) || (i > 0 && !(time > keys[i - 1].time)))
            throw py::value_error(name + ": times must be finite and ascend");
        if (!is_finite(pose.translation) ||
            !(std::abs(std::sqrt(w * w + x * x + y * y + z * z) - 1) <= kTolerance))
            throw py::value_error(name + ": the position must be finite, and the rotation of length 1");
    }
}

/// (position, rotation)
py::tuple sampled_pose(const std::vector<KeyArguments>& arguments, double seconds) {
    const std::vector<PoseKey> keys = keys_of(arguments);
    require_valid(keys);
    if (!std::isfinite(seconds)) throw py::value_error("seconds must be finite");
    const RigidTransform pose = pose_at(keys, seconds);
    return py::make_tuple(to_python(pose.translation), to_python(pose.rotation));
}

} // namespace

void bind_colliders(py::module_& module) {
    py::class_<VertexCache>(module, "VertexCache")
        .def(py::init(&cache_of))
        .def_static("read",
                    [](const std::filesystem::path& path, const py::array& vertices,
                       const py::array_t<std::uint32_t>& faces, double frames_per_second,
                       const std::string& animation) {
                        if (!std::isfinite(frames_per_second) || !(frames_per_second > 0))
                            throw py::value_error("frames_per_second must be positive and finite");
                        const TriangleMesh mesh = mesh_of(vertices, faces);
                        return unlocked(
                            [&] { return read_vertex_cache(path, mesh, frames_per_second, animation); });
                    })
        .def_readonly("start_time", &VertexCache::start_time)
        .def_readonly("sample_seconds", &VertexCache::sample_seconds)
        .def_property_readonly("end_time", &VertexCache::end_time)
        .def_property_readonly("samples", samples_of)
        .def("at", sampled);
    module.def("pose_at", sampled_pose);
    module.def("rotation_about", [](const Vector& axis, double angle_rad) {
        const Vec3d about = finite_vector_of(axis, "axis");
        if (about == Vec3d{} || !std::isfinite(angle_rad))
            throw py::value_error("axis must not be zero, and angle_rad finite");
        return to_python(Rotation::about(about, angle_rad));
    });
}

} // namespace echinus::python
