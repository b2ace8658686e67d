#pragma once

#include "values.hpp"

#include <echinus/any_map.hpp>
#include <echinus/collider.hpp>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <tuple>
#include <vector>

namespace echinus::python {

/// Map, position, rotation, scale, linear and angular velocity, name.
using ColliderArguments = std::tuple<py::object, Vector, Quaternion, Vector, Vector, Vector, std::string>;
/// A collider for a simulation, which checks it.
Collider collider_of(const ColliderArguments& arguments);

/// The map of one of the two classes for maps.
AnyMap map_of(const py::object& map);

/// Time, position, rotation.
using KeyArguments = std::tuple<double, Vector, Quaternion>;
/// Keys for a simulation, which checks them.
std::vector<PoseKey> keys_of(const std::vector<KeyArguments>& keys);

} // namespace echinus::python
