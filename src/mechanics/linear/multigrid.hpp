#pragma once

#include "mechanics/linear/block_matrix.hpp"
#include "mechanics/linear/cholesky.hpp"
#include "mechanics/linear/coarsening.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// An approximate inverse of a BlockMatrix by Galerkin multigrid on any mesh: one V-cycle with a forward
/// Gauss-Seidel sweep on the way down and a backward one on the way up, which makes it symmetric. A sweep
/// uses new values within slabs of rows, and old values beyond them; the slabs are fixed, so the result does
/// not depend on the number of threads. The diagonal blocks of rows that are coupled beyond their slabs are
/// enlarged so that the inverse is also positive definite, as for l1 smoothers (Baker et al. 2011).
class Multigrid {
  public:
    /// Builds the levels. @param places  [row] at rest
    Multigrid(const BlockMatrix& pattern, std::span<const Vec3d> places);

    /// Computes the coarse matrices. The matrix must not change while apply() is used.
    /// @param is_held  [row] 1 for rows whose unknowns stay 0
    void set(BlockMatrix& matrix, std::span<const std::uint8_t> is_held, const Workers& workers);
    /// z = M^-1 r
    void apply(std::span<const Float4> r, std::span<Float4> z, const Workers& workers);

    std::size_t level_count() const { return levels_.size(); }

  private:
    /// Computes the next coarser matrix from a fine one.
    struct Transfer {
        Coarsening coarsening;
        Rows<float> children; ///< [coarse node] the fine ones that follow it, ascending
        // The plan of the product, by fine node. The locals of a node are the coarse nodes in its row of A P:
        Rows<std::uint8_t> blocks,
            multiples; ///< [entry of A, parent of its column] the local to which it adds
        std::vector<std::uint32_t> first_local;           ///< [fine node + 1]
        std::vector<std::uint32_t> locals;                ///< coarse nodes
        std::vector<std::uint32_t> first_target, targets; ///< [parent, local] the block of the product
        /// [piece of coarse rows] the fine nodes that add to it.
        std::vector<std::vector<std::uint32_t>> fine_of_piece;
    };
    struct Level {
        BlockMatrix own;   ///< not on the first level
        Transfer transfer; ///< to the next level; not on the last level
        std::vector<Float4> right_side, solution, residual, before;
        std::vector<float> excess; ///< [row] the share by which the diagonal block is enlarged
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
