#pragma once

#include "mesh_io/mesh_source.hpp"
#include "mesh_io/number_source.hpp"

#include <echinus/mesh_io.hpp>

#include <vector>

/// One reader per kind of file of tetrahedra.
///
/// All of them throw Error WrongFormat, Damaged or InvalidMesh. Vertices are finite and indices in range;
/// what else is wrong with the tetrahedra is for finish_tetrahedra() to say.
namespace echinus {

/// The contents of a file.
struct TetrahedraInFile {
    std::vector<Vec3d> vertices; ///< finite as floats, too
    std::vector<Tetrahedron> tetrahedra;
};

TetrahedraInFile read_msh(const MeshSource& source);
TetrahedraInFile read_vtk(const MeshSource& source);
/// A pair of files.
TetrahedraInFile read_tetgen(const MeshSource& nodes, const MeshSource& elements);

/// Moves the vertices to a local origin where that is needed (mesh/local_frame.hpp), turns negative
/// tetrahedra round, drops vertices that none uses, and refuses what require_valid_tetrahedra() does, in the
/// name of `source`.
TetrahedraFile finish_tetrahedra(TetrahedraInFile read, const MeshSource& source);

/// read_tetrahedra() for the bytes of a .msh or .vtk file.
TetrahedraFile read_tetrahedra(const MeshSource& source);

} // namespace echinus
