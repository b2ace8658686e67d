#pragma once

#include "mesh_io/mesh_source.hpp"
#include "mesh_io/polygon_mesh.hpp"

/// One reader per kind of file. OBJ, OFF, PLY and STL are read here and not by Assimp, whose readers (5.2.5)
/// round a tenth of all written coordinates to another float than the nearest, miss most truncations, and
/// abort (OFF) or hang (PLY) on some damaged files.
///
/// All of them throw Error WrongFormat, Damaged or InvalidMesh; vertices are finite and indices in range.
namespace echinus {

PolygonMesh read_obj(const MeshSource& source);
PolygonMesh read_off(const MeshSource& source);
PolygonMesh read_ply(const MeshSource& source);
PolygonMesh read_stl(const MeshSource& source);

/// glTF, GLB and 3DS, through Assimp. A glTF file's buffers are looked for beside it.
PolygonMesh read_scene(const MeshSource& source);

/// read_mesh() for the bytes of a file; the extension of the source's name determines the format.
TriangleMesh read_mesh(const MeshSource& source);

} // namespace echinus
