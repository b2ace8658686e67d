#pragma once

#include "arrays.hpp"

#include <pybind11/pybind11.h>

/// The parts of echinus._core: the functions of the library that the Python files of the package need, in the
/// plainest form. Defaults, documentation and checks that are easily expressed in Python are in those files.
namespace echinus::python {

void bind_errors(py::module_& module);
void bind_meshes(py::module_& module);
void bind_maps(py::module_& module);
void bind_tetrahedra(py::module_& module);
void bind_deformables(py::module_& module);
void bind_colliders(py::module_& module);
void bind_collisions(py::module_& module);
void bind_scenes(py::module_& module);
void bind_simulations(py::module_& module);

} // namespace echinus::python
