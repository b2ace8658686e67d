#pragma once

#include "mechanics/energy_term.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A triangle of a closed surface, with corners in counter-clockwise order as seen from outside.
struct PressedTriangle {
    std::array<std::uint32_t, 3> particles;
    double pressure; ///< in excess of the pressure outside; force per area
};

/// The work of a constant pressure inside closed surfaces, -p V. The forces on a surface sum to zero, so they
/// do not move it as a whole.
class Pressure {
  public:
    Pressure(std::vector<PressedTriangle> triangles, std::size_t particle_count);

    void begin_step(Places places);
    double energy(Places places, const Workers& workers) const;
    /// The Hessian, which is indefinite, is left out: relative to that of the membrane that bears the
    /// pressure, it is small by the ratio of an element's size to the radius.
    void add_gradient(Places places, std::span<Vec3d> gradient, const Workers& workers) const;

  private:
    std::vector<PressedTriangle> triangles_;
    SlabLists slabs_;
    Vec3d origin_; ///< a point near the surface, so that volumes are not small differences of large numbers
};

} // namespace echinus
