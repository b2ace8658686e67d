#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/collider.hpp>
#include <echinus/geometry.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The side of the surface to which the particles inside a model move; Nearest leaves the choice to the
/// shape.
enum class ExitSide : std::uint8_t { Nearest, Front, Back };

/// The directions in which the particles inside a model ought to leave it. The nearest point of the model's
/// surface alone would pull neighbours in opposite directions, and through each other.
class ExitDirections {
  public:
    ExitDirections(const Elements& elements, ExitSide side)
        : elements_(elements), side_(side), directions_(elements.vertex_count()) {}

    /// @param inside   [particle] 1 for those inside
    /// @param nearest  [particle] the nearest point of the model, found for those inside and those near it
    void choose(std::span<const Vec3f> positions, std::span<const std::uint8_t> inside,
                std::span<const Contact> nearest);
    /// The direction for a particle, of unit length; 0 if its nearest point is as good as any other.
    const Vec3f& of(std::size_t particle) const { return directions_[particle]; }

  private:
    std::vector<Vec3f> smooth_normals(std::span<const Vec3f> positions) const;
    void let_back_out(std::span<const std::uint8_t> inside, std::span<const Contact> nearest);
    void follow_leaders(std::span<const std::uint8_t> inside, std::span<const Contact> nearest);

    const Elements& elements_;
    ExitSide side_;
    std::vector<Vec3f> directions_;
};

} // namespace echinus
