// The memory that a build takes for the moment.

#include "allocation/allocations.hpp"
#include "support/crowded_meshes.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

using namespace echinus;

namespace {

struct Built {
    std::size_t byte_count; ///< of the map
    std::size_t peak;       ///< held at a time while it was built, the map included
};

Built build(const TriangleMesh& mesh, const ExactMapOptions& options) {
    const test::PeakOfHeldBytes peak;
    const ExactMap map = ExactMap::build(mesh, options);
    return {map.view().byte_count(), peak.get()};
}

} // namespace

TEST(ExactMapBuildMemory, GrowsWithTheFacesAndNotWithTheirSquare) {
    constexpr std::size_t kBytesPerFace = 10'000, kBytesPerMap = 1'000'000;
    const auto expect_little = [](const TriangleMesh& mesh, CentreChoice centre) {
        const Built built = build(mesh, {.centre = centre, .thread_count = 1});
        EXPECT_LE(built.byte_count, 512 * mesh.faces.size() + 65'536);
        EXPECT_LE(built.peak, kBytesPerFace * mesh.faces.size() + kBytesPerMap) << mesh.faces.size();
    };
    expect_little(test::make_comb(300), CentreChoice::Search);
    for (std::uint32_t count : {100U, 400U, 1600U}) {
        expect_little(test::make_fins(count), CentreChoice::BoundingSphere);
        expect_little(test::make_comb(count), CentreChoice::BoundingSphere);
    }
}

TEST(ExactMapBuildMemory, IsBoundedByTheBudget) {
    const TriangleMesh comb = test::make_comb(1000);
    for (std::size_t budget : {1'000'000U, 6'000'000U}) {
        const Built built = build(comb, {.byte_budget = budget, .thread_count = 1});
        EXPECT_LE(built.byte_count, budget);
        EXPECT_LE(built.peak, 14 * budget + 4'000'000);
    }
}
