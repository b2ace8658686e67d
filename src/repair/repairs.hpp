#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

/// The repairs of RepairOptions; each kind has its own source file.
namespace echinus {

/// The faces that repair() drops as duplicates, see RepairOptions::drop_duplicate_faces; ascending.
/// @pre indices are in range
std::vector<std::uint32_t> find_surplus_faces(const TriangleMesh& mesh);

/// The faces to drop so that no quadrilateral is filled twice (see RepairOptions::drop_doubled_patches);
/// ascending.
/// @pre indices are in range
std::vector<std::uint32_t> find_doubled_patch_faces(const TriangleMesh& mesh);

/// The faces that are dropped as loose slivers (see RepairOptions::drop_loose_slivers); ascending.
/// @pre require_valid(mesh)
std::vector<std::uint32_t> find_loose_slivers(const TriangleMesh& mesh);

/// Turns faces so that neighbours agree (see RepairOptions::orient_faces).
/// @returns how many faces were turned
/// @pre require_valid(mesh)
std::size_t orient_faces(TriangleMesh& mesh);

/// Fills holes no wider than `width` with new faces, which come after the others (see
/// RepairOptions::close_seams).
/// @returns how many were filled
/// @pre require_valid(mesh)
std::size_t fill_seams(TriangleMesh& mesh, double width);

struct ClosedHoles {
    std::size_t closed = 0, left = 0;
};

/// Fills holes with new faces, which come after the others (see RepairOptions::max_hole_edges).
/// @pre require_valid(mesh), max_edges <= RepairOptions::kMaxHoleEdges
ClosedHoles close_small_holes(TriangleMesh& mesh, std::uint32_t max_edges);

/// Reverses the faces of inside-out components (see RepairOptions::flip_inside_out).
/// @returns how many components were reversed
/// @pre require_valid(mesh)
std::size_t flip_inside_out_components(TriangleMesh& mesh);

/// The faces to drop because they lie inside the solid (see RepairOptions::drop_inner_faces); ascending.
/// @pre require_valid(mesh)
std::vector<std::uint32_t> find_inner_faces(const TriangleMesh& mesh);

/// Turns sheets into solids of the given thickness (see RepairOptions::sheet_thickness).
/// @returns how many sheets there were
/// @throws Error InvalidOptions for a thickness that does not suit the mesh
/// @pre require_valid(mesh), the thickness is finite and positive
std::size_t thicken_sheets(TriangleMesh& mesh, double thickness);

} // namespace echinus
