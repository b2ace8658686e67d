#include "mechanics/membrane.hpp"

#include "mechanics/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace echinus {

float set_rest_shape(ElasticTriangle& triangle, const std::array<std::array<double, 2>, 3>& corners) {
    const auto edge = [&](std::size_t k, std::size_t axis) { return corners[k][axis] - corners[0][axis]; };
    const double twice_area = edge(1, 0) * edge(2, 1) - edge(1, 1) * edge(2, 0);
    const std::array<double, 3> warp{(edge(1, 1) - edge(2, 1)) / twice_area, edge(2, 1) / twice_area,
                                     -edge(1, 1) / twice_area};
    const std::array<double, 3> weft{(edge(2, 0) - edge(1, 0)) / twice_area, -edge(2, 0) / twice_area,
                                     edge(1, 0) / twice_area};
    for (std::size_t k = 0; k < 3; ++k) {
        triangle.warp[k] = static_cast<float>(warp[k]);
        triangle.weft[k] = static_cast<float>(weft[k]);
    }
    return triangle.area = static_cast<float>(twice_area / 2);
}

/// A triangle as its current positions deform it.
struct Membrane::State {
    Vec3d warp, weft; ///< the deformed directions Fu and Fv
    double warp_length, weft_length;
    double shear;                    ///< Fu.Fv
    double warp_stress, weft_stress; ///< along them, with damping: the derivative of the energy by e, over A
    double stiffening;               ///< 1 + damping / h
};

Membrane::Membrane(std::vector<ElasticTriangle> triangles, std::size_t particle_count)
    : triangles_(std::move(triangles)),
      slabs_(particle_count, triangles_.size(),
             [&](std::uint32_t triangle) { return triangles_[triangle].particles; }),
      extensions_before_(triangles_.size()) {}

void Membrane::couple(std::vector<Coupling>& blocks) const {
    for (const ElasticTriangle& triangle : triangles_)
        for (const std::uint32_t a : triangle.particles)
            for (const std::uint32_t b : triangle.particles) blocks.push_back({a, b});
}

void Membrane::find_entries(const BlockMatrix& matrix) {
    entries_.clear();
    for (const ElasticTriangle& triangle : triangles_) {
        std::array<std::uint32_t, 9>& entries = entries_.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                entries[3 * i + j] = matrix.find_block(triangle.particles[i], triangle.particles[j]);
    }
}

Membrane::State Membrane::state_of(std::uint32_t number, Places places) const {
    const ElasticTriangle& triangle = triangles_[number];
    State state{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d place = places[triangle.particles[k]];
        state.warp += place * double{triangle.warp[k]};
        state.weft += place * double{triangle.weft[k]};
    }
    state.warp_length = std::max(length(state.warp), threshold::kLeastExtension);
    state.weft_length = std::max(length(state.weft), threshold::kLeastExtension);
    state.shear = dot(state.warp, state.weft);
    const double share = double{triangle.damping} * inverse_step_;
    state.stiffening = 1 + share;
    const auto& before = extensions_before_[number];
    const double warp = (state.warp_length - 1) * state.stiffening - share * before[0];
    const double weft = (state.weft_length - 1) * state.stiffening - share * before[1];
    state.warp_stress = double{triangle.warp_stiffness} * warp + double{triangle.coupling} * weft;
    state.weft_stress = double{triangle.weft_stiffness} * weft + double{triangle.coupling} * warp;
    return state;
}

void Membrane::begin_step(Places places, double step) {
    inverse_step_ = 1 / step;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const State state = state_of(t, places);
        extensions_before_[t] = {state.warp_length - 1, state.weft_length - 1};
    }
}

double Membrane::energy(Places places, const Workers& workers) const {
    return sum_of(triangles_.size(), workers, [&](std::size_t t) {
        const ElasticTriangle& triangle = triangles_[t];
        const State state = state_of(static_cast<std::uint32_t>(t), places);
        const auto quadratic = [&](double warp, double weft) {
            return double{triangle.warp_stiffness} * warp * warp +
                   double{triangle.weft_stiffness} * weft * weft +
                   2 * double{triangle.coupling} * warp * weft;
        };
        const double warp = state.warp_length - 1, weft = state.weft_length - 1;
        const auto& before = extensions_before_[t];
        return double{triangle.area} / 2 *
               (quadratic(warp, weft) + double{triangle.shear_stiffness} * state.shear * state.shear +
                (state.stiffening - 1) * quadratic(warp - before[0], weft - before[1]));
    });
}

namespace {

/// Adds the gradient of a triangle's energy, given its derivatives with respect to the deformed directions.
void scatter(const ElasticTriangle& triangle, const Vec3d& by_warp, const Vec3d& by_weft, const RowSlab& slab,
             std::span<Vec3d> gradient) {
    for (std::size_t k = 0; k < 3; ++k)
        if (slab.has(triangle.particles[k]))
            gradient[triangle.particles[k]] +=
                by_warp * double{triangle.warp[k]} + by_weft * double{triangle.weft[k]};
}

} // namespace

void Membrane::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                               const Workers& workers) const {
    slabs_.for_each(workers, [&](std::uint32_t t, const RowSlab& slab) {
        const ElasticTriangle& triangle = triangles_[t];
        const State s = state_of(t, places);
        const double area = double{triangle.area}, shear = area * double{triangle.shear_stiffness} * s.shear;
        scatter(triangle, s.warp * (area * s.warp_stress / s.warp_length) + s.weft * shear,
                s.weft * (area * s.weft_stress / s.weft_length) + s.warp * shear, slab, gradient);
        if (hessian != nullptr) add_hessian(t, s, slab, *hessian);
    });
}

void Membrane::add_hessian(std::uint32_t number, const State& s, const RowSlab& slab,
                           BlockMatrix& hessian) const {
    const ElasticTriangle& triangle = triangles_[number];
    const float area = triangle.area;
    const auto stiffening = static_cast<float>(s.stiffening);
    // Tension resists rotation; the contribution of compression is negative and left out.
    const auto warp_turning = static_cast<float>(std::max(s.warp_stress / s.warp_length, 0.0));
    const auto weft_turning = static_cast<float>(std::max(s.weft_stress / s.weft_length, 0.0));
    const Float4 warp(s.warp * (1 / s.warp_length)), weft(s.weft * (1 / s.weft_length));
    const Float4 deformed_warp(s.warp), deformed_weft(s.weft);
    const float warp_along = area * (triangle.warp_stiffness * stiffening - warp_turning);
    const float weft_along = area * (triangle.weft_stiffness * stiffening - weft_turning);
    const float coupled = area * triangle.coupling * stiffening;
    const float sheared = area * triangle.shear_stiffness;
    std::array<Float4, 3> shear; // derivatives of Fu.Fv
    for (std::size_t k = 0; k < 3; ++k)
        shear[k] = deformed_weft * triangle.warp[k] + deformed_warp * triangle.weft[k];
    for (std::size_t i = 0; i < 3; ++i) {
        if (!slab.has(triangle.particles[i])) continue;
        const Float4 by_warp = warp * (warp_along * triangle.warp[i]) + weft * (coupled * triangle.weft[i]);
        const Float4 by_weft = weft * (weft_along * triangle.weft[i]) + warp * (coupled * triangle.warp[i]);
        const Float4 by_shear = shear[i] * sheared;
        for (std::size_t j = 0; j < 3; ++j) {
            Block& block = hessian.blocks.values[entries_[number][3 * i + j]];
            block.add_outer(by_warp, warp * triangle.warp[j]);
            block.add_outer(by_weft, weft * triangle.weft[j]);
            block.add_outer(by_shear, shear[j]);
            block.add_identity(area * (warp_turning * triangle.warp[i] * triangle.warp[j] +
                                       weft_turning * triangle.weft[i] * triangle.weft[j]));
        }
    }
}

} // namespace echinus
