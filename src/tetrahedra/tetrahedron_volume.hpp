#pragma once

#include <echinus/tetrahedra.hpp>

#include <cstddef>

namespace echinus {

/// Of a positive tetrahedron positive; in the cube of the mesh's unit.
inline double tetrahedron_volume(const TetrahedralMesh& mesh, std::size_t number) {
    const Tetrahedron& corners = mesh.tetrahedra[number];
    const Vec3d a(mesh.vertices[corners[0]]);
    const auto way_to = [&](std::size_t i) { return Vec3d(mesh.vertices[corners[i]]) - a; };
    return dot(cross(way_to(1), way_to(2)), way_to(3)) / 6;
}

} // namespace echinus
