#include "interface.hpp"
#include "options.hpp"

#include <echinus/soft_body.hpp>

#include <pybind11/stl.h>

#include <cstddef>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace echinus::python {

namespace {

Deformable sheet(const py::dict& options) {
    return make_cloth(options_of<ClothOptions>(options));
}

Deformable cloth_of_mesh(const py::array& vertices, const py::array_t<std::uint32_t>& faces,
                         const py::dict& given) {
    const TriangleMesh mesh = mesh_of(vertices, faces);
    const auto options = options_of<MeshClothOptions>(given);
    return unlocked([&] { return make_cloth(mesh, options); });
}

Deformable soft_body(const py::array& vertices, const py::array_t<std::uint32_t>& tetrahedra,
                     const py::dict& given) {
    const TetrahedralMesh mesh = body_of(vertices, tetrahedra);
    const auto options = options_of<SoftBodyOptions>(given);
    return unlocked([&] { return make_soft_body(mesh, options); });
}

// ---- Pickles

/// Calls use() for each array of a deformable. Functions that receive a deformable from a pickle check it
/// like any other.
template <typename Use>
void for_each_part(const Use& use) {
    use(&Deformable::positions);
    use(&Deformable::velocities);
    use(&Deformable::inverse_masses);
    use(&Deformable::constraints);
    use(&Deformable::faces);
    use(&Deformable::attachments);
    use(&Deformable::tetrahedra);
    use(&Deformable::filters);
}
constexpr std::size_t kPartCount = 8;

py::tuple parts_of(const Deformable& deformable) {
    py::tuple parts(kPartCount);
    std::size_t next = 0;
    for_each_part([&]<typename T>(std::vector<T> Deformable::*part) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::vector<T>& values = deformable.*part;
        parts[next++] = py::bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    });
    return parts;
}

Deformable deformable_of(const py::tuple& parts) {
    const auto require = [](bool condition) {
        if (!condition) throw py::value_error("these are no parts of a deformable of this version");
    };
    require(parts.size() == kPartCount);
    Deformable deformable;
    std::size_t next = 0;
    for_each_part([&]<typename T>(std::vector<T> Deformable::*part) {
        const py::object bytes = parts[next++];
        require(py::isinstance<py::bytes>(bytes));
        const std::string_view text = py::reinterpret_borrow<py::bytes>(bytes);
        require(text.size() % sizeof(T) == 0);
        std::vector<T>& values = deformable.*part;
        values.resize(text.size() / sizeof(T));
        if (!text.empty()) std::memcpy(values.data(), text.data(), text.size());
    });
    require(deformable.inverse_masses.size() == deformable.particle_count());
    return deformable;
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
        .def_property_readonly("constraint_count", [](const Deformable& d) { return d.constraints.size(); })
        .def("parts", parts_of);
    module.def("deformable_of", deformable_of);
    module.def("make_cloth", sheet);
    module.def("make_cloth_of_mesh", cloth_of_mesh);
    module.def("make_soft_body", soft_body);
    module.def("combine", combined);
    module.def("with_masses_times", [](double factor, const Deformable& deformable) {
        return with_masses_times(factor, deformable);
    });
    module.def("passing_through", [](std::uint32_t collider, const Deformable& deformable) {
        return passing_through(collider, deformable);
    });
}

} // namespace echinus::python
