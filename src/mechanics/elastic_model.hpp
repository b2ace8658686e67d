#pragma once

#include "mechanics/bending.hpp"
#include "mechanics/membrane.hpp"
#include "mechanics/neo_hookean.hpp"
#include "mechanics/pressure.hpp"
#include "mechanics/springs.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The material parts of a deformable.
struct ElasticParts {
    std::vector<Vec3d> rest_places; ///< [particle] for the coarse levels; may be those of a cut-out pattern
    std::vector<double> masses;     ///< [particle] positive
    std::vector<ElasticTriangle> triangles;
    std::vector<ElasticHinge> hinges;
    std::vector<ElasticSpring> springs;
    std::vector<ElasticTetrahedron> tetrahedra;
    std::vector<PressedTriangle> pressed; ///< closed surfaces
};

/// The elastic energy of a deformable, and what a step dissipates in it.
class ElasticModel {
  public:
    explicit ElasticModel(const ElasticParts& parts);

    /// A matrix with the pattern of the Hessian.
    BlockMatrix pattern() const;
    void find_entries(const BlockMatrix& matrix);

    void begin_step(Places places, double step);
    double energy(Places places, const Workers& workers) const;
    /// The gradient and a positive semi-definite Hessian. @param hessian  may be null
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const;

    const Membrane& membrane() const { return membrane_; }

  private:
    std::size_t particle_count_;
    Membrane membrane_;
    Bending bending_;
    Springs springs_;
    NeoHookean tetrahedra_;
    Pressure pressure_;
};

} // namespace echinus
