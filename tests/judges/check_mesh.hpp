#pragma once

#include "judges/check_result.hpp"
#include "support/point_sets.hpp"

#include <echinus/mesh.hpp>

#include <functional>
#include <string>
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

struct CheckOptions {
    std::size_t points = 10'000'000;
    std::vector<InsideRule> rules{InsideRule::Nonzero, InsideRule::Parity};
    ExactMapOptions map; ///< each of `rules` replaces its rule
    std::uint64_t seed = 1;
    unsigned thread_count = 0; ///< 0: all cores
    /// Called from time to time with the share of the points judged so far.
    std::function<void(double fraction)> report_progress = {};
};

/// Queries a map.
Defendant defendant_of(const ExactMap& map);

/// Builds a map for each rule and judges them on four sets of points: uniform in the bounding sphere, near
/// the surface, cloth-like and adversarial. For an open surface only the rule Nonzero is judged: parity is
/// not defined there.
CheckResult check_mesh(const std::string& name, const TriangleMesh& mesh, const CheckOptions& options);

} // namespace echinus::test
