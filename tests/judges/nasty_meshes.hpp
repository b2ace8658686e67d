#pragma once

#include <echinus/mesh.hpp>

#include <string>
#include <vector>

namespace echinus::test {

/// Names that make_nasty_mesh() knows: closed meshes that are hard for a map of directions.
std::vector<std::string> nasty_mesh_names();

/// @throws Error InvalidOptions for another name; the sentence lists them all
TriangleMesh make_nasty_mesh(const std::string& name);

} // namespace echinus::test
