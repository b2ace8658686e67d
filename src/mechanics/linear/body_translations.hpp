#pragma once

#include "mechanics/energy_term.hpp"
#include "mechanics/linear/block_matrix.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The translations of whole bodies: of those that the material connects, and of which nothing is held. No
/// elastic force acts against them, so whatever a solver leaves of one stays as momentum, while the material
/// itself pulls back what is left within a body. Therefore they are solved exactly in each linear system, and
/// decide for themselves whether a step has converged.
class BodyTranslations {
  public:
    /// @param pattern  connects the rows of a body
    explicit BodyTranslations(const BlockMatrix& pattern);

    /// [row] the first row of its body.
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    void begin_step(std::span<const std::uint8_t> is_held);
    /// Adds to each free body the translation after which the residual b - A x of all its rows together is 0.
    void correct(const BlockMatrix& a, std::span<const Float4> b, std::span<Float4> x,
                 const Workers& workers) const;
    /// How far a free body would go to be in balance, as if inertia alone kept it; the farthest of all.
    /// @param forces   [row] that do not balance; those within a body need not be among them
    /// @param inertia  [row]
    double imbalance(Places forces, std::span<const double> inertia, const Workers& workers) const;

  private:
    bool is_free(std::size_t row) const { return is_bound_[bodies_[row]] == 0; }

    std::vector<std::uint32_t> bodies_;
    std::vector<std::uint8_t> is_bound_; ///< [body, by its first row] 1 where any row of it is held
};

/// [body, by its first row] the displacement that all of it has in common; 0 where any of it is held.
/// @param bodies  [row] the first row of its body
ScratchVector<Vec3d> common_displacements(Places from, Places to, std::span<const double> masses,
                                          std::span<const std::uint32_t> bodies,
                                          std::span<const std::uint8_t> is_held, const Workers& workers);

} // namespace echinus
