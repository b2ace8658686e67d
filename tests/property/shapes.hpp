#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <string>

namespace echinus::test {

/// A closed, oriented mesh as designers make them.
struct Shape {
    std::uint64_t seed = 0;
    std::string recipe; ///< how it was made, in words
    TriangleMesh mesh;
};

/// The shape of a seed: boxes, prisms, profiles, pyramids, bodies of revolution and the like on a grid of
/// small whole numbers; alone, cut into wedges or tetrahedra, side by side, overlapping, nested, hollow,
/// doubled, arrayed or mirrored; then turned, welded, subdivided, flattened, scaled and moved. Winding
/// numbers may be any whole numbers. It has at most some 2000 faces, and mostly 10 to 100. The same seed
/// gives the same bits on every machine.
Shape make_shape(std::uint64_t seed);

} // namespace echinus::test
