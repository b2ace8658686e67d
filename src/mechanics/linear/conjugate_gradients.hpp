#pragma once

#include "mechanics/linear/block_matrix.hpp"
#include "mechanics/linear/multigrid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Conjugate gradients, preconditioned by multigrid.
class ConjugateGradients {
  public:
    /// Solves A x = b. @param x  out; iteration starts from 0
    /// @param tolerance  of the residual in the preconditioner's norm, relative to b
    /// @return the number of iterations
    std::uint32_t solve(const BlockMatrix& a, Multigrid& preconditioner, std::span<const Float4> b,
                        std::span<Float4> x, std::uint32_t most_iterations, double tolerance,
                        const Workers& workers);

  private:
    std::vector<Float4> residual_, direction_, preconditioned_, product_;
};

} // namespace echinus
