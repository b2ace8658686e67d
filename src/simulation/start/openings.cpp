#include "simulation/start/openings.hpp"

#include <algorithm>

namespace echinus {

namespace {

double missing(const Opening& opening, Places places) {
    double gap = 0;
    for (std::size_t k = 0; k < Opening::kMostParts; ++k)
        gap += opening.weights[k] * dot(opening.normal, places[opening.particles[k]]);
    return std::max(opening.least - gap, 0.0);
}

} // namespace

double Openings::energy(Places places, const Workers& workers) const {
    return sum_of(all.size(), workers, [&](std::size_t i) {
        const double length = missing(all[i], places);
        return all[i].stiffness / 2 * length * length;
    });
}

void Openings::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                               const Workers&) const {
    for (const Opening& opening : all) {
        const double length = missing(opening, places);
        if (length == 0) continue;
        const Float4 normal(opening.normal);
        Block block;
        block.add_outer(normal * static_cast<float>(opening.stiffness), normal);
        for (std::size_t k = 0; k < Opening::kMostParts; ++k) {
            if (opening.weights[k] == 0) continue;
            const std::uint32_t i = opening.particles[k];
            gradient[i] -= opening.normal * (opening.stiffness * length * opening.weights[k]);
            if (hessian == nullptr) continue;
            for (std::size_t l = 0; l < Opening::kMostParts; ++l)
                if (opening.weights[l] != 0)
                    hessian->add_coupling({i, opening.particles[l]}, block,
                                          static_cast<float>(opening.weights[k] * opening.weights[l]));
        }
    }
    if (hessian != nullptr) hessian->set_contacts();
}

} // namespace echinus
