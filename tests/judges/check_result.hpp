#pragma once

#include "judges/accuracy.hpp"

#include <string>
#include <vector>

/// The results of echinus-check for one mesh.
namespace echinus::test {

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

/// What echinus-check prints (check_report.cpp).
std::string to_json(const CheckResult& result);
std::string to_text(const CheckResult& result);

} // namespace echinus::test
