#pragma once

#include "rivals/systems/superquadric_map/superquadric_map.hpp"

#include <echinus/mesh.hpp>

#include <string>
#include <vector>

/// The head of the table, and a row for one mesh: segments, bytes, fit error, surface not covered and buried,
/// build time, and wrong signs beside an exact map.
std::vector<std::string> head_of_measurements();

/// @throws Error as both maps' builds do
std::vector<std::string> measure(const std::string& name, const echinus::TriangleMesh& mesh,
                                 const echinus::rivals::SuperquadricMapOptions& options);
