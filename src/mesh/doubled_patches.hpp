#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// The faces to drop so that no quadrilateral is filled twice (see RepairOptions::drop_doubled_patches);
/// ascending.
/// @pre indices are in range
std::vector<std::uint32_t> find_doubled_patch_faces(const TriangleMesh& mesh);

} // namespace echinus
