#include "geometry/parallel.hpp"
#include "interface.hpp"
#include "options.hpp"
#include "values.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/surface_collision.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace echinus::python {

namespace {

using Vertices = py::array; // float32, or float64 for a mesh with an origin
using Faces = py::array_t<std::uint32_t>;

py::dict fault_dict(const Fault& fault) {
    py::dict result;
    result["count"] = fault.count;
    result["first_faces"] = py::tuple(py::cast(fault.first_faces));
    return result;
}

py::dict inspect_mesh(const Vertices& vertices, const Faces& faces) {
    const TriangleMesh mesh = mesh_of(vertices, faces);
    return report_dict(unlocked([&] { return inspect(mesh); }), mesh.origin);
}

/// ((vertices, faces), report)
py::tuple repair_mesh(const Vertices& vertices, const Faces& faces, const py::dict& given) {
    const auto options = options_of<RepairOptions>(given);
    const TriangleMesh mesh = mesh_of(vertices, faces);
    RepairedMesh repaired = unlocked([&] { return repair(mesh, options); });
    py::dict report;
    report["duplicate_faces_dropped"] = py::tuple(py::cast(repaired.report.duplicate_faces_dropped));
    report["doubled_patch_faces_dropped"] = py::tuple(py::cast(repaired.report.doubled_patch_faces_dropped));
    report["components_flipped"] = repaired.report.components_flipped;
    report["holes_closed"] = repaired.report.holes_closed;
    report["holes_left"] = repaired.report.holes_left;
    report["inner_faces_dropped"] = py::tuple(py::cast(repaired.report.inner_faces_dropped));
    report["sheets_thickened"] = repaired.report.sheets_thickened;
    report["faces_added"] = repaired.report.faces_added;
    report["vertices_welded"] = repaired.report.vertices_welded;
    report["slivers_dropped"] = py::tuple(py::cast(repaired.report.slivers_dropped));
    report["faces_turned"] = repaired.report.faces_turned;
    report["seams_filled"] = repaired.report.seams_filled;
    return py::make_tuple(arrays_of(std::move(repaired.mesh)), report);
}

/// Calls measure(point) for each point, in double and relative to the origin. An array of points costs time
/// in proportion to the mesh, so the pieces between which Ctrl-C is checked are small.
template <typename Measure>
py::array measured(const py::object& points, const Vec3d& origin, int threads, const Measure& measure) {
    constexpr std::size_t kPiece = 1024;
    const unsigned workers = thread_count(threads);
    const py::array_t<double, py::array::c_style | py::array::forcecast> numbers(
        number_array(points, "points"));
    if (numbers.ndim() == 0 || numbers.shape(numbers.ndim() - 1) != 3)
        throw py::value_error("points must have the shape (..., 3)");
    py::array_t<double> results(
        std::vector<py::ssize_t>(numbers.shape(), numbers.shape() + numbers.ndim() - 1));
    const double* from = numbers.data();
    double* to = results.mutable_data();
    const auto count = static_cast<std::size_t>(results.size());
    for (std::size_t first = 0; first < count; first += kPiece) {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        const py::gil_scoped_release released;
        parallel_for(std::min(kPiece, count - first), workers, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = first + begin; i < first + end; ++i)
                to[i] = measure(Vec3d(from[3 * i], from[3 * i + 1], from[3 * i + 2]) - origin);
        });
    }
    return results;
}

py::array pair_array(const std::vector<FacePair>& pairs) {
    py::array_t<std::uint32_t> result({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
    auto* to = result.mutable_data();
    for (const FacePair& pair : pairs) {
        *to++ = pair.a;
        *to++ = pair.b;
    }
    return result;
}

/// A curve in the frame of the mesh that has this origin: [n, 3] float32, or float64 if the origin is not 0.
py::array curve_array(const IntersectionCurve& curve, const Vec3d& origin) {
    const auto filled = [&](auto array, const auto& value_of) {
        auto* to = array.mutable_data();
        for (const Vec3f& point : curve.points)
            for (const auto coordinate : value_of(point)) *to++ = coordinate;
        return py::array(std::move(array));
    };
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(curve.points.size()), 3};
    if (origin == Vec3d{})
        return filled(py::array_t<float>(shape), [](const Vec3f& p) { return std::array{p.x, p.y, p.z}; });
    return filled(py::array_t<double>(shape), [&](const Vec3f& p) {
        return std::array{p.x + origin.x, p.y + origin.y, p.z + origin.z};
    });
}

py::dict intersections_dict(const Intersections& found, const Vec3d& origin) {
    py::list curves, closed;
    for (const IntersectionCurve& curve : found.curves) {
        curves.append(curve_array(curve, origin));
        closed.append(curve.closed);
    }
    py::dict result;
    result["pairs"] = pair_array(found.pairs);
    result["curves"] = py::tuple(curves);
    result["closed"] = py::tuple(closed);
    result["length"] = found.length;
    return result;
}

py::object penetration_tuple(const Penetration& penetration) {
    if (!penetration.known) return py::none();
    const py::object deepest =
        penetration.vertex_count == 0 ? py::object(py::none()) : py::cast(penetration.deepest_vertex);
    return py::make_tuple(penetration.vertex_count, deepest, penetration.depth);
}

/// [(a, b, intersections, a in b, b in a)] @param given  [(vertices, faces)]
py::list check_meshes(const std::vector<std::pair<Vertices, Faces>>& given, int threads) {
    const unsigned workers = thread_count(threads);
    std::vector<TriangleMesh> meshes;
    for (const auto& [vertices, faces] : given) meshes.push_back(mesh_of(vertices, faces));
    const auto found = unlocked([&] { return check(meshes, {.thread_count = workers}); });
    py::list result;
    for (const CheckedMeshes& pair : found)
        result.append(py::make_tuple(pair.a, pair.b, intersections_dict(pair.found, meshes[0].origin),
                                     penetration_tuple(pair.a_in_b), penetration_tuple(pair.b_in_a)));
    return result;
}

/// Thickness, pinned, layers.
using PartArguments = std::tuple<std::optional<double>, std::vector<std::uint8_t>, std::vector<std::uint8_t>>;

/// (mesh, own pairs, pairs with each model, vertices inside, largest displacement, stretched share, largest
/// stretch)
py::tuple part_mesh(const Vertices& vertices, const Faces& faces,
                    const std::vector<std::pair<Vertices, Faces>>& given, const PartArguments& options,
                    int threads) {
    TriangleMesh surface = mesh_of(vertices, faces);
    std::vector<TriangleMesh> models;
    for (const auto& [model_vertices, model_faces] : given)
        models.push_back(mesh_of(model_vertices, model_faces));
    const auto& [thickness, pinned, layers] = options;
    const PartOptions chosen{
        .thickness = thickness, .pinned = pinned, .layers = layers, .thread_count = thread_count(threads)};
    const Parted parted = unlocked([&] { return part(surface, models, chosen); });
    surface.vertices = parted.vertices;
    py::list model_pairs;
    for (const std::vector<FacePair>& pairs : parted.model_pairs) model_pairs.append(pair_array(pairs));
    return py::make_tuple(arrays_of(std::move(surface)), pair_array(parted.own_pairs), py::tuple(model_pairs),
                          py::array(py::cast(parted.inside)), parted.largest_displacement,
                          parted.stretched_share, parted.largest_stretch);
}

} // namespace

py::dict report_dict(const MeshReport& report, const Vec3d& origin) {
    const Vec3d centre = report.bounding_sphere.centre + origin;
    py::dict result;
    result["face_count"] = report.face_count;
    result["vertex_count"] = report.vertex_count;
    result["component_count"] = report.component_count;
    result["closed"] = report.closed;
    result["manifold"] = report.manifold;
    result["orientable"] = report.orientable;
    result["border_edges"] = fault_dict(report.border_edges);
    result["nonmanifold_edges"] = fault_dict(report.nonmanifold_edges);
    result["misoriented_edges"] = fault_dict(report.misoriented_edges);
    result["duplicate_faces"] = fault_dict(report.duplicate_faces);
    result["degenerate_faces"] = fault_dict(report.degenerate_faces);
    result["signed_volume"] = report.signed_volume;
    result["centre"] = py::make_tuple(centre.x, centre.y, centre.z);
    result["radius"] = report.bounding_sphere.radius;
    result["rounding_step"] = report.rounding_step;
    return result;
}

void bind_meshes(py::module_& module) {
    module.def("vertex_array", vertex_array);
    module.def("number_array", number_array);
    module.def("float_array", float_array);
    module.def("face_array", face_array);
    module.def("read_mesh", [](const std::filesystem::path& path) {
        return arrays_of(unlocked([&] { return read_mesh(path); }));
    });
    module.def("read_mesh_and_edges", [](const std::filesystem::path& path) {
        MeshAndEdges read = unlocked([&] { return read_mesh_and_edges(path); });
        return std::pair(arrays_of(std::move(read.mesh)), read.edges);
    });
    module.def("write_mesh",
               [](const std::filesystem::path& path, const Vertices& vertices, const Faces& faces) {
                   const TriangleMesh mesh = mesh_of(vertices, faces);
                   unlocked([&] { write_mesh(path, mesh); });
               });
    module.def("write_moved_mesh", [](const std::filesystem::path& path, const Vertices& vertices,
                                      const Faces& faces, const std::filesystem::path& original) {
        const TriangleMesh mesh = mesh_of(vertices, faces);
        return unlocked([&] { return write_moved_mesh(path, mesh, original); });
    });
    module.def("inspect", inspect_mesh);
    module.def("repair", repair_mesh);
    module.def("weld", [](const Vertices& vertices, const Faces& faces) {
        const TriangleMesh mesh = mesh_of(vertices, faces);
        return arrays_of(unlocked([&] { return weld(mesh); }));
    });
    module.def("winding_number",
               [](const Vertices& vertices, const Faces& faces, const py::object& points, int threads) {
                   const TriangleMesh mesh = mesh_of(vertices, faces);
                   require_valid(mesh);
                   return measured(points, mesh.origin, threads,
                                   [&](const Vec3d& p) { return winding_number(mesh, p); });
               });
    module.def("unsigned_distance",
               [](const Vertices& vertices, const Faces& faces, const py::object& points, int threads) {
                   const TriangleMesh mesh = mesh_of(vertices, faces);
                   require_valid(mesh);
                   return measured(points, mesh.origin, threads,
                                   [&](const Vec3d& p) { return unsigned_distance(mesh, p); });
               });
    module.def("intersecting_pairs", [](const Vertices& vertices_a, const Faces& faces_a,
                                        const Vertices& vertices_b, const Faces& faces_b) {
        const TriangleMesh a = mesh_of(vertices_a, faces_a), b = mesh_of(vertices_b, faces_b);
        return pair_array(unlocked([&] { return intersecting_pairs(a, b); }));
    });
    module.def("self_intersecting_pairs", [](const Vertices& vertices, const Faces& faces) {
        const TriangleMesh mesh = mesh_of(vertices, faces);
        return pair_array(unlocked([&] { return self_intersecting_pairs(mesh); }));
    });
    module.def("intersections", [](const Vertices& vertices_a, const Faces& faces_a,
                                   const Vertices& vertices_b, const Faces& faces_b) {
        const TriangleMesh a = mesh_of(vertices_a, faces_a), b = mesh_of(vertices_b, faces_b);
        return intersections_dict(unlocked([&] { return intersections(a, b); }), a.origin);
    });
    module.def("self_intersections", [](const Vertices& vertices, const Faces& faces) {
        const TriangleMesh mesh = mesh_of(vertices, faces);
        return intersections_dict(unlocked([&] { return self_intersections(mesh); }), mesh.origin);
    });
    module.def("check", check_meshes);
    module.def("part", part_mesh);
    module.def("make_torus",
               [](double major, double minor, std::uint32_t major_segments, std::uint32_t minor_segments) {
                   return arrays_of(make_torus(major, minor, major_segments, minor_segments));
               });
    module.def("make_sphere", [](double radius, std::uint32_t meridians, std::uint32_t parallels) {
        return arrays_of(make_sphere(radius, meridians, parallels));
    });
    module.def("make_box", [](const std::array<double, 3>& size, std::uint32_t segments) {
        return arrays_of(make_box({size[0], size[1], size[2]}, segments));
    });
}

} // namespace echinus::python
