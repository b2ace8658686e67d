#include "mechanics/linear/conjugate_gradients.hpp"

#include <algorithm>
#include <numeric>

namespace echinus {

namespace {

/// Computed in double, by pieces that are summed in order.
double dot(std::span<const Float4> a, std::span<const Float4> b, const Workers& workers) {
    constexpr std::size_t kLanes = 64;
    ScratchVector<double> sums(Workers::piece_count(a.size(), kRowsPerPiece), workers.scratch());
    workers.for_ranges(a.size(), kRowsPerPiece,
                       [&](std::size_t, std::size_t piece, std::size_t begin, std::size_t end) {
                           double sum = 0;
                           for (std::size_t first = begin; first < end; first += kLanes) {
                               Float4 part;
                               for (std::size_t i = first; i < std::min(first + kLanes, end); ++i)
                                   part += Float4(a[i].lanes * b[i].lanes);
                               sum += double{part[0]} + double{part[1]} + double{part[2]};
                           }
                           sums[piece] = sum;
                       });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

} // namespace

std::uint32_t ConjugateGradients::solve(const BlockMatrix& a, Multigrid& preconditioner,
                                        std::span<const Float4> b, std::span<Float4> x,
                                        std::uint32_t most_iterations, double tolerance,
                                        const Workers& workers) {
    const std::size_t count = a.row_count();
    std::fill(x.begin(), x.end(), Float4{});
    residual_.assign(b.begin(), b.end());
    for (auto* vector : {&direction_, &preconditioned_, &product_}) vector->resize(count);
    preconditioner.apply(residual_, preconditioned_, workers);
    direction_ = preconditioned_;
    double norm_sq = dot(residual_, preconditioned_, workers);
    const double goal_sq = tolerance * tolerance * norm_sq;
    std::uint32_t iteration = 0;
    while (iteration < most_iterations && norm_sq > goal_sq) {
        a.multiply(direction_, product_, workers);
        const double curvature = dot(direction_, product_, workers);
        if (!(curvature > 0)) break;
        const auto step = static_cast<float>(norm_sq / curvature);
        for (std::size_t i = 0; i < count; ++i) {
            x[i] += direction_[i] * step;
            residual_[i] -= product_[i] * step;
        }
        if (++iteration == most_iterations) break;
        preconditioner.apply(residual_, preconditioned_, workers);
        const double next_sq = dot(residual_, preconditioned_, workers);
        const auto share = static_cast<float>(next_sq / norm_sq);
        norm_sq = next_sq;
        for (std::size_t i = 0; i < count; ++i) direction_[i] = preconditioned_[i] + direction_[i] * share;
    }
    return iteration;
}

} // namespace echinus
