#include "mechanics/bending.hpp"

#include "geometry/elementary.hpp"
#include "mechanics/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace echinus {

namespace {

constexpr std::uint32_t kIsMultiple = 1U << 31U;

/// The cotangent of the angle between two directions.
double cotangent(const Vec3d& a, const Vec3d& b) {
    return dot(a, b) / length(cross(a, b));
}

bool is_flat(const ElasticHinge& hinge) {
    return std::fabs(hinge.rest_angle) < threshold::kFlatHinge;
}

struct Angle {
    double value;
    std::array<Vec3d, 4> gradient;
};

/// The signed angle between the faces (a, b, c) and (b, a, d), and its derivatives (Bridson et al. 2003).
Angle angle_of(const std::array<Vec3d, 4>& corners) {
    const auto& [a, b, c, d] = corners;
    const Vec3d edge = b - a;
    const Vec3d n1 = cross(edge, c - a), n2 = cross(d - a, edge);
    const double n1_sq = dot(n1, n1), n2_sq = dot(n2, n2), edge_length = length(edge);
    Angle angle{};
    if (!(n1_sq > 0) || !(n2_sq > 0) || !(edge_length > 0)) return angle;
    angle.value = portable_atan2(dot(cross(n2, n1), edge) / edge_length, dot(n1, n2));
    // Moving a corner along the normal of its face turns the face about the edge, by the displacement over
    // the corner's height.
    const Vec3d by_c = n1 * (edge_length / n1_sq), by_d = n2 * (edge_length / n2_sq);
    const double c_along = dot(c - a, edge) / (edge_length * edge_length);
    const double d_along = dot(d - a, edge) / (edge_length * edge_length);
    angle.gradient = {by_c * (c_along - 1) + by_d * (d_along - 1), by_c * -c_along - by_d * d_along, by_c,
                      by_d};
    return angle;
}

Angle angle_of(const ElasticHinge& hinge, Places places) {
    const auto& [a, b, c, d] = hinge.particles;
    return angle_of({places[a], places[b], places[c], places[d]});
}

/// The difference between two angles, to within half a turn.
double turned(double from, double to) {
    const double difference = to - from;
    return difference - 2 * std::numbers::pi * std::round(difference / (2 * std::numbers::pi));
}

} // namespace

double fold_angle(const std::array<Vec3d, 4>& places) {
    return angle_of(places).value;
}

void set_rest_shape(ElasticHinge& hinge, const std::array<Vec3d, 4>& rest, double bending_stiffness) {
    const auto& [a, b, c, d] = rest;
    const double a_c = cotangent(b - a, c - a), a_d = cotangent(b - a, d - a);
    const double b_c = cotangent(a - b, c - b), b_d = cotangent(a - b, d - b);
    const double area = (length(cross(b - a, c - a)) + length(cross(b - a, d - a))) / 2;
    hinge.weights = {static_cast<float>(b_c + b_d), static_cast<float>(a_c + a_d),
                     static_cast<float>(-a_c - b_c), static_cast<float>(-a_d - b_d)};
    // In a grid of right triangles that is bent along its rows, only every third edge folds. Bergou et al.
    // assign a third of the area around it to each edge, and so use three times this stiffness, which would
    // make such a grid three times too stiff.
    hinge.stiffness = static_cast<float>(bending_stiffness / area);
    hinge.edge_length = static_cast<float>(length(b - a));
}

Bending::Bending(std::vector<ElasticHinge> hinges, std::size_t particle_count)
    : curved_([&] {
          std::vector<ElasticHinge> curved;
          std::copy_if(hinges.begin(), hinges.end(), std::back_inserter(curved),
                       [](const ElasticHinge& hinge) { return !is_flat(hinge); });
          return curved;
      }()),
      curved_slabs_(particle_count, curved_.size(), [&](std::uint32_t h) { return curved_[h].particles; }),
      angles_before_(curved_.size()) {
    struct Entry {
        Coupling at;
        double value, damping;
    };
    std::vector<Entry> entries;
    bool is_damped = false;
    for (const ElasticHinge& hinge : hinges) {
        if (!is_flat(hinge)) continue;
        is_damped = is_damped || hinge.damping > 0;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j) {
                const double value =
                    double{hinge.stiffness} * double{hinge.weights[i]} * double{hinge.weights[j]};
                entries.push_back(
                    {{hinge.particles[i], hinge.particles[j]}, value, value * double{hinge.damping}});
            }
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.at < b.at; });
    flat_.first.assign(particle_count + 1, 0);
    const Coupling* previous = nullptr;
    for (const Entry& entry : entries) {
        if (previous == nullptr || *previous != entry.at) {
            ++flat_.first[entry.at[0] + 1];
            flat_.columns.push_back(entry.at[1]);
            flat_.values.push_back(0);
            if (is_damped) flat_damping_.values.push_back(0);
        }
        flat_.values.back() += entry.value;
        if (is_damped) flat_damping_.values.back() += entry.damping;
        previous = &entry.at;
    }
    for (std::size_t row = 0; row < particle_count; ++row) flat_.first[row + 1] += flat_.first[row];
}

void Bending::couple(std::vector<Coupling>& blocks, std::vector<Coupling>& multiples) const {
    for (const ElasticHinge& hinge : curved_)
        for (const std::uint32_t a : hinge.particles)
            for (const std::uint32_t b : hinge.particles) blocks.push_back({a, b});
    for (std::uint32_t row = 0; row < flat_.row_count(); ++row)
        for (std::uint32_t e = flat_.first[row]; e < flat_.first[row + 1]; ++e)
            multiples.push_back({row, flat_.columns[e]});
}

void Bending::find_entries(const BlockMatrix& matrix) {
    flat_entries_.clear();
    for (std::uint32_t row = 0; row < flat_.row_count(); ++row)
        for (std::uint32_t e = flat_.first[row]; e < flat_.first[row + 1]; ++e) {
            const std::uint32_t block = matrix.find_block(row, flat_.columns[e]);
            flat_entries_.push_back(block != BlockMatrix::kNone
                                        ? block
                                        : kIsMultiple | matrix.find_multiple(row, flat_.columns[e]));
        }
    curved_entries_.clear();
    for (const ElasticHinge& hinge : curved_) {
        auto& entries = curved_entries_.emplace_back();
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                entries[4 * i + j] = matrix.find_block(hinge.particles[i], hinge.particles[j]);
    }
}

void Bending::begin_step(Places places, double step) {
    inverse_step_ = 1 / step;
    if (!flat_damping_.values.empty()) before_.assign(places.begin(), places.end());
    for (std::size_t h = 0; h < curved_.size(); ++h) angles_before_[h] = angle_of(curved_[h], places).value;
}

/// The product of a row of the quadratic form, with damping, and the positions.
Vec3d Bending::curvature_force(std::size_t row, Places places) const {
    Vec3d sum;
    for (std::uint32_t e = flat_.first[row]; e < flat_.first[row + 1]; ++e)
        sum += places[flat_.columns[e]] * flat_.values[e];
    if (!flat_damping_.values.empty())
        for (std::uint32_t e = flat_.first[row]; e < flat_.first[row + 1]; ++e)
            sum += (places[flat_.columns[e]] - before_[flat_.columns[e]]) *
                   (flat_damping_.values[e] * inverse_step_);
    return sum;
}

double Bending::energy(Places places, const Workers& workers) const {
    double sum = sum_of(flat_.row_count(), workers, [&](std::size_t row) {
        Vec3d elastic, damped;
        for (std::uint32_t e = flat_.first[row]; e < flat_.first[row + 1]; ++e)
            elastic += places[flat_.columns[e]] * flat_.values[e];
        double energy = dot(elastic, places[row]) / 2;
        if (flat_damping_.values.empty()) return energy;
        for (std::uint32_t e = flat_.first[row]; e < flat_.first[row + 1]; ++e)
            damped += (places[flat_.columns[e]] - before_[flat_.columns[e]]) * flat_damping_.values[e];
        return energy + dot(damped, places[row] - before_[row]) * inverse_step_ / 2;
    });
    sum += sum_of(curved_.size(), workers, [&](std::size_t h) {
        const ElasticHinge& hinge = curved_[h];
        const double angle = angle_of(hinge, places).value;
        const double bent = turned(double{hinge.rest_angle}, angle);
        const double turning = turned(angles_before_[h], angle);
        const double scale = double{hinge.stiffness} * double{hinge.edge_length} * double{hinge.edge_length};
        return scale / 2 * (bent * bent + double{hinge.damping} * inverse_step_ * turning * turning);
    });
    return sum;
}

void Bending::add_curved(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const {
    curved_slabs_.for_each(workers, [&](std::uint32_t h, const RowSlab& slab) {
        const ElasticHinge& hinge = curved_[h];
        const Angle angle = angle_of(hinge, places);
        const double scale = double{hinge.stiffness} * double{hinge.edge_length} * double{hinge.edge_length};
        const double share = double{hinge.damping} * inverse_step_;
        const double moment = scale * (turned(double{hinge.rest_angle}, angle.value) +
                                       share * turned(angles_before_[h], angle.value));
        for (std::size_t i = 0; i < 4; ++i) {
            if (!slab.has(hinge.particles[i])) continue;
            gradient[hinge.particles[i]] += angle.gradient[i] * moment;
            if (hessian == nullptr) continue;
            const Float4 by_i(angle.gradient[i] * (scale * (1 + share)));
            for (std::size_t j = 0; j < 4; ++j)
                hessian->blocks.values[curved_entries_[h][4 * i + j]].add_outer(by_i,
                                                                                Float4(angle.gradient[j]));
        }
    });
}

void Bending::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                              const Workers& workers) const {
    const bool is_damped = !flat_damping_.values.empty();
    workers.for_ranges(
        flat_.row_count(), kRowsPerPiece, [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) {
                gradient[row] += curvature_force(row, places);
                if (hessian == nullptr) continue;
                for (std::uint32_t e = flat_.first[row]; e < flat_.first[row + 1]; ++e) {
                    const double damped = is_damped ? flat_damping_.values[e] * inverse_step_ : 0;
                    const auto value = static_cast<float>(flat_.values[e] + damped);
                    const std::uint32_t entry = flat_entries_[e];
                    if ((entry & kIsMultiple) != 0)
                        hessian->multiples.values[entry & ~kIsMultiple] += value;
                    else
                        hessian->blocks.values[entry].add_identity(value);
                }
            }
        });
    add_curved(places, gradient, hessian, workers);
}

} // namespace echinus
