#pragma once

#include "oracle/check_result.hpp"

#include <echinus/mesh.hpp>

#include <functional>
#include <string>

namespace echinus::test {

struct CheckOptions {
    std::size_t points = 10'000'000;
    std::vector<InsideRule> rules{InsideRule::Nonzero, InsideRule::Parity};
    ExactMapOptions map; ///< its rule is set for each of `rules`
    std::uint64_t seed = 1;
    unsigned thread_count = 0; ///< 0: all cores
    /// Called now and then with the share of the points that are judged.
    std::function<void(double fraction)> report_progress = {};
};

/// Asks a map.
Defendant defendant_of(const ExactMap& map);

/// Builds a map for each rule and judges them on four sets of points: uniform in the bounding sphere, near
/// the surface, cloth-like and adversarial. Of an open surface only the rule Nonzero is judged: parity has no
/// truth there.
CheckResult check_mesh(const std::string& name, const TriangleMesh& mesh, const CheckOptions& options);

} // namespace echinus::test
