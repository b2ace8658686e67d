#pragma once

#include "mechanics/energy_term.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Two faces (a, b, c) and (b, a, d) with the common edge a b, which resist bending from their angle at rest.
struct ElasticHinge {
    std::array<std::uint32_t, 4> particles; ///< a, b, c, d
    float rest_angle;                       ///< radians; 0: flat
    /// The weights of the isometric bending energy (Bergou et al. 2006), by particle: the sum of the weighted
    /// positions is the mean curvature normal times the area of the faces, for edge lengths at rest.
    std::array<float, 4> weights;
    float stiffness;   ///< bending stiffness / area of both faces: mass / (length^2 s^2)
    float edge_length; ///< at rest
    float damping;     ///< viscosity over stiffness, seconds
};

/// The angle between the faces (a, b, c) and (b, a, d), radians from -pi to pi: 0 if they are coplanar.
double fold_angle(const std::array<Vec3d, 4>& places);

/// Sets the weights, the length and the stiffness.
/// @param rest  the positions of a, b, c and d; the faces have an area
/// @param bending_stiffness  for a unit of width: mass length^2 / s^2, in SI N m
void set_rest_shape(ElasticHinge& hinge, const std::array<Vec3d, 4>& rest, double bending_stiffness);

/// The energy of hinges. Those that are flat at rest have the isometric energy, which is quadratic in the
/// positions, so that it costs one product with a matrix of multiples. The others have an energy of the
/// dihedral angle in the same units, k/2 l^2 (angle - rest)^2, with the Gauss-Newton Hessian.
class Bending {
  public:
    Bending(std::vector<ElasticHinge> hinges, std::size_t particle_count);

    void couple(std::vector<Coupling>& blocks, std::vector<Coupling>& multiples) const;
    void find_entries(const BlockMatrix& matrix);

    void begin_step(Places places, double step);
    double energy(Places places, const Workers& workers) const;
    /// @param hessian  may be null
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const;

  private:
    Vec3d curvature_force(std::size_t row, Places places) const;
    void add_curved(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                    const Workers& workers) const;

    std::vector<ElasticHinge> curved_;
    SlabLists curved_slabs_;
    std::vector<std::array<std::uint32_t, 16>> curved_entries_;
    std::vector<double> angles_before_;
    Rows<double> flat_;                       ///< the quadratic form, [particle]
    Rows<double> flat_damping_;               ///< the values of flat_ times the damping, on its pattern
    std::vector<std::uint32_t> flat_entries_; ///< by entry: the block, or the multiple with kIsMultiple
    std::vector<Vec3d> before_;               ///< the positions when the step began, if anything is damped
    double inverse_step_ = 0;
};

} // namespace echinus
