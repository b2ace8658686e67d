#include "interface.hpp"
#include "values.hpp"

#include <echinus/soft_body.hpp>

#include <pybind11/stl.h>

#include <utility>
#include <vector>

namespace echinus::python {

namespace {

using Edges = std::vector<std::array<std::uint32_t, 2>>;

/// Numbers in pairs, [n, 2].
Edges pairs_of(const py::object& numbers, const char* name) {
    const std::vector<std::uint32_t> row = whole_numbers(numbers, name);
    const py::array array = py::array::ensure(numbers);
    if (!row.empty() && (array.ndim() != 2 || array.shape(1) != 2))
        throw py::value_error(std::string(name) + " must have the shape (n, 2)");
    Edges pairs(row.size() / 2);
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {row[2 * i], row[2 * i + 1]};
    return pairs;
}

/// [n, 2] vertices and colliders.
std::vector<Attachment> attachments_of(const py::object& numbers) {
    std::vector<Attachment> attachments;
    for (const auto& [vertex, collider] : pairs_of(numbers, "attachments"))
        attachments.push_back({vertex, collider});
    return attachments;
}

Deformable sheet(std::uint32_t column_count, std::uint32_t row_count, double width, double height,
                 const Vector& position, const Quaternion& rotation, const py::object& pins) {
    return make_cloth({.column_count = column_count,
                       .row_count = row_count,
                       .width = width,
                       .height = height,
                       .pose = pose_of(position, rotation),
                       .pins = whole_numbers(pins, "pins")});
}

Deformable cloth_of_mesh(const py::array_t<float>& vertices, const py::array_t<std::uint32_t>& faces,
                         const std::optional<py::array_t<float>>& rest_vertices, const py::object& threads,
                         bool bends_by_sticks, const Vector& position, const Quaternion& rotation,
                         double scale, const py::object& pins, const py::object& attachments) {
    const TriangleMesh mesh = mesh_of(vertices, faces);
    const MeshClothOptions options{.pose = pose_of(position, rotation),
                                   .scale = scale,
                                   .rest_vertices =
                                       rest_vertices ? points_of(*rest_vertices) : std::vector<Vec3f>{},
                                   .threads = pairs_of(threads, "threads"),
                                   .bending = bends_by_sticks ? BendingKind::Sticks : BendingKind::Angles,
                                   .pins = whole_numbers(pins, "pins"),
                                   .attachments = attachments_of(attachments)};
    return unlocked([&] { return make_cloth(mesh, options); });
}

Deformable soft_body(const py::array_t<float>& vertices, const py::array_t<std::uint32_t>& tetrahedra,
                     double density, double young_modulus, double poisson_ratio, double damping,
                     const Vector& position, const Quaternion& rotation, double scale, const py::object& pins,
                     const py::object& attachments) {
    const TetrahedralMesh mesh = body_of(vertices, tetrahedra);
    const SoftBodyOptions options{.density = density,
                                  .young_modulus = young_modulus,
                                  .poisson_ratio = poisson_ratio,
                                  .damping = damping,
                                  .pose = pose_of(position, rotation),
                                  .scale = scale,
                                  .pins = whole_numbers(pins, "pins"),
                                  .attachments = attachments_of(attachments)};
    return unlocked([&] { return make_soft_body(mesh, options); });
}

Deformable combined(const std::vector<const Deformable*>& parts) {
    std::vector<Deformable> copies;
    for (const Deformable* part : parts) copies.push_back(*part);
    return combine(copies);
}

} // namespace

void bind_deformables(py::module_& module) {
    py::class_<Deformable>(module, "Deformable")
        .def_property_readonly(
            "positions",
            [](const py::object& self) { return view_of(self.cast<const Deformable&>().positions, self); })
        .def_property_readonly("inverse_masses",
                               [](const py::object& self) {
                                   return view_of(self.cast<const Deformable&>().inverse_masses, self);
                               })
        .def_property_readonly(
            "faces",
            [](const py::object& self) { return view_of(self.cast<const Deformable&>().faces, self); })
        .def_property_readonly(
            "tetrahedra",
            [](const py::object& self) { return view_of(self.cast<const Deformable&>().tetrahedra, self); })
        .def_property_readonly("stick_count", [](const Deformable& d) { return d.sticks.size(); })
        .def_property_readonly("fold_count", [](const Deformable& d) { return d.folds.size(); });
    module.def("make_cloth", sheet);
    module.def("make_cloth_of_mesh", cloth_of_mesh);
    module.def("make_soft_body", soft_body);
    module.def("combine", combined);
    module.def("with_masses_times", [](double factor, const Deformable& deformable) {
        return with_masses_times(factor, deformable);
    });
}

} // namespace echinus::python
