#include "interface.hpp"
#include "mesh/local_frame.hpp"
#include "options.hpp"
#include "values.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/tetrahedra.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstring>
#include <filesystem>
#include <string>

namespace echinus::python {

namespace {

using Vertices = py::array; // float32, or float64 for a mesh with an origin
using Tetrahedra = py::array_t<std::uint32_t>;

/// ((vertices, tetrahedra), turned tetrahedra, dropped vertices)
py::tuple read_file(const std::filesystem::path& path) {
    TetrahedraFile file = unlocked([&] { return read_tetrahedra(path); });
    return py::make_tuple(arrays_of(std::move(file.mesh)), file.turned_tetrahedra, file.dropped_vertices);
}

/// ((vertices, tetrahedra), size, removed tetrahedra)
py::tuple fill(const ExactMap& model, const py::dict& given) {
    const auto options = options_of<TetrahedralizeOptions>(given);
    Tetrahedralization made = unlocked([&] { return tetrahedralize(model.view(), options); });
    return py::make_tuple(arrays_of(std::move(made.mesh)), made.size, made.removed_tetrahedra);
}

py::dict inspect_body(const Vertices& vertices, const Tetrahedra& tetrahedra) {
    const TetrahedralMesh mesh = body_of(vertices, tetrahedra);
    const TetrahedralReport report = unlocked([&] { return inspect_tetrahedra(mesh); });
    py::dict result;
    result["tetrahedron_count"] = report.tetrahedron_count;
    result["vertex_count"] = report.vertex_count;
    result["volume"] = report.volume;
    result["least_volume"] = report.least_volume;
    result["shortest_edge"] = report.shortest_edge;
    result["longest_edge"] = report.longest_edge;
    result["least_angle_deg"] = report.least_angle_deg;
    result["greatest_angle_deg"] = report.greatest_angle_deg;
    result["boundary"] = report_dict(report.boundary, mesh.origin);
    return result;
}

/// (mean to the model, greatest, mean to the boundary, greatest)
py::tuple distance_to(const Vertices& vertices, const Tetrahedra& tetrahedra, const ExactMap& model,
                      int threads) {
    const unsigned workers = thread_count(threads);
    const TetrahedralMesh mesh = body_of(vertices, tetrahedra);
    const BoundaryDistance d = unlocked([&] { return measure_distance(mesh, model.view(), workers); });
    return py::make_tuple(d.mean_to_model, d.greatest_to_model, d.mean_to_boundary, d.greatest_to_boundary);
}

/// An embedding, and the number of vertices of the body for which it was made.
struct BodyEmbedding {
    Embedding points;
    std::size_t vertex_count;
};

BodyEmbedding embed_points(const Vertices& vertices, const Tetrahedra& tetrahedra, const py::object& points,
                           int threads) {
    const unsigned workers = thread_count(threads);
    const TetrahedralMesh mesh = body_of(vertices, tetrahedra);
    require_no_origin(mesh.origin, "the body");
    const Points taken(points, "points");
    return {unlocked([&] { return embed(mesh, taken.span(), workers); }), mesh.vertices.size()};
}

py::array carry_points(const BodyEmbedding& embedding, const py::object& positions, const py::object& out,
                       int threads) {
    const unsigned workers = thread_count(threads);
    Points taken(positions, "positions");
    if (taken.shape().size() != 1 || taken.size() != embedding.vertex_count)
        throw py::value_error("positions must be those of the body's " +
                              std::to_string(embedding.vertex_count) + " vertices; there are " +
                              std::to_string(taken.size()));
    py::array carried =
        answers(py::dtype::of<float>(), {static_cast<py::ssize_t>(embedding.points.size()), 3}, out, taken);
    const StridedSpan<Vec3f> places(static_cast<Vec3f*>(carried.mutable_data()), embedding.points.size());
    unlocked([&] { carry(embedding.points, taken.span(), places, workers); });
    return carried;
}

/// An array of one member of each point; in C++ the members of a point are adjacent.
template <typename T>
py::array_t<T> gathered(const Embedding& points, py::ssize_t width, std::size_t offset) {
    py::array_t<T> result({static_cast<py::ssize_t>(points.size()), width});
    T* to = result.mutable_data();
    for (const EmbeddedPoint& point : points) {
        std::memcpy(to, reinterpret_cast<const std::byte*>(&point) + offset,
                    static_cast<std::size_t>(width) * sizeof(T));
        to += width;
    }
    return result;
}

void bind_embedding(py::module_& module) {
    py::class_<BodyEmbedding>(module, "Embedding")
        .def("carry", carry_points)
        .def_property_readonly("size", [](const BodyEmbedding& e) { return e.points.size(); })
        .def_property_readonly("vertices",
                               [](const BodyEmbedding& e) {
                                   return gathered<std::uint32_t>(e.points, 4,
                                                                  offsetof(EmbeddedPoint, vertices));
                               })
        .def_property_readonly("weights", [](const BodyEmbedding& e) {
            return gathered<float>(e.points, 4, offsetof(EmbeddedPoint, weights));
        });
    module.def("embed", embed_points);
}

} // namespace

void bind_tetrahedra(py::module_& module) {
    module.def("tetrahedron_array", tetrahedron_array);
    module.def("read_tetrahedra", read_file);
    module.def("write_tetrahedra",
               [](const std::filesystem::path& path, const Vertices& vertices, const Tetrahedra& tetrahedra) {
                   const TetrahedralMesh mesh = body_of(vertices, tetrahedra);
                   unlocked([&] { write_tetrahedra(path, mesh); });
               });
    module.def("require_valid_tetrahedra", [](const Vertices& vertices, const Tetrahedra& tetrahedra) {
        const TetrahedralMesh mesh = body_of(vertices, tetrahedra);
        unlocked([&] { require_valid_tetrahedra(mesh); });
    });
    module.def("boundary", [](const Vertices& vertices, const Tetrahedra& tetrahedra) {
        const TetrahedralMesh mesh = body_of(vertices, tetrahedra);
        return arrays_of(unlocked([&] { return boundary(mesh); }));
    });
    module.def("make_solid_box",
               [](const std::array<double, 3>& size, const std::array<std::uint32_t, 3>& segments) {
                   return arrays_of(make_solid_box({size[0], size[1], size[2]}, segments));
               });
    module.def("tetrahedralize", fill);
    module.def("inspect_tetrahedra", inspect_body);
    module.def("measure_distance", distance_to);
    bind_embedding(module);
}

} // namespace echinus::python
