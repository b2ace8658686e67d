#pragma once

#include "mechanics/energy_term.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Cloth between three particles: an orthotropic membrane after Baraff and Witkin (1998) as a finite element
/// (Kim 2020), in which Poisson's ratio couples warp and weft. Stiffnesses are forces per width: mass / s^2,
/// in SI N/m.
struct ElasticTriangle {
    std::array<std::uint32_t, 3> particles;
    std::array<float, 3> warp, weft; ///< by corner: the derivatives of its barycentric coordinate, per length
    float area;                      ///< at rest; positive
    float warp_stiffness, weft_stiffness, coupling; ///< coupling^2 below their product
    float shear_stiffness;
    float damping; ///< viscosity over stiffness, seconds
};

/// Sets the derivatives for a triangle whose rest corners are given in the coordinates of warp and weft.
/// @return the area; not positive if the corners are not in counter-clockwise order
float set_rest_shape(ElasticTriangle& triangle, const std::array<std::array<double, 2>, 3>& corners);

/// The energy of triangles, A/2 (e^T C e + G (Fu.Fv)^2), where e are the extensions |Fu| - 1 and |Fv| - 1;
/// and the dissipation of a step, damping / h times the same quadratic form C in the change of e.
class Membrane {
  public:
    Membrane(std::vector<ElasticTriangle> triangles, std::size_t particle_count);

    std::span<const ElasticTriangle> triangles() const { return triangles_; }
    void couple(std::vector<Coupling>& blocks) const;
    /// To be called after the pattern is set. @param matrix  has that pattern
    void find_entries(const BlockMatrix& matrix);

    /// @param step  seconds
    void begin_step(Places places, double step);
    double energy(Places places, const Workers& workers) const;
    /// The gradient and a positive semi-definite Hessian: the negative curvature of compressed directions is
    /// left out. @param hessian  may be null
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const;

  private:
    struct State;
    State state_of(std::uint32_t triangle, Places places) const;
    void add_hessian(std::uint32_t triangle, const State& state, const RowSlab& slab,
                     BlockMatrix& hessian) const;

    std::vector<ElasticTriangle> triangles_;
    SlabLists slabs_;
    std::vector<std::array<std::uint32_t, 9>> entries_;    ///< [triangle] the blocks, row by row
    std::vector<std::array<double, 2>> extensions_before_; ///< [triangle] when the step began
    double inverse_step_ = 0;
};

} // namespace echinus
