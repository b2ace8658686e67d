#pragma once

#include "mechanics/energy_term.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Of a closed surface, its corners counter-clockwise as seen from outside.
struct PressedTriangle {
    std::array<std::uint32_t, 3> particles;
    double pressure; ///< beyond that outside, force per area
};

/// The work of a constant pressure inside closed surfaces, -p V: the forces on a surface sum up to nothing,
/// and move it as a whole nowhere.
class Pressure {
  public:
    Pressure(std::vector<PressedTriangle> triangles, std::size_t particle_count);

    void begin_step(Places places);
    double energy(Places places, const Workers& workers) const;
    /// The Hessian, which is not semi-definite, is left out: it is smaller than that of the membrane that
    /// bears the pressure by an element's size over the radius.
    void add_gradient(Places places, std::span<Vec3d> gradient, const Workers& workers) const;

  private:
    std::vector<PressedTriangle> triangles_;
    SlabLists slabs_;
    Vec3d origin_; ///< any place near the surface, or volumes would be small differences of large ones
};

} // namespace echinus
