#include "mechanics/pressure.hpp"

#include <cstddef>
#include <utility>

namespace echinus {

Pressure::Pressure(std::vector<PressedTriangle> triangles, std::size_t particle_count)
    : triangles_(std::move(triangles)),
      slabs_(particle_count, triangles_.size(), [&](std::uint32_t t) { return triangles_[t].particles; }) {}

void Pressure::begin_step(Places places) {
    if (!triangles_.empty()) origin_ = places[triangles_.front().particles[0]];
}

double Pressure::energy(Places places, const Workers& workers) const {
    return sum_of(triangles_.size(), workers, [&](std::size_t t) {
        const auto& [a, b, c] = triangles_[t].particles;
        const Vec3d to_a = places[a] - origin_, to_b = places[b] - origin_, to_c = places[c] - origin_;
        return -triangles_[t].pressure / 6 * dot(to_a, cross(to_b, to_c));
    });
}

void Pressure::add_gradient(Places places, std::span<Vec3d> gradient, const Workers& workers) const {
    slabs_.for_each(workers, [&](std::uint32_t t, const RowSlab& slab) {
        const PressedTriangle& triangle = triangles_[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = triangle.particles[k];
            if (!slab.has(corner)) continue;
            const Vec3d next = places[triangle.particles[(k + 1) % 3]] - origin_,
                        last = places[triangle.particles[(k + 2) % 3]] - origin_;
            gradient[corner] -= cross(next, last) * (triangle.pressure / 6);
        }
    });
}

} // namespace echinus
