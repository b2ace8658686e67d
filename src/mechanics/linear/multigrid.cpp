#include "mechanics/linear/multigrid.hpp"

#include "mechanics/thresholds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace echinus {

namespace {

/// The number of coarse rows that one thread computes at once. A fine row near the border of two pieces is
/// computed twice.
constexpr std::size_t kCoarseRowsPerPiece = 256;
/// The number of rows in a sweep that see each other's new values.
constexpr std::size_t kRowsPerSlab = kRowsPerPiece;

Float4 times(const Block& block, const Float4& x) {
    return block * x;
}
Float4 times(float multiple, const Float4& x) {
    return x * multiple;
}

/// The product of a row with x, restricted to the columns in [begin, end).
template <typename Value>
Float4 times_range(const Rows<Value>& rows, std::size_t row, std::size_t begin, std::size_t end,
                   std::span<const Float4> x) {
    Float4 sum;
    std::uint32_t e = rows.first[row];
    const std::uint32_t last = rows.first[row + 1];
    while (e < last && rows.columns[e] < begin) ++e;
    for (; e < last && rows.columns[e] < end; ++e) sum += times(rows.values[e], x[rows.columns[e]]);
    return sum;
}

Float4 times_range(const BlockMatrix& a, std::size_t row, std::size_t begin, std::size_t end,
                   std::span<const Float4> x) {
    return times_range(a.blocks, row, begin, end, x) + times_range(a.multiples, row, begin, end, x) +
           times_range(a.contacts, row, begin, end, x);
}

/// The trace of A B.
float trace_of_product(const Block& a, const Block& b) {
    float sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) sum += a(i, j) * b(j, i);
    return sum;
}

Block product(const Block& a, const Block& b) {
    return {{a * b.columns[0], a * b.columns[1], a * b.columns[2]}};
}

/// The Frobenius norm of D_i^-1/2 A_ij D_j^-1/2, squared.
float coupling_sq(const Block& inverse_i, const Block& a, const Block& inverse_j) {
    // D_j^-1 A_ij^T, as D_j is symmetric.
    Block transposed;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) transposed.columns[i].set(j, a(i, j));
    return trace_of_product(product(inverse_i, a), product(inverse_j, transposed));
}
float coupling_sq(const Block& inverse_i, float multiple, const Block& inverse_j) {
    return multiple * multiple * trace_of_product(inverse_i, inverse_j);
}

/// How strongly a row is coupled to the columns outside [begin, end): the sum over these.
template <typename Value>
float coupling_beyond(const BlockMatrix& a, const Rows<Value>& rows, std::size_t row, std::size_t begin,
                      std::size_t end) {
    float sum = 0;
    for (std::uint32_t e = rows.first[row]; e < rows.first[row + 1]; ++e) {
        const std::uint32_t column = rows.columns[e];
        if (column >= begin && column < end) continue;
        sum += std::sqrt(
            std::max(coupling_sq(a.inverse_diagonal[row], rows.values[e], a.inverse_diagonal[column]), 0.0F));
    }
    return sum;
}

/// A forward sweep from x = 0. The residual that it leaves comes from the columns that a row has not seen,
/// which are those after it and those of other slabs, and from the excess of the diagonal.
void sweep_from_zero(const BlockMatrix& a, std::span<const Float4> b, std::span<Float4> x,
                     const Workers& workers) {
    workers.for_ranges(
        a.row_count(), kRowsPerSlab, [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row)
                x[row] = a.inverse_diagonal[row] * (b[row] - times_range(a, row, begin, row, x));
        });
}

/// b - A x after sweep_from_zero().
void residual_of_sweep(const BlockMatrix& a, std::span<const float> excess, std::span<const Float4> x,
                       std::span<Float4> residual, const Workers& workers) {
    workers.for_ranges(a.row_count(), kRowsPerSlab,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t row = begin; row < end; ++row) {
                               Float4 unseen = times_range(a, row, row + 1, a.row_count(), x);
                               if (begin > 0) unseen += times_range(a, row, 0, begin, x);
                               residual[row] = Float4{} - unseen;
                               if (excess[row] > 0)
                                   residual[row] += a.blocks.values[a.diagonal[row]] * (x[row] * excess[row]);
                           }
                       });
}

/// A backward sweep, in which each slab sees `before` as the values of the others.
void sweep_back(const BlockMatrix& a, std::span<const Float4> b, std::span<const Float4> before,
                std::span<Float4> x, const Workers& workers) {
    const auto last = a.row_count();
    workers.for_ranges(a.row_count(), kRowsPerSlab,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t row = end; row-- > begin;) {
                               Float4 rest = b[row] - times_range(a, row, begin, end, x);
                               if (begin > 0) rest -= times_range(a, row, 0, begin, before);
                               if (end < last) rest -= times_range(a, row, end, last, before);
                               x[row] += a.inverse_diagonal[row] * rest;
                           }
                       });
}

/// For each coarse node, the fine nodes that follow it.
Rows<float> transposed(const Rows<float>& parents, std::size_t coarse_count) {
    Rows<float> children;
    children.first.assign(coarse_count + 1, 0);
    for (const std::uint32_t parent : parents.columns) ++children.first[parent + 1];
    std::partial_sum(children.first.begin(), children.first.end(), children.first.begin());
    children.columns.resize(parents.columns.size());
    children.values.resize(parents.columns.size());
    std::vector<std::uint32_t> next(children.first.begin(), children.first.end() - 1);
    for (std::uint32_t node = 0; node < parents.row_count(); ++node)
        for (std::uint32_t p = parents.first[node]; p < parents.first[node + 1]; ++p) {
            const std::uint32_t at = next[parents.columns[p]]++;
            children.columns[at] = node;
            children.values[at] = parents.values[p];
        }
    return children;
}

} // namespace

Multigrid::Multigrid(const BlockMatrix& pattern, std::span<const Vec3d> places) {
    add_level(pattern, places);
}

void Multigrid::add_level(const BlockMatrix& fine, std::span<const Vec3d> places) {
    Level level;
    for (auto* vector : {&level.right_side, &level.solution, &level.residual, &level.before})
        vector->resize(fine.row_count());
    levels_.push_back(std::move(level));
    if (fine.row_count() <= threshold::kMostLastNodes) return;
    Transfer transfer;
    transfer.coarsening = coarsen(fine.blocks, places);
    // In a graph without edges all nodes are coarse: its matrix is diagonal, and sweeps solve it.
    if (transfer.coarsening.coarse_count() > fine.row_count() / 2) return;
    transfer.children = transposed(transfer.coarsening.parents, transfer.coarsening.coarse_count());
    BlockMatrix coarse;
    plan(fine, transfer, coarse);
    const std::vector<Vec3d> coarse_places = transfer.coarsening.coarse_places;
    levels_.back().transfer = std::move(transfer);
    const std::size_t next = levels_.size();
    add_level(coarse, coarse_places);
    levels_[next].own = std::move(coarse);
}

void Multigrid::plan(const BlockMatrix& fine, Transfer& transfer, BlockMatrix& coarse) {
    const Rows<float>& parents = transfer.coarsening.parents;
    std::vector<Coupling> coupled;
    transfer.first_local = {0};
    std::vector<std::uint32_t> locals;
    const auto add_entries = [&](const auto& rows, std::uint32_t row, Rows<std::uint8_t>& plan) {
        for (std::uint32_t e = rows.first[row]; e < rows.first[row + 1]; ++e) {
            const std::uint32_t column = rows.columns[e];
            for (std::uint32_t p = parents.first[column]; p < parents.first[column + 1]; ++p) {
                const auto found = std::find(locals.begin(), locals.end(), parents.columns[p]);
                plan.values.push_back(static_cast<std::uint8_t>(found - locals.begin()));
                if (found == locals.end()) locals.push_back(parents.columns[p]);
            }
        }
        plan.first.push_back(static_cast<std::uint32_t>(plan.values.size()));
    };
    for (std::uint32_t row = 0; row < fine.row_count(); ++row) {
        locals.clear();
        add_entries(fine.blocks, row, transfer.blocks);
        add_entries(fine.multiples, row, transfer.multiples);
        transfer.locals.insert(transfer.locals.end(), locals.begin(), locals.end());
        transfer.first_local.push_back(static_cast<std::uint32_t>(transfer.locals.size()));
        for (std::uint32_t p = parents.first[row]; p < parents.first[row + 1]; ++p)
            for (const std::uint32_t local : locals) coupled.push_back({parents.columns[p], local});
    }
    coarse.set_pattern(transfer.coarsening.coarse_count(), std::move(coupled), {});
    transfer.first_target = {0};
    transfer.fine_of_piece.resize(Workers::piece_count(coarse.row_count(), kCoarseRowsPerPiece));
    for (std::uint32_t row = 0; row < fine.row_count(); ++row) {
        for (std::uint32_t p = parents.first[row]; p < parents.first[row + 1]; ++p) {
            const std::uint32_t parent = parents.columns[p];
            for (std::uint32_t l = transfer.first_local[row]; l < transfer.first_local[row + 1]; ++l)
                transfer.targets.push_back(coarse.find_block(parent, transfer.locals[l]));
            auto& fine_rows = transfer.fine_of_piece[parent / kCoarseRowsPerPiece];
            if (fine_rows.empty() || fine_rows.back() != row) fine_rows.push_back(row);
        }
        transfer.first_target.push_back(static_cast<std::uint32_t>(transfer.targets.size()));
    }
}

/// P^T A P. @param is_held  [fine row], or empty if none is held
void Multigrid::product(const BlockMatrix& fine, std::span<const std::uint8_t> is_held,
                        const Transfer& transfer, BlockMatrix& coarse, const Workers& workers) {
    const Rows<float>& parents = transfer.coarsening.parents;
    coarse.clear();
    const auto add_row = [&](std::uint32_t row, std::size_t begin, std::size_t end,
                             ScratchVector<Block>& locals) {
        const std::size_t local_count = transfer.first_local[row + 1] - transfer.first_local[row];
        locals.assign(local_count, Block{});
        std::uint32_t at = transfer.blocks.first[row];
        for (std::uint32_t e = fine.blocks.first[row]; e < fine.blocks.first[row + 1]; ++e) {
            const std::uint32_t column = fine.blocks.columns[e];
            for (std::uint32_t p = parents.first[column]; p < parents.first[column + 1]; ++p)
                locals[transfer.blocks.values[at++]].add_scaled(fine.blocks.values[e], parents.values[p]);
        }
        at = transfer.multiples.first[row];
        for (std::uint32_t e = fine.multiples.first[row]; e < fine.multiples.first[row + 1]; ++e) {
            const std::uint32_t column = fine.multiples.columns[e];
            for (std::uint32_t p = parents.first[column]; p < parents.first[column + 1]; ++p)
                locals[transfer.multiples.values[at++]].add_identity(fine.multiples.values[e] *
                                                                     parents.values[p]);
        }
        std::uint32_t target = transfer.first_target[row];
        for (std::uint32_t p = parents.first[row]; p < parents.first[row + 1]; ++p, target += local_count) {
            if (parents.columns[p] < begin || parents.columns[p] >= end) continue;
            for (std::size_t l = 0; l < local_count; ++l)
                coarse.blocks.values[transfer.targets[target + l]].add_scaled(locals[l], parents.values[p]);
        }
    };
    workers.for_ranges(coarse.row_count(), kCoarseRowsPerPiece,
                       [&](std::size_t worker, std::size_t piece, std::size_t begin, std::size_t end) {
                           ScratchVector<Block> locals(workers.scratch(worker)); // reused for every row
                           for (const std::uint32_t row : transfer.fine_of_piece[piece])
                               if (is_held.empty() || is_held[row] == 0) add_row(row, begin, end, locals);
                       });
    if (!fine.contacts.columns.empty()) add_contacts(fine, is_held, transfer, coarse);
    for (std::size_t row = 0; row < coarse.row_count(); ++row) {
        Block& diagonal = coarse.blocks.values[coarse.diagonal[row]];
        const float trace = diagonal.trace();
        diagonal.add_identity(trace > 0 ? threshold::kRegularisation * trace : 1);
    }
}

/// Contacts couple coarse nodes of the pattern and other pairs of coarse nodes.
void Multigrid::add_contacts(const BlockMatrix& fine, std::span<const std::uint8_t> is_held,
                             const Transfer& transfer, BlockMatrix& coarse) {
    const Rows<float>& parents = transfer.coarsening.parents;
    for (std::uint32_t row = 0; row < fine.row_count(); ++row) {
        if (!is_held.empty() && is_held[row] != 0) continue;
        for (std::uint32_t e = fine.contacts.first[row]; e < fine.contacts.first[row + 1]; ++e) {
            const std::uint32_t column = fine.contacts.columns[e];
            for (std::uint32_t p = parents.first[row]; p < parents.first[row + 1]; ++p)
                for (std::uint32_t q = parents.first[column]; q < parents.first[column + 1]; ++q) {
                    const Coupling at{parents.columns[p], parents.columns[q]};
                    const float weight = parents.values[p] * parents.values[q];
                    const std::uint32_t block = coarse.find_block(at[0], at[1]);
                    if (block != BlockMatrix::kNone)
                        coarse.blocks.values[block].add_scaled(fine.contacts.values[e], weight);
                    else
                        coarse.add_contact(at, fine.contacts.values[e] * weight);
                }
        }
    }
    coarse.set_contacts();
}

/// With M = (1 + excess) D + L, where L contains the lower triangles of the slabs, the sweeps converge if M +
/// M^T - A is positive definite. A block beyond the slabs is bounded by its coupling c: 2 x_i A_ij x_j <= c
/// (x_i D_i x_i + x_j D_j x_j); so half of the sum of a row's couplings is sufficient.
void Multigrid::prepare(std::size_t level, BlockMatrix& matrix, const Workers& workers) {
    matrix.invert_diagonal(workers);
    std::vector<float>& excess = levels_[level].excess;
    excess.resize(matrix.row_count());
    const auto for_rows = [&](const auto& body) {
        workers.for_ranges(matrix.row_count(), kRowsPerSlab,
                           [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                               for (std::size_t row = begin; row < end; ++row) body(row, begin, end);
                           });
    };
    for_rows([&](std::size_t row, std::size_t begin, std::size_t end) {
        excess[row] = (coupling_beyond(matrix, matrix.blocks, row, begin, end) +
                       coupling_beyond(matrix, matrix.multiples, row, begin, end) +
                       coupling_beyond(matrix, matrix.contacts, row, begin, end)) /
                      2;
    });
    for_rows([&](std::size_t row, std::size_t, std::size_t) {
        matrix.inverse_diagonal[row] = matrix.inverse_diagonal[row] * (1 / (1 + excess[row]));
    });
}

void Multigrid::set(BlockMatrix& matrix, std::span<const std::uint8_t> is_held, const Workers& workers) {
    first_ = &matrix;
    is_held_ = is_held;
    prepare(0, matrix, workers);
    for (std::size_t level = 0; level + 1 < levels_.size(); ++level) {
        BlockMatrix& coarse = levels_[level + 1].own;
        product(this->matrix(level), level == 0 ? is_held : std::span<const std::uint8_t>{},
                levels_[level].transfer, coarse, workers);
        prepare(level + 1, coarse, workers);
    }
    factorise_last(workers);
}

void Multigrid::factorise_last(const Workers& workers) {
    const BlockMatrix& a = matrix(levels_.size() - 1);
    if (a.row_count() > threshold::kMostLastNodes) return;
    const std::size_t size = 3 * a.row_count();
    ScratchVector<float> dense(size * size, workers.scratch());
    const auto add = [&](std::size_t row, std::uint32_t column, const Block& block) {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) dense[(3 * row + i) * size + 3 * column + j] += block(i, j);
    };
    for (std::size_t row = 0; row < a.row_count(); ++row) {
        for (std::uint32_t e = a.blocks.first[row]; e < a.blocks.first[row + 1]; ++e)
            add(row, a.blocks.columns[e], a.blocks.values[e]);
        for (std::uint32_t e = a.contacts.first[row]; e < a.contacts.first[row + 1]; ++e)
            add(row, a.contacts.columns[e], a.contacts.values[e]);
        for (std::uint32_t e = a.multiples.first[row]; e < a.multiples.first[row + 1]; ++e) {
            Block multiple;
            multiple.add_identity(a.multiples.values[e]);
            add(row, a.multiples.columns[e], multiple);
        }
    }
    last_.factorise(size, dense);
    last_unknowns_.resize(size);
}

void Multigrid::apply(std::span<const Float4> r, std::span<Float4> z, const Workers& workers) {
    cycle(0, r, z, workers);
}

void Multigrid::solve_last(std::span<const Float4> b, std::span<Float4> x) {
    for (std::size_t i = 0; i < last_unknowns_.size(); ++i) last_unknowns_[i] = b[i / 3][i % 3];
    last_.solve(last_unknowns_);
    for (std::size_t i = 0; i < last_unknowns_.size(); ++i) x[i / 3].set(i % 3, last_unknowns_[i]);
}

void Multigrid::cycle(std::size_t level, std::span<const Float4> b, std::span<Float4> x,
                      const Workers& workers) {
    const BlockMatrix& a = matrix(level);
    if (a.row_count() <= threshold::kMostLastNodes) return solve_last(b, x);
    sweep_from_zero(a, b, x, workers);
    Level& here = levels_[level];
    if (level + 1 < levels_.size()) {
        const Transfer& transfer = here.transfer;
        residual_of_sweep(a, here.excess, x, here.residual, workers);
        Level& next = levels_[level + 1];
        for (std::size_t node = 0; node < next.right_side.size(); ++node) {
            Float4 sum;
            for (std::uint32_t c = transfer.children.first[node]; c < transfer.children.first[node + 1]; ++c)
                sum += here.residual[transfer.children.columns[c]] * transfer.children.values[c];
            next.right_side[node] = sum;
        }
        cycle(level + 1, next.right_side, next.solution, workers);
        const Rows<float>& parents = transfer.coarsening.parents;
        for (std::size_t row = 0; row < a.row_count(); ++row) {
            if (level == 0 && is_held_[row] != 0) continue;
            for (std::uint32_t p = parents.first[row]; p < parents.first[row + 1]; ++p)
                x[row] += next.solution[parents.columns[p]] * parents.values[p];
        }
    }
    std::copy(x.begin(), x.end(), here.before.begin());
    sweep_back(a, b, here.before, x, workers);
}

} // namespace echinus
