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

/// Mesh files. They belong to the library echinus::io, on which echinus::core does not depend.
namespace echinus {

/// Reads OBJ, PLY (text and binary), STL (text and binary), OFF, glTF 2.0, GLB and 3DS, depending on the file
/// name's extension. All meshes of the file are joined, polygons are triangulated, equal positions are welded
/// and vertices that no face uses are dropped; points, lines (see read_mesh_and_edges() for these), normals,
/// colours and materials are ignored. Nothing is repaired: inspect() reports the faults of the result. Faces
/// are numbered in the order of the file; a polygon of k corners counts as its k - 2 triangles, and a
/// triangle strip in a PLY file as its triangles with three different corners. Coordinates are read in
/// double. If floats could not represent the shape, as with geographic coordinates, the mesh has an origin
/// (TriangleMesh::origin); otherwise coordinates are rounded to the nearest float. The same file always gives
/// the same mesh.
///
/// Text is ASCII or UTF-8, with or without a byte order mark, with line ends of Unix, Windows or old Macs;
/// it may be padded with Ctrl-Z or zeros. Bytes after the faces of a binary STL are ignored unless they
/// could be faces. The numbers of a face or vertex in a text PLY or OFF file may be spread over several
/// lines. OFF is read as text.
///
/// From a glTF file the meshes of the default scene, or else of the first scene, are read in their rest pose:
/// placed by their nodes or by the bones of their skins, morphed by their default weights, and copied for
/// each instance of EXT_mesh_gpu_instancing. Positions may be quantised (KHR_mesh_quantization). A required
/// extension that is not supported, such as a compression, is a WrongFormat error that names it. Buffers are
/// looked up in the folder of the file. From a 3DS file the vertex lists are read as they are; keyframes are
/// used only to place the copies of an object that has several nodes.
///
/// @throws Error Unreadable, WrongFormat, Damaged (a file that is shorter or longer than it declares; the
/// message names the line or byte) or InvalidMesh (no faces; an index out of range, or a coordinate that
/// is not finite as a float, even of an unused vertex); the message begins with the path.
TriangleMesh read_mesh(const std::filesystem::path& path);

/// A mesh, and edges that do not belong to its faces: threads, needles, wires.
struct MeshAndEdges {
    TriangleMesh mesh;
    std::vector<std::array<std::uint32_t, 2>> edges; ///< vertex indices, in the order of the file
};

/// Reads a mesh like read_mesh(), together with the lines of the file: in an OBJ the elements `l`, each of
/// which gives k - 1 edges for k corners, and in the other formats polygons of two corners. Vertices that
/// only lines use are kept.
/// @throws Error as read_mesh() does, but InvalidMesh for a lack of faces only if there are no lines either
MeshAndEdges read_mesh_and_edges(const std::filesystem::path& path);

/// Writes OBJ, PLY (binary), STL (binary) or OFF, depending on the file name's extension. Floats have the
/// same bits when they are read back. A mesh with an origin is written in the file's frame, in decimals (also
/// in STL) or as doubles (PLY). The file is written under a temporary name in the target's folder and then
/// renamed, so a failure leaves no partial file and keeps the old one.
///
/// @throws Error Unwritable, WrongFormat for any other extension, or InvalidMesh as inspect() does
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// Writes a mesh like the OBJ file from which read_mesh() read it before its vertices moved: polygons,
/// texture coordinates, normals, groups, materials and comments stay as they are. Another mesh is written by
/// write_mesh(): if either file is no OBJ, or if the new file would be read as other faces, as when polygons
/// of more than four corners are divided differently in their new shape.
/// @return whether all else stayed as it is
/// @throws Error as write_mesh() and read_mesh() do; InvalidMesh also for another number of vertices than in
/// the original
bool write_moved_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                      const std::filesystem::path& original);

/// Writes a mesh and its edges, as lines of an OBJ. Other formats are allowed only without edges.
/// @throws Error as write_mesh() does; WrongFormat if the format has no lines, InvalidMesh if an edge refers
/// to a vertex that does not exist
void write_mesh_and_edges(const std::filesystem::path& path, const MeshAndEdges& drawn);

// ---- Tetrahedra ----

/// A body, and the changes that made it valid.
struct TetrahedraFile {
    TetrahedralMesh mesh; ///< valid; every vertex is used
    /// Number of tetrahedra with negative volume, in which two corners were exchanged. The order of corners
    /// is a convention of the file; the body is the same.
    std::size_t turned_tetrahedra = 0;
    std::size_t dropped_vertices = 0; ///< number of vertices that no tetrahedron uses
};

/// Reads .msh (Gmsh 2.2 and 4.1, text and binary), .vtk (legacy, an unstructured grid, text and binary) and
/// TetGen's .node with .ele. Either file of TetGen's pair may be named, since the names differ only in the
/// extension; indices count from 0 or 1. Points, lines, planar cells and data are ignored; volume cells other
/// than four-node tetrahedra are rejected. Tetrahedra keep their order. Coordinates are read as in
/// read_mesh(). Positions are not welded.
///
/// @throws Error Unreadable, WrongFormat, Damaged or InvalidMesh as read_mesh() does. InvalidMesh also for
/// a flat tetrahedron, and for two tetrahedra on the same side of a common face, as when an inverted one
/// is folded over its neighbour; the message contains their indices, from 0
TetrahedraFile read_tetrahedra(const std::filesystem::path& path);

/// Writes .msh (Gmsh 2.2, text) or .vtk (legacy, text), depending on the file name's extension. Floats have
/// the same bits when they are read back; a mesh with an origin is written as doubles in the file's frame.
/// The file is replaced as in write_mesh().
///
/// @throws Error Unwritable, WrongFormat for any other extension, or InvalidMesh as
/// require_valid_tetrahedra() does
void write_tetrahedra(const std::filesystem::path& path, const TetrahedralMesh& mesh);

/// Reads the vertices of a model over time from a PC2 point cache; from a folder of OBJ files, one for each
/// sample, in the order of their names; or from the model's own glTF, GLB or 3DS file with an animation. A
/// PC2 file contains the frames of its samples; the files of a folder are frames 0, 1, 2 ...
///
/// An animation is sampled in each frame from 0 s to the first frame after all keys. Meshes with bones are
/// skinned (linear blend skinning; the weights of a vertex are normalised to a sum of 1), and others move
/// with their nodes; morph targets are applied first. Between two keys, positions, scales and weights of
/// morph targets are interpolated linearly, and rotations along the shorter arc; spline and step
/// interpolation are not supported. A 3DS file gives no frame rate; 25 frames per second are assumed. A cache
/// takes 12 bytes per vertex and sample.
///
/// @param mesh               the model, as returned by read_mesh()
/// @param frames_per_second  positive
/// @param animation          the name of the animation; may be empty if the file has only one
/// @throws Error as read_mesh() does; InvalidMesh if the number of vertices, or a face of a folder's mesh or
/// of a file with an animation, differs from the model's; if there is no animation, or there are several and
/// none is named; if the animation moves no vertex, moves a node with a matrix, or has keys out of order or
/// not finite; if a vertex of a mesh with bones has no bone; or if there are more than 2^28 positions. The
/// message begins with the path
VertexCache read_vertex_cache(const std::filesystem::path& path, const TriangleMesh& mesh,
                              double frames_per_second, std::string_view animation = {});

} // namespace echinus

ECHINUS_EXPORT_END
