#pragma once

#include "support/adversarial_points.hpp"

#include <functional>
#include <vector>

namespace echinus::test {

struct PointSet {
    const char* name;
    std::function<std::vector<Vec3f>()> make; ///< made on demand: a set of millions takes memory
};

/// The four sets of echinus-check, `count` points together, a quarter each up to rounding: uniform in the
/// bounding sphere, near the surface, cloth-like and adversarial. The mesh must outlive them.
std::vector<PointSet> point_sets(const TriangleMesh& mesh, const MapFrame& frame, std::size_t count,
                                 std::uint64_t seed);

} // namespace echinus::test
