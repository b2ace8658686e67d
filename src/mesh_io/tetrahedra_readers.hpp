#pragma once

#include "mesh_io/mesh_source.hpp"
#include "mesh_io/number_source.hpp"

#include <echinus/mesh_io.hpp>

/// One reader per kind of file of tetrahedra.
///
/// All of them throw Error WrongFormat, Damaged or InvalidMesh. Vertices are finite and indices in range;
/// what else is wrong with the tetrahedra is for finish_tetrahedra() to say.
namespace echinus {

TetrahedralMesh read_msh(const MeshSource& source);
TetrahedralMesh read_vtk(const MeshSource& source);
/// A pair of files.
TetrahedralMesh read_tetgen(const MeshSource& nodes, const MeshSource& elements);

/// Turns negative tetrahedra round, drops vertices that none uses, and refuses what
/// require_valid_tetrahedra() does, in the name of `source`.
TetrahedraFile finish_tetrahedra(TetrahedralMesh mesh, const MeshSource& source);

/// read_tetrahedra() for the bytes of a .msh or .vtk file.
TetrahedraFile read_tetrahedra(const MeshSource& source);

} // namespace echinus
