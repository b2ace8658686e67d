#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

/// The repairs of RepairOptions, each in a source file of its own.
namespace echinus {

/// The faces that repair() drops as duplicates, see RepairOptions::drop_duplicate_faces; ascending.
/// @pre indices are in range
std::vector<std::uint32_t> find_surplus_faces(const TriangleMesh& mesh);

/// The faces to drop so that no quadrilateral is filled twice (see RepairOptions::drop_doubled_patches);
/// ascending.
/// @pre indices are in range
std::vector<std::uint32_t> find_doubled_patch_faces(const TriangleMesh& mesh);

/// Reverses the faces of inside-out components (see RepairOptions::flip_inside_out).
/// @returns how many components were reversed
/// @pre require_valid(mesh)
std::size_t flip_inside_out_components(TriangleMesh& mesh);

} // namespace echinus
