#pragma once

#include "oracle/adversarial_points.hpp"

#include <functional>
#include <vector>

namespace echinus::test {

struct PointSet {
    const char* name;
    std::function<std::vector<Vec3f>()> make; ///< made when it is needed: a set of millions takes room
};

/// The four sets that echinus-check asks about, `count` points together, a quarter each but for rounding:
/// uniform in the bounding sphere, near the surface, cloth-like and adversarial. The mesh must live as long.
std::vector<PointSet> point_sets(const TriangleMesh& mesh, const MapFrame& frame, std::size_t count,
                                 std::uint64_t seed);

} // namespace echinus::test
