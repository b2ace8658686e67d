#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// The faces that repair() drops as duplicates, see RepairOptions::drop_duplicate_faces; ascending.
/// @pre indices are in range
std::vector<std::uint32_t> find_surplus_faces(const TriangleMesh& mesh);

} // namespace echinus
