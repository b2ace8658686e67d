#include "simulation/wind.hpp"

namespace echinus {

void Wind::blow(std::span<const Triangle> faces, const Vec3f& wind_step, float share, Particles& particles) {
    gusts_.assign(particles.count(), Gust{});
    const auto step_of = [&](std::uint32_t i) { return particles.step(i); };
    for (const auto& [a, b, c] : faces) {
        const Vec3f pa = particles.positions[a], pb = particles.positions[b], pc = particles.positions[c];
        const Vec3f normal = cross(pb - pa, pc - pa);
        const float normal_sq = dot(normal, normal);
        if (!(normal_sq > 0)) continue;
        const Vec3f step = (step_of(a) + step_of(b) + step_of(c)) * (1.0F / 3);
        const Vec3f across = normal * (dot(wind_step - step, normal) / normal_sq);
        for (const std::uint32_t corner : {a, b, c}) gusts_[corner].add(across);
    }
    for (std::size_t i = 0; i < gusts_.size(); ++i)
        if (gusts_[i].face_count != 0 && !particles.pinned(i))
            particles.move_previous(i, -(gusts_[i].mean() * share));
}

} // namespace echinus
