#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

/// The three sets of particles on which Echinus measures itself. They depend on the mesh, the count and the
/// seed alone and have the same bits on every machine, so that a wrong answer can be named by its number.
namespace echinus::test {

/// U: uniform in the bounding sphere.
std::vector<Vec3f> uniform_points(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed = 1);

/// S, near the surface: uniform by area on it, moved along the face's normal by N(0, `spread` R).
/// @pre the mesh has a face with an area
std::vector<Vec3f> surface_points(const TriangleMesh& mesh, std::size_t count, double spread = 0.01,
                                  std::uint64_t seed = 2);

enum class Axis : std::uint8_t { X, Y, Z };

/// C, like a cloth: a sheet of `columns` x `rows` points over the model's rectangle seen from above, at the
/// height of the topmost surface, on the model's floor where there is none; then smoothed, so that it cuts
/// in. Row by row.
/// @param smoothing  standard deviation of the smoothing, in widths of the sheet
std::vector<Vec3f> cloth_points(const TriangleMesh& mesh, std::size_t columns, std::size_t rows, Axis up,
                                double smoothing = 0.01);

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
