#pragma once

#include <echinus/mesh.hpp>

#include <pybind11/pybind11.h>

namespace echinus::python {

/// The members of a report, by their names.
pybind11::dict describe(const MeshReport& report);

} // namespace echinus::python
