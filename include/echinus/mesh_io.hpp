#pragma once

#include <echinus/collider.hpp>
#include <echinus/export.hpp>
#include <echinus/mesh.hpp>
#include <echinus/tetrahedra.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Mesh files. Library echinus::io; echinus::core does not depend on it.
namespace echinus {

/// Reads OBJ, PLY (text and binary), STL (text and binary), OFF, glTF 2.0, GLB and 3DS, by the file name's
/// extension. All meshes of the file are joined, polygons are triangulated, equal positions are welded and
/// vertices that no face uses are dropped; points, lines (but see read_mesh_and_edges()), normals, colours
/// and materials are ignored. Nothing is repaired: inspect() reports the faults of the result. Face numbers
/// are those of the file, a polygon of k corners counted as its k - 2 triangles, and a strip of triangles in
/// a PLY as those that have three different corners. Coordinates are read in double; where floats could not
/// hold the shape, as in maps of a country, the mesh has an origin (TriangleMesh::origin), and otherwise they
/// are rounded to the nearest float. The same file gives the same mesh.
///
/// Text is ASCII or UTF-8, with or without a byte order mark, with lines that end as on Unix, Windows or old
/// Macs; Ctrl-Z or zeros may fill it up. Bytes after the faces of a binary STL are ignored unless they could
/// be faces. Numbers of a text PLY or OFF may be wrapped over lines. OFF is read as text.
///
/// Of a glTF file the meshes of one scene are read, the one that it names or its first, as they stand at
/// rest: placed by their nodes, or led by the bones of their skins, morphed by their default weights, and
/// copied for each instance of EXT_mesh_gpu_instancing. Positions may be quantised (KHR_mesh_quantization). A
/// required extension that is not read, such as one that compresses, is refused as WrongFormat, by its name.
/// Buffers are looked for beside the file. Of a 3DS file the positions are those in its lists; keyframes only
/// place copies of objects that have several nodes.
///
/// @throws Error Unreadable, WrongFormat, Damaged (a file shorter or longer than it declares; the sentence
/// names the line or byte) or InvalidMesh (no faces; an index out of range or a coordinate that is not finite
/// as a float, even of an unused vertex); the sentence begins with the path.
TriangleMesh read_mesh(const std::filesystem::path& path);

/// A mesh, and edges that are drawn apart from its faces: threads, needles, wires.
struct MeshAndEdges {
    TriangleMesh mesh;
    std::vector<std::array<std::uint32_t, 2>> edges; ///< vertex indices, in the order of the file
};

/// The same, with the lines of the file: those of an OBJ (`l`), a line of k corners as k - 1 edges, and
/// polygons of two corners in the other formats. Vertices that only lines use are kept.
/// @throws Error as read_mesh(); InvalidMesh only when there are neither faces nor lines
MeshAndEdges read_mesh_and_edges(const std::filesystem::path& path);

/// Writes OBJ, PLY (binary), STL (binary) or OFF, by the file name's extension. Floats read back with the
/// same bits. A mesh with an origin is written in the file's frame, in decimals (STL, too) or as doubles
/// (PLY). Writes to a temporary name beside the target and renames it, so a failure leaves no partial
/// file and keeps the old one.
///
/// @throws Error Unwritable, WrongFormat for an extension that is not in the list, or InvalidMesh as
/// inspect() does
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// The same with the edges, as lines of an OBJ; other formats only where there are none.
/// @throws Error as write_mesh(); WrongFormat where the format has no lines, InvalidMesh when an edge names a
/// vertex that does not exist
void write_mesh_and_edges(const std::filesystem::path& path, const MeshAndEdges& drawn);

// ---- Tetrahedra ----

/// A body, and what was changed for it to be valid.
struct TetrahedraFile {
    TetrahedralMesh mesh; ///< valid; every vertex is used
    /// Tetrahedra that were negative and had two corners exchanged: the order of corners is a file's
    /// convention, the body is the same.
    std::size_t turned_tetrahedra = 0;
    std::size_t dropped_vertices = 0; ///< that no tetrahedron uses
};

/// Reads .msh (Gmsh 2.2 and 4.1, text and binary), .vtk (legacy, an unstructured grid, text and binary) and
/// TetGen's .node with .ele: either path names the pair, whose names differ in the extension only, and
/// numbers count from 0 or 1. Points, lines and plane cells are ignored, as are data; other cells than
/// tetrahedra of four corners are refused. Tetrahedra keep their order. Coordinates are read
/// as by read_mesh(). Positions are not welded.
///
/// @throws Error Unreadable, WrongFormat, Damaged or InvalidMesh as read_mesh() does. InvalidMesh also for a
/// tetrahedron that is flat, and for two on the same side of a face of theirs, as where an inverted one lies
/// folded over its neighbour; the sentence has their numbers, from 0
TetrahedraFile read_tetrahedra(const std::filesystem::path& path);

/// Writes .msh (Gmsh 2.2, text) or .vtk (legacy, text), by the file name's extension. Floats read back with
/// the same bits; of a mesh with an origin, doubles in the file's frame are written. Writes as write_mesh()
/// does.
///
/// @throws Error Unwritable, WrongFormat for another extension, or InvalidMesh as
/// require_valid_tetrahedra() does
void write_tetrahedra(const std::filesystem::path& path, const TetrahedralMesh& mesh);

/// Reads the vertices of a model over time: a PC2 point cache; a folder of OBJ files, one each, in the order
/// of their names; or a glTF, GLB or 3DS file with an animation, the model's own. PC2 says at which frames
/// its samples were taken; those of a folder are frames 0, 1, 2 ...
///
/// Of an animation a sample is taken in each frame from 0 s to the first frame that has all keys behind it.
/// Meshes with bones are skinned (linear blend skinning; the weights of a vertex are made to sum to 1),
/// others move with their nodes; morph targets are applied before. Between two keys, positions, scales and
/// weights of morph targets go evenly and rotations about one axis, the shorter way round: handles of splines
/// and steps are not kept. A 3DS file has 25 frames in a second. Takes 12 bytes for a vertex in a sample.
///
/// @param mesh               the model, as read_mesh() gives it
/// @param frames_per_second  positive
/// @param animation          the name of the animation; may be empty where the file has only one
/// @throws Error as read_mesh() does; InvalidMesh when the number of vertices, or a face of a folder's mesh
/// or of a file with an animation, is not the model's; when there is no animation or several to choose from,
/// it moves no vertex or a node with a matrix, has keys out of order or numbers that are not finite, or a
/// vertex of a mesh with bones has none; or when there are more than 2^28 positions. The sentence begins with
/// the path
VertexCache read_vertex_cache(const std::filesystem::path& path, const TriangleMesh& mesh,
                              double frames_per_second, std::string_view animation = {});

} // namespace echinus

ECHINUS_EXPORT_END
