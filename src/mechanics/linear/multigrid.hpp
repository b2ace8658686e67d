#pragma once

#include "mechanics/linear/block_matrix.hpp"
#include "mechanics/linear/cholesky.hpp"
#include "mechanics/linear/coarsening.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// An approximate inverse of a BlockMatrix by Galerkin multigrid on any mesh: one V-cycle with a sweep of
/// Gauss-Seidel forwards on the way down and one backwards on the way up, so that it is symmetric. Within
/// slabs of rows a sweep uses what it has just found, and beyond them what was before: the slabs are fixed,
/// and so the threads decide no bits. The diagonal blocks of rows that are coupled beyond their slabs count
/// for so much more that the inverse is positive definite, too, as that of l1 smoothers (Baker et al. 2011).
class Multigrid {
  public:
    /// Finds the levels. @param places  [row] at rest
    Multigrid(const BlockMatrix& pattern, std::span<const Vec3d> places);

    /// Computes the coarse matrices. The matrix has to stay as it is while apply() is called.
    /// @param is_held  [row] 1 for those whose unknowns stay 0
    void set(BlockMatrix& matrix, std::span<const std::uint8_t> is_held, const Workers& workers);
    /// z = M^-1 r
    void apply(std::span<const Float4> r, std::span<Float4> z, const Workers& workers);

    std::size_t level_count() const { return levels_.size(); }

  private:
    /// Makes the next coarser matrix of one.
    struct Transfer {
        Coarsening coarsening;
        Rows<float> children; ///< [coarse node] the fine ones that follow it, ascending
        // The plan of the product, by fine node: the coarse nodes that its row of A P has,
        Rows<std::uint8_t> blocks,
            multiples; ///< [entry of A, parent of its column] which of these it adds to
        std::vector<std::uint32_t> first_local;                ///< [fine node + 1]
        std::vector<std::uint32_t> locals;                     ///< coarse nodes
        std::vector<std::uint32_t> first_target, targets;      ///< [parent, local] where the product stands
        std::vector<std::vector<std::uint32_t>> fine_of_piece; ///< [piece of coarse rows] what adds to it
    };
    struct Level {
        BlockMatrix own;   ///< but on the first
        Transfer transfer; ///< to the next, but on the last
        std::vector<Float4> right_side, solution, residual, before;
        std::vector<float> excess; ///< [row] share of the diagonal block by which it counts for more
    };

    void add_level(const BlockMatrix& fine, std::span<const Vec3d> places);
    static void plan(const BlockMatrix& fine, Transfer& transfer, BlockMatrix& coarse);
    static void product(const BlockMatrix& fine, std::span<const std::uint8_t> is_held,
                        const Transfer& transfer, BlockMatrix& coarse, const Workers& workers);
    static void add_contacts(const BlockMatrix& fine, std::span<const std::uint8_t> is_held,
                             const Transfer& transfer, BlockMatrix& coarse);
    void prepare(std::size_t level, BlockMatrix& matrix, const Workers& workers);
    void factorise_last(const Workers& workers);
    const BlockMatrix& matrix(std::size_t level) const { return level == 0 ? *first_ : levels_[level].own; }
    void cycle(std::size_t level, std::span<const Float4> b, std::span<Float4> x, const Workers& workers);
    void solve_last(std::span<const Float4> b, std::span<Float4> x);

    const BlockMatrix* first_ = nullptr;
    std::span<const std::uint8_t> is_held_;
    std::vector<Level> levels_;
    Cholesky<float> last_;
    std::vector<float> last_unknowns_;
};

} // namespace echinus
