// Collision for a solver of one's own: here one of position-based dynamics, a net of particles and threads,
// that knows nothing of models. After each of its steps, correct() puts its particles right.

#include <echinus/echinus.hpp>

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

namespace {

using namespace echinus;

constexpr std::uint32_t kSide = 24;
constexpr double kSeconds = 1.0 / 240;
constexpr float kSpacing = 0.06F;

struct Net {
    std::vector<Vec3f> positions, previous, velocities;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> threads;

    Net() {
        for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
            const auto row = static_cast<float>(i / kSide), column = static_cast<float>(i % kSide);
            positions.push_back({(column - 11.5F) * kSpacing, (row - 11.5F) * kSpacing, 0.6F});
            if (i % kSide + 1 < kSide) threads.emplace_back(i, i + 1);
            if (i + kSide < kSide * kSide) threads.emplace_back(i, i + kSide);
        }
        velocities.resize(positions.size());
    }
    void step() {
        previous = positions;
        for (std::size_t i = 0; i < positions.size(); ++i)
            positions[i] += (velocities[i] + Vec3f{0, 0, -9.81F * float(kSeconds)}) * float(kSeconds);
        for (int iteration = 0; iteration < 20; ++iteration)
            for (const auto& [a, b] : threads) {
                const Vec3f across = positions[b] - positions[a];
                const Vec3f half = across * (0.5F * (1 - kSpacing / length(across)));
                positions[a] += half;
                positions[b] -= half;
            }
        for (std::size_t i = 0; i < positions.size(); ++i)
            velocities[i] = (positions[i] - previous[i]) * float(1 / kSeconds);
    }
};

} // namespace

int main() {
    Net net;
    ParticleCollision collision({{.map = ExactMap::build(make_torus(0.5, 0.2, 48, 24))}}, kSpacing / 2);
    for (int n = 0; n < 480; ++n) {
        net.step();
        collision.set_collider_pose(0, {Rotation::about({0, 0, 1}, 0.5 * n * kSeconds), {}}); // it turns
        collision.correct({net.previous, net.positions, net.velocities}, kSeconds);
    }
    const auto is_inside = [&](const Vec3f& p) { return contains(collision.colliders()[0], p); };
    const auto is_lower = [](const Vec3f& a, const Vec3f& b) { return a.z < b.z; };
    std::printf("%d of %d particles inside; the lowest hangs at height %.2f\n",
                static_cast<int>(std::ranges::count_if(net.positions, is_inside)),
                static_cast<int>(net.positions.size()), std::ranges::min_element(net.positions, is_lower)->z);
}
