// Collision for a solver of one's own in C is that of C++ bit for bit.

#include "handles.hpp"

#include <echinus/particle_collision.hpp>
#include <echinus/surface_collision.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr double kThickness = 0.02, kSeconds = 1.0 / 60;

/// A solver: everything falls.
struct Falling {
    std::vector<Vec3f> positions = make_torus(0.8, 0.1, 12, 6).vertices;
    std::vector<Triangle> faces = make_torus(0.8, 0.1, 12, 6).faces;
    std::vector<Vec3f> previous, velocities = std::vector<Vec3f>(positions.size());
    std::vector<float> inverse_masses = std::vector<float>(positions.size(), 1);

    Falling() {
        for (Vec3f& p : positions) p.z += 0.8F;
        inverse_masses[3] = 0;
    }
    void move() {
        previous = positions;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            velocities[i].z -= 9.81F * float(kSeconds);
            positions[i] += velocities[i] * float(kSeconds);
        }
    }
    bool operator==(const Falling&) const = default;
};

template <typename T>
auto* numbers(std::vector<Vec3<T>>& vectors) {
    return &vectors.front().x;
}

RigidTransform pose_after(int step) {
    return {Rotation::about({0, 0, 1}, 0.02 * step), {0, 0, 0.001 * step}};
}
echinus_pose c_pose_after(int step) {
    const auto [r, t] = pose_after(step);
    return {{r.w, r.x, r.y, r.z}, {t.x, t.y, t.z}};
}

} // namespace

TEST(CCollision, CorrectsParticlesAsCppDoes) {
    const CMesh mesh = c_torus();
    const CMap map = c_map(mesh);
    echinus_collider collider;
    echinus_collider_init(&collider, sizeof collider, map.get());
    CParticleCollision collision;
    expect_ok(echinus_particle_collision_create(&collider, 1, kThickness, nullptr, out(collision)));
    expect_ok(echinus_particle_collision_set_collider_friction(collision.get(), 0, 0.2));
    ParticleCollision by_cpp({{.map = ExactMap::build(make_torus(1.0, 0.4, 60, 24))}}, kThickness);
    by_cpp.set_collider_friction(0, 0.2);
    Falling falling, expected;
    std::size_t corrected_count = 0;
    for (int n = 0; n < 60; ++n) {
        falling.move();
        expected.move();
        const echinus_pose pose = c_pose_after(n);
        const auto set = n == 30 ? echinus_particle_collision_place_collider
                                 : echinus_particle_collision_set_collider_pose;
        expect_ok(set(collision.get(), 0, &pose));
        if (n == 30)
            by_cpp.place_collider(0, pose_after(n));
        else
            by_cpp.set_collider_pose(0, pose_after(n));
        const std::uint32_t* corrected = nullptr;
        std::size_t count = 0;
        expect_ok(echinus_particle_collision_correct(collision.get(), numbers(falling.previous),
                                                     numbers(falling.positions), numbers(falling.velocities),
                                                     falling.inverse_masses.data(), falling.positions.size(),
                                                     kSeconds, &corrected, &count));
        const auto by_cpp_corrected = by_cpp.correct(
            {expected.previous, expected.positions, expected.velocities, expected.inverse_masses}, kSeconds);
        ASSERT_TRUE(std::ranges::equal(std::span(corrected, count), by_cpp_corrected));
        ASSERT_EQ(falling, expected);
        corrected_count += count;
    }
    EXPECT_GT(corrected_count, 0u);
    EXPECT_EQ(echinus_particle_collision_lost_count(collision.get()), by_cpp.lost_count());
}

TEST(CCollision, CorrectsSurfacesAsCppDoes) {
    const CMesh mesh = c_torus();
    const CMap map = c_map(mesh);
    echinus_collider collider;
    echinus_collider_init(&collider, sizeof collider, map.get());
    Falling falling, expected;
    CSurfaceCollision collision;
    expect_ok(echinus_surface_collision_create(numbers(falling.positions), falling.positions.size(),
                                               falling.faces.front().data(), falling.faces.size(), &collider,
                                               1, kThickness, nullptr, out(collision)));
    SurfaceCollision by_cpp(expected.positions, expected.faces,
                            {{.map = ExactMap::build(make_torus(1.0, 0.4, 60, 24))}}, kThickness);
    std::size_t corrected_count = 0;
    for (int n = 0; n < 30; ++n) {
        falling.move();
        expected.move();
        const echinus_pose pose = c_pose_after(n);
        expect_ok(echinus_surface_collision_set_collider_pose(collision.get(), 0, &pose));
        by_cpp.set_collider_pose(0, pose_after(n));
        const std::uint32_t* corrected = nullptr;
        std::size_t count = 0;
        expect_ok(echinus_surface_collision_correct(collision.get(), numbers(falling.positions),
                                                    numbers(falling.velocities), falling.positions.size(),
                                                    kSeconds, &corrected, &count));
        const auto by_cpp_corrected = by_cpp.correct(expected.positions, expected.velocities, kSeconds);
        ASSERT_TRUE(std::ranges::equal(std::span(corrected, count), by_cpp_corrected));
        ASSERT_EQ(falling, expected);
        corrected_count += count;
    }
    EXPECT_GT(corrected_count, 0u);
    EXPECT_EQ(std::memcmp(echinus_surface_collision_positions(collision.get()), by_cpp.positions().data(),
                          by_cpp.positions().size() * sizeof(Vec3f)),
              0);
    EXPECT_EQ(echinus_surface_collision_unresolved_count(collision.get()), by_cpp.unresolved_count());
}
