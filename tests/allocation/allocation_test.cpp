#include "support/custom_maps.hpp"
#include "support/meshes.hpp"
#include "support/saved_state_attack.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/particle_collision.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

using namespace echinus;

// An operator new of the program's own counts what it allocates.

namespace {

std::atomic<std::size_t> allocation_count{0}, held_bytes{0}, most_held_bytes{0};

void raise_most_held_bytes(std::size_t held) {
    std::size_t most = most_held_bytes;
    while (most < held && !most_held_bytes.compare_exchange_weak(most, held)) {
    }
}

} // namespace

// Under a sanitizer, which has an operator new of its own, GCC does not see that these two belong together.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    void* const memory = std::malloc(size == 0 ? 1 : size);
    if (memory == nullptr) return nullptr;
    ++allocation_count;
    raise_most_held_bytes(held_bytes += malloc_usable_size(memory));
    return memory;
}
void* operator new(std::size_t size) {
    void* const memory = operator new(size, std::nothrow);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept {
    held_bytes -= malloc_usable_size(memory); // 0 of nothing
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    operator delete(memory);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    const std::size_t unit = static_cast<std::size_t>(alignment);
    void* const memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit);
    if (memory == nullptr) throw std::bad_alloc();
    ++allocation_count;
    raise_most_held_bytes(held_bytes += malloc_usable_size(memory));
    return memory;
}
void operator delete(void* memory, std::align_val_t) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    operator delete(memory);
}

namespace {

/// The most memory that was held at a time since the beginning of this object's life, beyond what was held
/// then. One at a time.
class PeakOfHeldBytes {
  public:
    PeakOfHeldBytes() : before_(held_bytes) { most_held_bytes = before_; }
    std::size_t get() const { return most_held_bytes - before_; }

  private:
    std::size_t before_;
};

} // namespace

// step() allocates nothing, and what a saved state says takes no more memory than its bytes do.

TEST(Step, AllocatesNothingBesideAnyKindOfMap) {
    const TriangleMesh plate = make_box({1.5, 1.5, 0.001});
    const Vec3d down{0, 0, -24};
    Deformable sheet = make_cloth({.column_count = 20, .row_count = 20, .pose = {Rotation{}, {0, 0, 0.5}}});
    sheet.velocities.assign(sheet.particle_count(), Vec3f(down));
    sheet.inverse_masses[0] = 0;
    sheet.attachments = {{0, 0}};
    const std::vector<Collider> colliders{
        {.map = ExactMap::build(plate), .linear_velocity = {0.5, 0, 5}, .angular_velocity = {4, 18, 2}},
        {.map = ExactMap::build(make_box({1, 1, 1})), .pose = {Rotation{}, {0, 0, -2}}},
        {.map = DistanceMap::build(make_box({1, 1, 1})), .pose = {Rotation{}, {3, 0, 0}}},
        {.map = std::make_shared<test::AnalyticBall>(0.3F), .pose = {Rotation{}, {0.3, 0.2, -0.5}}}};
    Simulation simulation(sheet, colliders,
                          {.solver = JakobsenOptions{}, .time_step = 1.0 / 240, .thickness = 0.01});
    // A thread's first batches allocate what it keeps for the others.
    std::vector<Contact> contacts(sheet.particle_count());
    for (int i = 0; i < 2; ++i)
        for (const Collider& collider : colliders) contacts_batch(collider, sheet.positions, 1, contacts);
    const std::size_t before = allocation_count;
    EXPECT_GT(before, 0u);
    for (int i = 0; i < 100; ++i) simulation.step();
    EXPECT_EQ(allocation_count, before);
    EXPECT_GT(simulation.profile().rescued_count, 0u);
}

TEST(Step, AllocatesNothingOnceItHasSeenItsLargest) {
    const auto box = ExactMap::build(make_box({0.4, 0.4, 0.4}));
    const auto ball = DistanceMap::build(make_sphere(0.2, 16, 8));
    SimulationOptions options{.thickness = 0.01};
    options.newton().material.damping = 0.3; // to hang still soon
    Simulation simulation(
        make_cloth({.column_count = 20, .row_count = 20, .pose = {Rotation{}, {0, 0, 0.22}}}),
        {{.map = box}, {.map = ball, .pose = {Rotation{}, {0.3, 0.3, 0}}, .angular_velocity = {0, 0, 1e-4}}},
        options);
    for (int i = 0; i < 240; ++i) simulation.step();
    const std::size_t before = allocation_count;
    for (int i = 0; i < 30; ++i) simulation.step();
    EXPECT_EQ(allocation_count, before);
    EXPECT_GT(simulation.profile().contact_count, 0u);
}

TEST(ParticleCollision, AllocatesNothingAfterTheFirstStepBesideAnyKindOfMap) {
    ParticleCollision collision(
        {{.map = ExactMap::build(make_box({1.5, 1.5, 0.001}))},
         {.map = DistanceMap::build(make_box({1, 1, 1})), .pose = {Rotation{}, {3, 0, 0}}},
         {.map = std::make_shared<test::AnalyticBall>(0.3F)}},
        0.01);
    std::vector<Vec3f> positions, velocities(400);
    for (int i = 0; i < 400; ++i) positions.push_back({0.01F * i - 2, 0.1F * (i % 7), 0.5F});
    std::vector<Vec3f> previous = positions;
    std::size_t before = 0, corrected_count = 0;
    for (int n = 0; n < 100; ++n) {
        previous = positions;
        for (std::size_t i = 0; i < 400; ++i) {
            velocities[i].z -= 0.1F;
            positions[i] += velocities[i] * (1.0F / 60);
        }
        if (n == 50) previous[7].z = positions[7].z = 1; // begins anew
        collision.set_collider_pose(0, {Rotation::about({0, 1, 0}, 0.1 * n), {}});
        corrected_count += collision.correct({previous, positions, velocities}, 1.0 / 60).size();
        if (n == 0) before = allocation_count;
    }
    EXPECT_EQ(allocation_count, before);
    EXPECT_GT(corrected_count, 400u);
}

TEST(RestoreState, TakesMemoryForTheBytesThatAreThereWhateverCountsSay) {
    const std::vector<Simulation> fresh = test::simulations_to_attack();
    Simulation stepped = fresh[0];
    for (int i = 0; i < 8; ++i) stepped.step();
    const std::vector<std::byte> good = stepped.save_state();
    int refused = 0;
    const auto peak_of = [&](const std::vector<std::byte>& state) {
        Simulation simulation = fresh[0];
        const PeakOfHeldBytes peak;
        try {
            simulation.restore_state(state);
        } catch (const Error&) {
            ++refused;
        }
        return peak.get();
    };
    const std::size_t usual = peak_of(good);
    ASSERT_EQ(refused, 0);
    for (std::size_t i = test::kStateAt; i + 8 <= good.size(); i += 4) {
        std::vector<std::byte> forged = good;
        const std::uint64_t bytes_left = good.size() - i - 8;
        std::memcpy(forged.data() + i, &bytes_left, 8);
        test::mend_checksum(forged);
        // Items take about as much memory as bytes, and an array that grows twice that.
        ASSERT_LE(peak_of(forged), usual + 4 * good.size()) << i;
    }
    EXPECT_GT(refused, 100);
}

// The memory that a build takes for the moment.

namespace {

struct Built {
    std::size_t byte_count; ///< of the map
    std::size_t peak;       ///< held at a time while it was built, the map included
};

Built build(const TriangleMesh& mesh, const ExactMapOptions& options) {
    const PeakOfHeldBytes peak;
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
