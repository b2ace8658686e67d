#pragma once

#include "judges/accuracy.hpp"
#include "support/point_sets.hpp"

#include <echinus/mesh.hpp>

#include <functional>
#include <string>
#include <vector>

namespace echinus::test {

// The results of echinus-check for one mesh.

/// As given on the command line.
const char* name_of(InsideRule rule);

struct SetResult {
    std::string name;
    std::vector<Score> scores; ///< one per rule
};

struct CheckResult {
    std::string mesh;
    std::size_t face_count = 0;
    bool closed = true;
    std::uint32_t divisions = 0;
    std::size_t byte_count = 0;
    std::uint64_t seed = 0;
    std::vector<InsideRule> rules;
    std::vector<SetResult> sets;
    std::size_t wrong_corners = 0; ///< of the map, that differ from the mesh's snapped corners
    std::size_t compared_with_cgal = 0, judges_disagree = 0;
    double seconds = 0;

    Score total(std::size_t rule) const;
    /// Of the uniform points; 1 where the surface is closed.
    double certain_share() const;
    /// No answer is wrong, and all distances and normals are within the limits of docs/accuracy.md.
    bool right() const;
    /// All answers are right, and at least 90 % of the bounding sphere is certain.
    bool holds() const;
};

/// The report that echinus-check prints (check_report.cpp).
std::string to_json(const CheckResult& result);
std::string to_text(const CheckResult& result);

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
