#include "mechanics/neo_hookean.hpp"

#include "mechanics/small_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace echinus {

namespace {

/// The derivatives of the determinant with respect to the columns.
Matrix3 cofactors(const Matrix3& f) {
    return {cross(f[1], f[2]), cross(f[2], f[0]), cross(f[0], f[1])};
}

/// An eigenvector of the Hessian with respect to F, as a matrix, and its eigenvalue.
struct Mode {
    Matrix3 matrix;
    double value;
};

/// a b^T + sign * c d^T, times a factor.
Matrix3 combine(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d, double sign, double factor) {
    const std::array<double, 3> by_b{b.x, b.y, b.z}, by_d{d.x, d.y, d.z};
    Matrix3 result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = (a * by_b[k] + c * (sign * by_d[k])) * factor;
    return result;
}

/// The eigensystem of the energy density's Hessian (Smith et al. 2019, section 4.2): three twists, three
/// flips and three scalings.
std::array<Mode, 9> modes_of(const RotationVariantSvd& svd, double mu, double lambda) {
    const auto& [u, v, s] = svd;
    const double volume = s[0] * s[1] * s[2];
    const double pressure = lambda * (volume - 1) - mu;
    std::array<Mode, 9> modes;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        constexpr double kHalf = 1 / std::numbers::sqrt2;
        modes[2 * k] = {combine(u[i], v[j], u[j], v[i], -1, kHalf), mu + pressure * s[k]};
        modes[2 * k + 1] = {combine(u[i], v[j], u[j], v[i], 1, kHalf), mu - pressure * s[k]};
    }
    const std::array<double, 3> by_stretch{s[1] * s[2], s[2] * s[0], s[0] * s[1]};
    std::array<std::array<double, 3>, 3> scaling{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            scaling[i][j] = i == j ? mu + lambda * by_stretch[i] * by_stretch[i]
                                   : lambda * by_stretch[i] * by_stretch[j] + pressure * s[3 - i - j];
    const Eigensystem system = eigensystem(scaling);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::array<double, 3> weights{system.vectors[k].x, system.vectors[k].y, system.vectors[k].z};
        Matrix3 matrix{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::array<double, 3> by_v{v[i].x, v[i].y, v[i].z};
            for (std::size_t c = 0; c < 3; ++c) matrix[c] += u[i] * (weights[i] * by_v[c]);
        }
        modes[6 + k] = {matrix, system.values[k]};
    }
    return modes;
}

/// The gradients of the barycentric coordinates, by corner.
std::array<Vec3d, 4> corner_gradients(const ElasticTetrahedron& tetrahedron) {
    const Vec3d b(tetrahedron.gradients[0]), c(tetrahedron.gradients[1]), d(tetrahedron.gradients[2]);
    return {-(b + c + d), b, c, d};
}

double norm_sq(const Matrix3& m) {
    return dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]);
}

/// The change of Green's strain, (F^T F - F0^T F0) / 2, since the step began; zero if an element only
/// rotates. With respect to F, half its squared norm has the derivative F times the change.
Matrix3 strain_change(const Matrix3& f, const Matrix3& before) {
    std::array<std::array<double, 3>, 3> e{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) e[i][j] = (dot(f[i], f[j]) - dot(before[i], before[j])) / 2;
    return {Vec3d{e[0][0], e[1][0], e[2][0]}, Vec3d{e[0][1], e[1][1], e[2][1]},
            Vec3d{e[0][2], e[1][2], e[2][2]}};
}

} // namespace

NeoHookean::NeoHookean(std::vector<ElasticTetrahedron> tetrahedra, std::size_t particle_count)
    : tetrahedra_(std::move(tetrahedra)),
      slabs_(particle_count, tetrahedra_.size(), [&](std::uint32_t t) { return tetrahedra_[t].particles; }),
      before_(tetrahedra_.size()) {}

void NeoHookean::couple(std::vector<Coupling>& blocks) const {
    for (const ElasticTetrahedron& tetrahedron : tetrahedra_)
        for (const std::uint32_t a : tetrahedron.particles)
            for (const std::uint32_t b : tetrahedron.particles) blocks.push_back({a, b});
}

void NeoHookean::find_entries(const BlockMatrix& matrix) {
    entries_.clear();
    for (const ElasticTetrahedron& tetrahedron : tetrahedra_) {
        auto& entries = entries_.emplace_back();
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                entries[4 * i + j] = matrix.find_block(tetrahedron.particles[i], tetrahedron.particles[j]);
    }
}

NeoHookean::Matrix NeoHookean::deformation(std::uint32_t number, Places places) const {
    const ElasticTetrahedron& tetrahedron = tetrahedra_[number];
    const Vec3d origin = places[tetrahedron.particles[0]];
    Matrix f{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d edge = places[tetrahedron.particles[k + 1]] - origin;
        const Vec3d gradient(tetrahedron.gradients[k]);
        f[0] += edge * gradient.x;
        f[1] += edge * gradient.y;
        f[2] += edge * gradient.z;
    }
    return f;
}

void NeoHookean::begin_step(Places places, double step) {
    inverse_step_ = 1 / step;
    for (std::uint32_t t = 0; t < tetrahedra_.size(); ++t) before_[t] = deformation(t, places);
}

double NeoHookean::energy(Places places, const Workers& workers) const {
    return sum_of(tetrahedra_.size(), workers, [&](std::size_t t) {
        const ElasticTetrahedron& tetrahedron = tetrahedra_[t];
        const Matrix f = deformation(static_cast<std::uint32_t>(t), places);
        const double mu = double{tetrahedron.mu}, lambda = double{tetrahedron.lambda} + mu;
        const double growth = determinant(f) - 1;
        double density = mu / 2 * (norm_sq(f) - 3) - mu * growth + lambda / 2 * growth * growth;
        if (tetrahedron.damping > 0)
            density +=
                mu * double{tetrahedron.damping} * inverse_step_ * norm_sq(strain_change(f, before_[t]));
        return double{tetrahedron.volume} * density;
    });
}

void NeoHookean::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                                 const Workers& workers) const {
    slabs_.for_each(workers, [&](std::uint32_t t, const RowSlab& slab) {
        const ElasticTetrahedron& tetrahedron = tetrahedra_[t];
        const Matrix f = deformation(t, places);
        const double mu = double{tetrahedron.mu}, lambda = double{tetrahedron.lambda} + mu;
        const double volume = double{tetrahedron.volume};
        const double pressure = lambda * (determinant(f) - 1) - mu;
        const double viscosity = mu * double{tetrahedron.damping} * inverse_step_;
        const Matrix3 areas = cofactors(f);
        Matrix3 stress;
        for (std::size_t c = 0; c < 3; ++c) stress[c] = f[c] * mu + areas[c] * pressure;
        if (viscosity > 0) {
            const Matrix3 change = strain_change(f, before_[t]);
            for (std::size_t c = 0; c < 3; ++c) stress[c] += times(f, change[c]) * (2 * viscosity);
        }
        const std::array<Vec3d, 4> by_corner = corner_gradients(tetrahedron);
        for (std::size_t i = 0; i < 4; ++i)
            if (slab.has(tetrahedron.particles[i]))
                gradient[tetrahedron.particles[i]] += times(stress, by_corner[i]) * volume;
        if (hessian == nullptr) return;
        const auto add = [&](const std::array<Vec3d, 4>& moved, double value) {
            if (!(value > 0)) return;
            for (std::size_t i = 0; i < 4; ++i) {
                if (!slab.has(tetrahedron.particles[i])) continue;
                const Float4 by_i(moved[i] * (value * volume));
                for (std::size_t j = 0; j < 4; ++j)
                    hessian->blocks.values[entries_[t][4 * i + j]].add_outer(by_i, Float4(moved[j]));
            }
        };
        const auto moved_by = [&](const Matrix3& mode) {
            std::array<Vec3d, 4> moved;
            for (std::size_t i = 0; i < 4; ++i) moved[i] = times(mode, by_corner[i]);
            return moved;
        };
        for (const Mode& mode : modes_of(decompose(f), mu, lambda))
            add(moved_by(mode.matrix), std::abs(mode.value));
        if (!(viscosity > 0)) return;
        // The six components of the change of strain: the symmetric matrices with one or two entries.
        for (std::size_t p = 0; p < 3; ++p)
            for (std::size_t q = p; q < 3; ++q) {
                Matrix3 mode{};
                mode[p] += f[q] * 0.5;
                mode[q] += f[p] * 0.5;
                add(moved_by(mode), viscosity * (p == q ? 2 : 4));
            }
    });
}

} // namespace echinus
