#pragma once

#include "mesh_io/mesh_source.hpp"

#include <echinus/mesh.hpp>
#include <echinus/tetrahedra.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace echinus {

// The bytes of mesh files. Text has the shortest decimals that read back to the same float. Positions of a
// mesh with an origin are written as doubles, in the file's frame.
// @pre indices are in range

std::string encode_obj(const TriangleMesh& mesh);
/// An OBJ file with other positions for its vertices.
/// @param before  as read_mesh() reads it
/// @throws Error InvalidMesh for another number of vertices; WrongFormat for a vertex on several lines
std::string encode_moved_obj(const MeshSource& source, const TriangleMesh& before, const TriangleMesh& mesh);
/// The part of an OBJ file with edges that belong to no face.
std::string encode_obj_lines(std::span<const std::array<std::uint32_t, 2>> edges);
std::string encode_off(const TriangleMesh& mesh);
std::string encode_ply(const TriangleMesh& mesh); ///< binary, little endian

using Colour = std::array<std::uint8_t, 3>; ///< red, green, blue

/// The same with edges and with a colour for each vertex and each face, since some programs show only one of
/// the two; empty lists are omitted.
/// @pre as many colours as vertices and faces
std::string encode_painted_ply(const TriangleMesh& mesh, std::span<const Colour> vertex_colours,
                               std::span<const Colour> face_colours,
                               std::span<const std::array<std::uint32_t, 2>> edges);

std::string encode_stl(const TriangleMesh& mesh); ///< binary; text if the mesh has an origin. Normals are
                                                  ///< computed, 0 for faces without area

std::string encode_msh(const TetrahedralMesh& mesh); ///< version 2.2
std::string encode_vtk(const TetrahedralMesh& mesh); ///< legacy, an unstructured grid

} // namespace echinus
