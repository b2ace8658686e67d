#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus::rivals {

/// A mesh with fewer faces. Each is one of the original's, at corners that may have moved to other vertices.
struct SimplifiedMesh {
    TriangleMesh mesh;                       ///< the vertices are all of the original's
    std::vector<std::uint32_t> face_numbers; ///< [face_count] in the original, ascending
};

/// Collapses edges, each time the one that moves the surface least by the quadric error of Garland and
/// Heckbert
/// ("Surface simplification using quadric error metrics", SIGGRAPH 1997), one end onto the other, until at
/// most so many faces are left or no edge can go without turning a face over or changing the topology. Faces
/// without an area are left out first. Time O(n log n). The same mesh gives the same result.
/// @pre indices are in range, positions finite
SimplifiedMesh simplify(const TriangleMesh& mesh, std::size_t face_limit);

/// Which segment each face belongs to.
struct Decomposition {
    std::uint32_t segment_count = 0;
    std::vector<std::uint32_t> segment_of_face; ///< [face_count] numbered in the order of their first faces
};

struct DecompositionOptions {
    /// Merge until so many are left; 0: until none can be merged within `concavity`.
    std::uint32_t segment_count = 0;
    double concavity = 0.05; ///< of the longest diagonal of the mesh's box; looked at when segment_count is 0
    std::uint32_t face_limit = 6000; ///< more are simplified
};

/// Cuts a surface into nearly convex segments by hierarchical approximate convex decomposition (HACD: Mamou
/// and Ghorbel, "A simple and efficient approach for 3D mesh approximate convex decomposition", ICIP 2009),
/// as Bullet's extras have it: faces are merged pair by pair, each time the pair whose union is nearest to
/// its convex hull.
///
/// HACD takes 5 s for a horse of 6000 faces and 74 s for an armadillo of 52 000, and more where most vertices
/// are on hulls: 0.3, 0.9 and 2.6 s for spheres of 500, 1000 and 2000 faces. It cannot be stopped between its
/// reports. So a mesh of more than `face_limit` faces is simplified first, and each face of the original
/// belongs to the segment of the face it became or, where it vanished, of the nearest one from edge to edge.
/// Segments of a simplified mesh are less good: of the horse in 17 segments, 2.4 % of the particles near the
/// surface are on the wrong side with 4000 faces, 1.7 % with all 6000.
///
/// HACD cannot reach a count below that of the parts of a mesh that are farther than 1.5 % of the diagonal
/// from each other: then there is a segment for each. Nor can there be more segments than faces.
///
/// @param mesh  welded, with indices in range and finite positions
/// @throws Error InvalidMesh when no face has an area or when the mesh cannot be simplified to four times
/// face_limit, as many parts or edges with more than two faces may cause
Decomposition decompose(const TriangleMesh& mesh, const DecompositionOptions& options,
                        const Progress& progress = {});

} // namespace echinus::rivals
