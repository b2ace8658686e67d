#include "rivals/superquadric_map/superquadric_map.hpp"
#include "support/point_sets.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

using namespace echinus;
using namespace echinus::rivals;

TEST(SuperquadricMapOfTheHorse, HasSeventeenSegmentsOnRequestAndTellsMostParticlesRight) {
    const std::filesystem::path file = std::filesystem::path(ECHINUS_SHARED_MESHES) / "horse_6k.obj";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const TriangleMesh horse = read_mesh(file);
    SuperquadricMapOptions options;
    options.segment_count = 17;
    options.decomposition_face_limit = 3000; // for the sake of time
    const SuperquadricMap map = SuperquadricMap::build(horse, options);
    EXPECT_EQ(map.segment_count(), 17U);
    EXPECT_LT(map.report().uncovered_area_share, 0.04);

    const ExactMap exact = ExactMap::build(horse);
    const auto wrong_share = [&](const std::vector<Vec3f>& points) {
        std::size_t wrong = 0;
        for (const Vec3f& p : points) wrong += map.contains(p) != contains(exact, p) ? 1 : 0;
        return static_cast<double>(wrong) / static_cast<double>(points.size());
    };
    EXPECT_LT(wrong_share(test::uniform_points(horse, 20'000)), 0.002);
    EXPECT_LT(wrong_share(test::surface_points(horse, 20'000)), 0.04);
}
