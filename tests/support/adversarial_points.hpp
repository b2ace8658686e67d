#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus::test {

/// The properties of an exact map that its adversarial points depend on.
struct MapFrame {
    Vec3f centre;
    float radius = 0;
    std::uint32_t divisions = 1; ///< of each octant

    double step() const { return static_cast<double>(radius) * 0x1p-19; }
};

/// Points where maps of directions are likely to fail, of all kinds in turn: on vertices, edges and faces; on
/// rays from the centre through vertices and edges; on the coordinate planes through the centre and on the
/// walls of cells; near faces seen edge-on; within a few lattice steps of the surface and of its lattice
/// vertices; the centre and its neighbours. Same arguments, same bits.
/// @pre the mesh has faces
std::vector<Vec3f> adversarial_points(const TriangleMesh& mesh, const MapFrame& frame, std::size_t count,
                                      std::uint64_t seed);

} // namespace echinus::test
