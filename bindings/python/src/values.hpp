#pragma once

#include "files/text.hpp"

#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>

/// Converts vectors, poses and numbers of Python to the types of the library.
namespace echinus::python {

namespace py = pybind11;

using Vector = std::array<double, 3>;
using Quaternion = std::array<double, 4>; ///< w, x, y, z

inline Vec3d vector_of(const Vector& v) {
    return {v[0], v[1], v[2]};
}
/// @throws ValueError
inline Vec3d finite_vector_of(const Vector& v, const char* name) {
    if (!is_finite(vector_of(v))) throw py::value_error(std::string(name) + " must be finite");
    return vector_of(v);
}
inline RigidTransform pose_of(const Vector& position, const Quaternion& rotation) {
    return {{rotation[0], rotation[1], rotation[2], rotation[3]}, vector_of(position)};
}

inline std::tuple<double, double, double> to_python(const Vec3d& v) {
    return {v.x, v.y, v.z};
}
inline std::tuple<double, double, double, double> to_python(const Rotation& rotation) {
    return {rotation.w, rotation.x, rotation.y, rotation.z};
}

/// @param what  what is counted
/// @throws IndexError
inline std::size_t index_below(std::size_t count, std::int64_t index, const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= count)
        throw py::index_error(no_such_text(what, std::to_string(index), count));
    return static_cast<std::size_t>(index);
}

/// The members of a report by their names, with positions in the frame of the file.
/// @param origin  the origin of the mesh
pybind11::dict report_dict(const MeshReport& report, const Vec3d& origin);

} // namespace echinus::python
