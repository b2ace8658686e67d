// The Python module echinus_bench: what measure.py and systems.py take from C++. Arrays of answers belong to
// the caller.

#include "arrays.hpp"
#include "compare/turns.hpp"
#include "console/machine.hpp"
#include "rivals/unshipped/unshipped.hpp"
#include "systems.hpp"
#include "truth.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

using namespace echinus;
using namespace echinus::comparison;
using echinus::python::Points;

namespace {

namespace py = pybind11;

using Vertices = py::array_t<float>;
using Faces = py::array_t<std::uint32_t>;
using Flags = py::array_t<bool, py::array::c_style>;
using Lengths = py::array_t<float, py::array::c_style>;

/// Of a Python array that is contiguous, as all arrays here are.
std::span<const Vec3f> span_of(const Points& points) {
    return {&points.span()[0], points.size()};
}

std::span<std::uint8_t> span_of(Flags& flags) {
    return {reinterpret_cast<std::uint8_t*>(flags.mutable_data()), static_cast<std::size_t>(flags.size())};
}

std::span<float> span_of(Lengths& lengths) {
    return {lengths.mutable_data(), static_cast<std::size_t>(lengths.size())};
}

Subject subject_of(const Vertices& vertices, const Faces& faces, std::string name) {
    const auto corners = python::face_array(faces);
    TriangleMesh mesh = python::mesh_of(python::vertex_array(vertices, corners), corners);
    const double radius = inspect(mesh).bounding_sphere.radius;
    return {std::move(name), std::move(mesh), radius, false, test::Axis::Z};
}

/// Another library around a mesh.
class Rival {
  public:
    Rival(std::string name, TimedBuild build) : name_(std::move(name)), build_(std::move(build)) {}

    const std::string& name() const { return name_; }
    double build_ms() const { return build_.ms; }
    std::size_t byte_count() const { return build_.system->byte_count(); }

    void contains(const py::object& points, Flags inside) const {
        build_.system->contains_batch(span_of(Points(points, "points")), span_of(inside));
    }

    /// A rival has no other way than a contact for every point.
    void signed_distance(const py::object& points, Lengths distances) {
        const Points taken(points, "points");
        contacts_.resize(taken.size());
        build_.system->contacts_batch(span_of(taken), std::numeric_limits<float>::infinity(), contacts_);
        const std::span<float> answers = span_of(distances);
        for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = -contacts_[i].depth;
    }

  private:
    std::string name_;
    TimedBuild build_;
    std::vector<Contact> contacts_;
};

std::vector<Rival> rivals_of(const Vertices& vertices, const Faces& faces) {
    const Subject subject = subject_of(vertices, faces, "");
    std::vector<Rival> result;
    for (const BenchSystem& library : labelling_libraries(subject.mesh))
        result.emplace_back(library.name, build_timed(library.builder));
    return result;
}

/// The exact map as a program in C++ asks it, in calls of some size, into arrays that it keeps.
class NativeMap {
  public:
    NativeMap(const Vertices& vertices, const Faces& faces)
        : map_(ExactMap::build(subject_of(vertices, faces, "").mesh, {.thread_count = 1})) {}

    void ask(const std::string& query, const py::object& points, std::size_t call_size) {
        const Points taken(points, "points");
        const std::span<const Vec3f> all = span_of(taken);
        if (inside_.size() < all.size()) {
            inside_.resize(all.size());
            contacts_.resize(all.size());
            distances_.resize(all.size());
        }
        for (std::size_t begin = 0; begin < all.size(); begin += call_size) {
            const std::size_t count = std::min(call_size, all.size() - begin);
            const auto part = all.subspan(begin, count);
            if (query == "contains")
                contains_batch(map_.view(), part, std::span(inside_).subspan(begin, count));
            else if (query == "contacts")
                contacts_batch(map_.view(), part, 0, std::span(contacts_).subspan(begin, count));
            else
                signed_distance_batch(map_.view(), part, std::span(distances_).subspan(begin, count));
        }
    }

  private:
    ExactMap map_;
    std::vector<std::uint8_t> inside_;
    std::vector<Contact> contacts_;
    std::vector<float> distances_;
};

/// Brute force over all faces, in double.
void contains_by_winding_number(const Vertices& vertices, const Faces& faces, const py::object& points,
                                Flags inside) {
    const TriangleMesh mesh = python::mesh_of(vertices, faces);
    const Points taken(points, "points");
    const std::span<std::uint8_t> answers = span_of(inside);
    for (std::size_t i = 0; i < answers.size(); ++i)
        answers[i] = winding_number(mesh, Vec3d(taken.span()[i])) > 0.5 ? 1 : 0;
}

py::array point_set(const Vertices& vertices, const Faces& faces, const std::string& name,
                    std::size_t count) {
    const TriangleMesh mesh = python::mesh_of(vertices, faces);
    const std::vector<Vec3f> points =
        name == "U" ? test::uniform_points(mesh, count) : test::surface_points(mesh, count);
    return py::array_t<float>({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}},
                              reinterpret_cast<const float*>(points.data())); // a copy
}

/// (inside, distance) of each point.
py::tuple judged(const std::string& name, const Vertices& vertices, const Faces& faces,
                 const std::string& set_name, const py::object& points, bool by_winding_number,
                 const std::filesystem::path& cache) {
    const Subject subject = subject_of(vertices, faces, name);
    const Points taken(points, "points");
    const std::span<const Vec3f> all = span_of(taken);
    JudgedSet set{set_name, {all.begin(), all.end()}, {}};
    judge(subject, cache, set, by_winding_number ? SideJudge::WindingNumber : SideJudge::Parity);
    const auto count = static_cast<py::ssize_t>(all.size());
    Flags inside(count);
    Lengths distances(count);
    std::ranges::copy(set.truth.inside, span_of(inside).begin());
    std::ranges::copy(set.truth.distance, span_of(distances).begin());
    return py::make_tuple(inside, distances);
}

using PyParts = std::vector<std::pair<std::size_t, std::size_t>>;
using PyRacer = std::function<void(std::size_t begin, std::size_t end)>;

std::function<void(Part)> as_run(const PyRacer& racer) {
    return [&racer](Part part) { racer(part.begin, part.end); };
}

PyParts parts_of(const PyRacer& racer, std::size_t count, double patience_seconds) {
    PyParts result;
    for (const Part& part : parts_for(as_run(racer), count, patience_seconds))
        result.emplace_back(part.begin, part.end);
    return result;
}

/// [(ns, spread, [ns of each pass])]
py::list turns(const std::vector<std::pair<PyRacer, PyParts>>& racers, int passes, double enough_seconds) {
    std::vector<Racer> list;
    for (const auto& [racer, parts] : racers) {
        list.push_back({as_run(racer), {}});
        for (const auto& [begin, end] : parts) list.back().parts.push_back({begin, end});
    }
    TurnOptions options;
    options.passes = passes;
    options.all_threads = true; // some libraries start others even when told not to
    options.enough_seconds = enough_seconds;
    py::list result;
    for (const Pace& pace : take_turns(list, options))
        result.append(py::make_tuple(pace.ns, pace.spread, pace.pass_ns));
    return result;
}

} // namespace

PYBIND11_MODULE(echinus_bench, module) {
    py::class_<Rival>(module, "Rival")
        .def_property_readonly_static("role", [](const py::object&) { return "rival"; })
        .def_property_readonly("name", &Rival::name)
        .def_property_readonly("build_ms", &Rival::build_ms)
        .def_property_readonly("byte_count", &Rival::byte_count)
        .def("contains", &Rival::contains, py::arg("points"), py::arg("out").noconvert())
        .def("signed_distance", &Rival::signed_distance, py::arg("points"), py::arg("out").noconvert());
    py::class_<NativeMap>(module, "NativeMap")
        .def(py::init<const Vertices&, const Faces&>())
        .def("ask", &NativeMap::ask);
    module.def("rivals", rivals_of);
    module.def("contains_by_winding_number", contains_by_winding_number, py::arg("vertices"),
               py::arg("faces"), py::arg("points"), py::arg("out").noconvert());
    module.def("point_set", point_set);
    module.def("judged", judged);
    module.def("parts_for", parts_of);
    module.def("take_turns", turns);
    module.def("pin_to_one_core", pin_to_one_core);
    module.def("heap_bytes", rivals::heap_bytes);
    module.def("describe_machine", describe_machine);
}
