#pragma once

#include "judges/check_mesh.hpp"

#include <gtest/gtest.h>

namespace echinus::test {

/// Fails unless all answers of a mesh's maps, one for each rule, are right at about this many points.
inline void expect_right_map(const std::string& name, const TriangleMesh& mesh, const ExactMapOptions& map,
                             std::size_t points) {
    const CheckResult result = check_mesh(name, mesh, {.points = points, .map = map});
    EXPECT_TRUE(result.right()) << name << ", " << result.divisions << " divisions";
    EXPECT_EQ(result.wrong_corners, 0U) << name;
    EXPECT_EQ(result.judges_disagree, 0U) << name;
    for (std::size_t rule = 0; rule < result.rules.size(); ++rule)
        for (const std::string& complaint : result.total(rule).complaints)
            ADD_FAILURE() << name << ", " << name_of(result.rules[rule]) << ": " << complaint;
}

} // namespace echinus::test
