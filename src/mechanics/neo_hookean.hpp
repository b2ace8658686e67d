#pragma once

#include "mechanics/energy_term.hpp"

#include <echinus/tetrahedra.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The energy of tetrahedra of a stable Neo-Hookean material (Smith et al. 2018; in the form of Macklin and
/// Mueller 2021): V (mu/2 (|F|^2 - 3) - mu (J - 1) + (lambda + mu)/2 (J - 1)^2), with a viscous term in the
/// strain. Its Hessian is made positive semi-definite by its analytic eigensystem (Smith et al. 2019).
class NeoHookean {
  public:
    NeoHookean(std::vector<ElasticTetrahedron> tetrahedra, std::size_t particle_count);

    void couple(std::vector<Coupling>& blocks) const;
    void find_entries(const BlockMatrix& matrix);

    void begin_step(Places places, double step);
    double energy(Places places, const Workers& workers) const;
    /// @param hessian  may be null
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const;

  private:
    using Matrix = std::array<Vec3d, 3>; ///< by columns
    Matrix deformation(std::uint32_t tetrahedron, Places places) const;

    std::vector<ElasticTetrahedron> tetrahedra_;
    SlabLists slabs_;
    std::vector<std::array<std::uint32_t, 16>> entries_;
    std::vector<Matrix> before_; ///< deformations when the step began
    double inverse_step_ = 0;
};

} // namespace echinus
