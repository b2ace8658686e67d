#pragma once

#include "mechanics/energy_term.hpp"
#include "mechanics/linear/block_matrix.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The translations of whole bodies, each consisting of particles that the material connects and none of
/// which is held. No elastic force acts against a translation, so any error that a solver leaves in one
/// remains as momentum, whereas the material corrects errors within a body. Therefore translations are solved
/// exactly in each linear system, and have their own criterion of convergence.
class BodyTranslations {
  public:
    /// @param pattern  connects the rows of a body
    explicit BodyTranslations(const BlockMatrix& pattern);

    /// [row] the first row of its body.
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    void begin_step(std::span<const std::uint8_t> is_held);
    /// Adds to each free body the translation after which the residuals b - A x of its rows sum to 0.
    void correct(const BlockMatrix& a, std::span<const Float4> b, std::span<Float4> x,
                 const Workers& workers) const;
    /// The displacement that would bring a free body into balance if inertia alone opposed it; the largest of
    /// all bodies.
    /// @param forces   [row] forces that do not balance; those within a body may be omitted
    /// @param inertia  [row]
    double imbalance(Places forces, std::span<const double> inertia, const Workers& workers) const;

  private:
    bool is_free(std::size_t row) const { return is_bound_[bodies_[row]] == 0; }

    std::vector<std::uint32_t> bodies_;
    std::vector<std::uint8_t> is_bound_; ///< [body, by its first row] 1 if any of its rows is held
};

/// [body, by its first row] the mean displacement of the body; 0 if any part of it is held.
/// @param bodies  [row] the first row of its body
ScratchVector<Vec3d> common_displacements(Places from, Places to, std::span<const double> masses,
                                          std::span<const std::uint32_t> bodies,
                                          std::span<const std::uint8_t> is_held, const Workers& workers);

} // namespace echinus
