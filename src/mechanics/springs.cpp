#include "mechanics/springs.hpp"

#include <algorithm>
#include <utility>

namespace echinus {

Springs::Springs(std::vector<ElasticSpring> springs, std::size_t particle_count)
    : springs_(std::move(springs)), slabs_(particle_count, springs_.size(),
                                           [&](std::uint32_t s) {
                                               return std::array{springs_[s].a, springs_[s].b};
                                           }),
      lengths_before_(springs_.size()) {}

void Springs::couple(std::vector<Coupling>& blocks) const {
    for (const ElasticSpring& spring : springs_) {
        blocks.push_back({spring.a, spring.b});
        blocks.push_back({spring.b, spring.a});
    }
}

void Springs::find_entries(const BlockMatrix& matrix) {
    entries_.clear();
    for (const ElasticSpring& s : springs_)
        entries_.push_back({matrix.find_block(s.a, s.a), matrix.find_block(s.a, s.b),
                            matrix.find_block(s.b, s.a), matrix.find_block(s.b, s.b)});
}

void Springs::begin_step(Places places, double step) {
    inverse_step_ = 1 / step;
    for (std::size_t s = 0; s < springs_.size(); ++s)
        lengths_before_[s] = length(places[springs_[s].b] - places[springs_[s].a]);
}

double Springs::energy(Places places, const Workers& workers) const {
    return sum_of(springs_.size(), workers, [&](std::size_t s) {
        const ElasticSpring& spring = springs_[s];
        const double now = length(places[spring.b] - places[spring.a]);
        const double extension = now - double{spring.rest_length}, change = now - lengths_before_[s];
        return double{spring.stiffness} / 2 *
               (extension * extension + double{spring.damping} * inverse_step_ * change * change);
    });
}

void Springs::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                              const Workers& workers) const {
    slabs_.for_each(workers, [&](std::uint32_t s, const RowSlab& slab) {
        const ElasticSpring& spring = springs_[s];
        const Vec3d across = places[spring.b] - places[spring.a];
        const double now = length(across);
        if (!(now > 0)) return; // it has no direction
        const Vec3d direction = across * (1 / now);
        const double stiffness = double{spring.stiffness}, share = double{spring.damping} * inverse_step_;
        const double tension =
            stiffness * (now - double{spring.rest_length} + share * (now - lengths_before_[s]));
        const double turning = std::max(tension / now, 0.0);
        Block block;
        if (hessian != nullptr) {
            block.add_outer(Float4(direction * (stiffness * (1 + share) - turning)), Float4(direction));
            block.add_identity(static_cast<float>(turning));
        }
        const auto add = [&](std::uint32_t particle, double sign, std::size_t own, std::size_t other) {
            if (!slab.has(particle)) return;
            gradient[particle] += direction * (sign * tension);
            if (hessian == nullptr) return;
            hessian->blocks.values[entries_[s][own]] += block;
            hessian->blocks.values[entries_[s][other]] -= block;
        };
        add(spring.a, -1, 0, 1);
        add(spring.b, 1, 3, 2);
    });
}

} // namespace echinus
