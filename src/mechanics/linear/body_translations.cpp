#include "mechanics/linear/body_translations.hpp"

#include "geometry/union_find.hpp"
#include "mechanics/small_matrix.hpp"

#include <algorithm>
#include <limits>

namespace echinus {

BodyTranslations::BodyTranslations(const BlockMatrix& pattern)
    : bodies_(pattern.row_count()), is_bound_(pattern.row_count()) {
    UnionFind bodies(pattern.row_count());
    const auto join = [&](const auto& rows, std::uint32_t row) {
        for (std::uint32_t e = rows.first[row]; e < rows.first[row + 1]; ++e)
            bodies.join(row, rows.columns[e]);
    };
    for (std::uint32_t row = 0; row < pattern.row_count(); ++row) join(pattern.blocks, row);
    for (std::uint32_t row = 0; row < bodies_.size(); ++row) bodies_[row] = bodies.find(row);
}

void BodyTranslations::begin_step(std::span<const std::uint8_t> is_held) {
    std::fill(is_bound_.begin(), is_bound_.end(), std::uint8_t{0});
    for (std::size_t row = 0; row < is_held.size(); ++row)
        if (is_held[row] != 0) is_bound_[bodies_[row]] = 1;
}

void BodyTranslations::correct(const BlockMatrix& a, std::span<const Float4> b, std::span<Float4> x,
                               const Workers& workers) const {
    struct Body {
        Matrix3 matrix;
        Vec3d residual;
    };
    ScratchVector<Body> sums(bodies_.size(), workers.scratch());
    const auto add = [&](Body& sum, const Block& block) {
        for (std::size_t i = 0; i < 3; ++i) sum.matrix[i] += block.columns[i].to_double();
    };
    for (std::size_t row = 0; row < bodies_.size(); ++row) {
        if (!is_free(row)) continue;
        Body& sum = sums[bodies_[row]];
        sum.residual += (b[row] - a.row_times(row, x)).to_double();
        Block of_row;
        float multiple = 0;
        const auto is_of_body = [&](std::uint32_t column) { return bodies_[column] == bodies_[row]; };
        for (std::uint32_t e = a.blocks.first[row]; e < a.blocks.first[row + 1]; ++e)
            of_row += a.blocks.values[e];
        for (std::uint32_t e = a.multiples.first[row]; e < a.multiples.first[row + 1]; ++e)
            multiple += a.multiples.values[e];
        for (std::uint32_t e = a.contacts.first[row]; e < a.contacts.first[row + 1]; ++e)
            if (is_of_body(a.contacts.columns[e])) of_row += a.contacts.values[e];
        of_row.add_identity(multiple);
        add(sum, of_row);
    }
    ScratchVector<Float4> translations(bodies_.size(), workers.scratch());
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        if (bodies_[body] != body || !is_free(body)) continue;
        const auto& [p, q, r] = sums[body].matrix;
        const double size = dot(cross(p, q), r);
        if (!(size > 0)) continue;
        const Vec3d& rest = sums[body].residual;
        const Vec3d translation =
            Vec3d{dot(cross(rest, q), r), dot(cross(p, rest), r), dot(cross(p, q), rest)} * (1 / size);
        // The forces of a hostile saved state may overflow: the body then stays where it is, as in the rest
        // of the solver.
        if (is_finite(translation)) translations[body] = Float4(translation);
    }
    for (std::size_t row = 0; row < bodies_.size(); ++row) x[row] += translations[bodies_[row]];
}

double BodyTranslations::imbalance(Places forces, std::span<const double> inertia,
                                   const Workers& workers) const {
    ScratchVector<Vec3d> sums(bodies_.size(), workers.scratch());
    ScratchVector<double> inertias(bodies_.size(), workers.scratch());
    for (std::size_t row = 0; row < bodies_.size(); ++row) {
        if (!is_free(row)) continue;
        sums[bodies_[row]] += forces[row];
        inertias[bodies_[row]] += inertia[row];
    }
    double most = 0;
    for (std::size_t body = 0; body < bodies_.size(); ++body)
        if (inertias[body] > 0) most = std::max(most, length(sums[body]) / inertias[body]);
    return most;
}

ScratchVector<Vec3d> common_displacements(Places from, Places to, std::span<const double> masses,
                                          std::span<const std::uint32_t> bodies,
                                          std::span<const std::uint8_t> is_held, const Workers& workers) {
    ScratchVector<Vec3d> sums(bodies.size(), workers.scratch());
    ScratchVector<double> body_masses(bodies.size(), workers.scratch());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const double mass = is_held[i] != 0 ? std::numeric_limits<double>::infinity() : masses[i];
        body_masses[bodies[i]] += mass;
        if (is_held[i] == 0) sums[bodies[i]] += (to[i] - from[i]) * mass;
    }
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i] == i) sums[i] *= 1 / body_masses[i];
    return sums;
}

} // namespace echinus
