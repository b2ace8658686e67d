#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <malloc.h>

#include <memory>

/// Rivals that only benchmarks link: CGAL's packages are under the GPL, and `echinus compare` gains little by
/// the others. Each is immutable and is asked as its users ask it.
namespace echinus::rivals {

/// "cgal": CGAL's tree of boxes, with exact predicates and rounded constructions. The side of a particle by a
/// ray parity (Side_of_triangle_mesh), and the nearest point.
/// @param mesh  closed; copied
/// @throws Error InvalidMesh as inspect() does, and for an open mesh
std::unique_ptr<const System> cgal_tree(const TriangleMesh& mesh);

/// "fcl": FCL's tree of oriented boxes with spheres (OBBRSS), asked for the distance of a tiny sphere. FCL
/// knows no inside of a mesh: the side is that of the nearest face, which errs where an edge or a vertex is
/// nearest. No contacts outside.
/// @throws Error as above
std::unique_ptr<const System> fcl_tree(const TriangleMesh& mesh);

/// "nanovdb": the signed distances of OpenVDB's meshToVolume, three samples deep outside and all of the
/// inside, as NanoVDB stores them: one block of memory. Trilinear interpolation. No contacts outside.
/// @param spacing  of the samples, in the mesh's unit
/// @throws Error as above
std::unique_ptr<const System> nano_field(const TriangleMesh& mesh, double spacing);

/// Bytes that the process has taken from the heap of the C library and not given back. Its growth while a
/// structure is built is what the structure weighs, for libraries that keep no account of their own.
inline std::size_t heap_bytes() {
    const auto info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

} // namespace echinus::rivals
