#pragma once

#include <echinus/mesh.hpp>

#include <pybind11/pybind11.h>

namespace echinus::python {

/// The members of a report, by their names, places in the frame of the file.
/// @param origin  the mesh's
pybind11::dict report_dict(const MeshReport& report, const Vec3d& origin);

} // namespace echinus::python
