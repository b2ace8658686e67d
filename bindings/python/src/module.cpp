#include "interface.hpp"

#include <echinus/error.hpp>
#include <echinus/instruction_set.hpp>
#include <echinus/version.hpp>

#include <pybind11/stl.h>

#include <exception>
#include <string>

namespace {

/// pybind11 before 2.12 knows only the memory layout of NumPy 1's types. With NumPy 2 it reads wrong strides:
/// answers would be wrong, or written past the end of their array.
void refuse_numpy_2() {
#if PYBIND11_VERSION_HEX < 0x020C0000
    const auto version = pybind11::module_::import("numpy").attr("__version__").cast<std::string>();
    if (std::stoi(version) >= 2)
        throw pybind11::import_error("this build of echinus needs NumPy 1, but NumPy " + version +
                                     " is installed: pip install \"numpy<2\"");
#endif
}

} // namespace

PYBIND11_MODULE(_core, module) {
    using namespace echinus::python;
    refuse_numpy_2();
    bind_errors(module);
    bind_meshes(module);
    bind_maps(module);
    bind_tetrahedra(module);
    bind_deformables(module);
    bind_colliders(module);
    bind_collisions(module);
    bind_scenes(module);
    bind_simulations(module);
    module.attr("version") = echinus::version();
    module.def("available_instruction_sets", echinus::available_instruction_sets,
               "The sets of vector instructions of this machine, the widest first; the last is \"scalar\".");
    module.def("instruction_set", echinus::instruction_set,
               "The set of vector instructions in use. It decides the speed only, never an answer.");
    module.def("use_instruction_set", echinus::use_instruction_set,
               "Selects another set of vector instructions for the whole process.");
}

namespace echinus::python {

namespace {

const char* name_of(ErrorCode code) {
    switch (code) {
    case ErrorCode::Unreadable:
        return "unreadable";
    case ErrorCode::Unwritable:
        return "unwritable";
    case ErrorCode::WrongFormat:
        return "wrong_format";
    case ErrorCode::Damaged:
        return "damaged";
    case ErrorCode::UnsupportedVersion:
        return "unsupported_version";
    case ErrorCode::InvalidMesh:
        return "invalid_mesh";
    case ErrorCode::InvalidOptions:
        return "invalid_options";
    case ErrorCode::InvalidScene:
        return "invalid_scene";
    case ErrorCode::Diverged:
        return "diverged";
    }
    return "internal";
}

/// A sentence may contain the name of a file that is not UTF-8; it is then shown as Python itself shows such
/// names.
py::str text_of(const Error& error) {
    const std::string_view sentence = error.what();
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeUTF8(sentence.data(), static_cast<Py_ssize_t>(sentence.size()), "surrogateescape"));
}

void translate(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
        const py::object type = py::module_::import("echinus._errors").attr("Error");
        PyErr_SetObject(type.ptr(), type(text_of(error), name_of(error.code())).ptr());
    }
}

} // namespace

void bind_errors(py::module_&) {
    py::register_local_exception_translator(translate);
}

} // namespace echinus::python
