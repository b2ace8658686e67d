// step() allocates nothing: counted by this program's own operator new.

#include "support/custom_maps.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

namespace {

std::atomic<std::size_t> allocation_count{0};

} // namespace

// Under a sanitizer, which has an operator new of its own, GCC does not see that these two belong together.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size) {
    ++allocation_count;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

using namespace echinus;

TEST(Step, AllocatesNothingBesideAnyKindOfMap) {
    const TriangleMesh plate = make_box({1.5, 1.5, 0.001});
    const Vec3d down{0, 0, -0.1};
    Deformable sheet = make_cloth({.column_count = 20, .row_count = 20, .pose = {Rotation{}, {0, 0, 0.5}}});
    for (Vec3f& previous : sheet.previous_positions) previous -= Vec3f(down);
    Simulation simulation(
        sheet,
        {{.map = ExactMap::build(plate), .linear_velocity = {0.5, 0, 5}, .angular_velocity = {4, 18, 2}},
         {.map = ExactMap::build(make_box({1, 1, 1})), .pose = {Rotation{}, {0, 0, -2}}},
         {.map = DistanceMap::build(make_box({1, 1, 1})), .pose = {Rotation{}, {3, 0, 0}}},
         {.map = std::make_shared<test::AnalyticBall>(0.3F), .pose = {Rotation{}, {0.3, 0.2, -0.5}}}},
        {.thickness = 0.01});
    const std::size_t before = allocation_count;
    EXPECT_GT(before, 0u);
    for (int i = 0; i < 100; ++i) simulation.step();
    EXPECT_EQ(allocation_count, before);
    EXPECT_GT(simulation.profile().rescued_count, 0u);
}
