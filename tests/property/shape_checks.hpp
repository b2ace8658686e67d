#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace echinus::test {

/// The findings of checks of shapes so far.
struct ShapeFindings {
    std::size_t shapes = 0, faces = 0;
    std::size_t left_out = 0;   ///< shapes that enclose nothing or, for tetrahedra, are too thin
    std::size_t unreadable = 0; ///< shapes whose map cannot be read back
    std::size_t wrong = 0;      ///< shapes with a wrong answer of another kind
    std::size_t answers = 0;    ///< that were judged
    std::size_t wrong_answers = 0;
    double worst_distance = 0; ///< greatest difference from the true distance, in bounding radii
    double worst_volume = 0;   ///< greatest difference of a body of tetrahedra from the volume, as a share

    struct Failure {
        std::uint64_t seed = 0;
        std::string what; ///< the first that is wrong
        std::string kind; ///< the same for everything that is wrong in the same way
    };
    std::vector<Failure> failures;

    void add(const ShapeFindings& others);
};

/// One of the kinds of checks. Each looks at a mesh, makes further decisions by the seed, and adds what it
/// finds.
using ShapeCheck = void (*)(const TriangleMesh& mesh, std::uint64_t seed, ShapeFindings& findings);

/// Sides, single and in batches, and depths of an exact map with options of the seed, for points where maps
/// fail; then the map is written, read and asked again.
void check_sides(const TriangleMesh& mesh, std::uint64_t seed, ShapeFindings& findings);
/// Contacts, signed distances, winding numbers, sweeps of points and triangles, clearances, rebuilt maps, and
/// the paper's distance map.
void check_queries(const TriangleMesh& mesh, std::uint64_t seed, ShapeFindings& findings);
/// The volume of tetrahedralize(), with a size of volume / area, and half of it as long as that is not small
/// enough to keep within 3 %. Shapes for which that takes more than some 10^6 tetrahedra are left out.
void check_tetrahedra(const TriangleMesh& mesh, std::uint64_t seed, ShapeFindings& findings);

/// The smallest mesh found by leaving out parts, joining vertices and rounding coordinates that still fails
/// in the same way.
TriangleMesh shrunk(TriangleMesh mesh, const ShapeFindings::Failure& failure, ShapeCheck check);

/// As many digits as tell a float from all others.
std::string shortest_text(float number);

/// The used part of a mesh as OBJ text, with all digits of its coordinates.
std::string obj_text(const TriangleMesh& mesh);

} // namespace echinus::test
