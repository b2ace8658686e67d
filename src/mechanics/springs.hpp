#pragma once

#include "mechanics/energy_term.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A thread or a seam, with the energy k/2 (l - rest length)^2.
struct ElasticSpring {
    std::uint32_t a, b;
    float rest_length; ///< not negative
    float stiffness;   ///< mass / s^2
    float damping;     ///< viscosity over stiffness, seconds
};

class Springs {
  public:
    Springs(std::vector<ElasticSpring> springs, std::size_t particle_count);

    void couple(std::vector<Coupling>& blocks) const;
    void find_entries(const BlockMatrix& matrix);

    void begin_step(Places places, double step);
    double energy(Places places, const Workers& workers) const;
    /// @param hessian  may be null
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const;

  private:
    std::vector<ElasticSpring> springs_;
    SlabLists slabs_;
    std::vector<std::array<std::uint32_t, 4>> entries_;
    std::vector<double> lengths_before_;
    double inverse_step_ = 0;
};

} // namespace echinus
