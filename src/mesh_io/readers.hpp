#pragma once

#include "mesh_io/mesh_source.hpp"
#include "mesh_io/polygon_mesh.hpp"

#include <echinus/mesh_io.hpp>

/// One reader per kind of file.
///
/// All of them throw Error WrongFormat, Damaged or InvalidMesh; vertices are finite and indices in range.
namespace echinus {

PolygonMesh read_obj(const MeshSource& source);
PolygonMesh read_off(const MeshSource& source);
PolygonMesh read_ply(const MeshSource& source);
PolygonMesh read_stl(const MeshSource& source);

/// glTF, GLB and 3DS. A glTF file's buffers are looked for beside it.
PolygonMesh read_scene(const MeshSource& source);

/// Parts of require_beginning(), below. The head of a binary STL file states its size.
void require_beginning_of_stl(const MeshSource& beginning);
void require_beginning_of_gltf(const MeshSource& beginning);
void require_beginning_of_glb(const MeshSource& beginning);
void require_beginning_of_3ds(const MeshSource& beginning);

/// read_mesh() for the bytes of a file; the extension of the source's name determines the format.
TriangleMesh read_mesh(const MeshSource& source);
MeshAndEdges read_mesh_and_edges(const MeshSource& source);

/// Refuses the first bytes of a stream when read_mesh() would refuse it whatever followed them, so that a
/// stream without an end is not read up to a limit.
/// @pre beginning.bytes.size() >= 84, the head of a binary STL file
/// @throws Error WrongFormat or Damaged
void require_beginning(const MeshSource& beginning);

} // namespace echinus
