#include "simulation/start/separations.hpp"

#include <algorithm>

namespace echinus {

namespace {

double missing(const Separation& separation, Places places) {
    double gap = 0;
    for (std::size_t k = 0; k < Separation::kMostParts; ++k)
        gap += separation.weights[k] * dot(separation.normal, places[separation.particles[k]]);
    return std::max(separation.least - gap, 0.0);
}

} // namespace

double Separations::energy(Places places, const Workers& workers) const {
    return sum_of(all.size(), workers, [&](std::size_t i) {
        const double length = missing(all[i], places);
        return all[i].stiffness / 2 * length * length;
    });
}

void Separations::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                                  const Workers&) const {
    for (const Separation& separation : all) {
        const double length = missing(separation, places);
        if (length == 0) continue;
        const Float4 normal(separation.normal);
        Block block;
        block.add_outer(normal * static_cast<float>(separation.stiffness), normal);
        for (std::size_t k = 0; k < Separation::kMostParts; ++k) {
            if (separation.weights[k] == 0) continue;
            const std::uint32_t i = separation.particles[k];
            gradient[i] -= separation.normal * (separation.stiffness * length * separation.weights[k]);
            if (hessian == nullptr) continue;
            for (std::size_t l = 0; l < Separation::kMostParts; ++l)
                if (separation.weights[l] != 0)
                    hessian->add_coupling({i, separation.particles[l]}, block,
                                          static_cast<float>(separation.weights[k] * separation.weights[l]));
        }
    }
    if (hessian != nullptr) hessian->set_contacts();
}

} // namespace echinus
