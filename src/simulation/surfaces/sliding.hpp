#pragma once

#include "simulation/particles.hpp"
#include "simulation/surfaces/elements.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace echinus {

/// A corner or an edge of a surface.
struct Ridge {
    std::uint32_t a, b; ///< the same for a corner
};

/// That on which a point lies, or none within a face.
/// @param vertices, weights  of the point's face, edge or corner, and their shares in the point
std::optional<Ridge> ridge_of(std::span<const std::uint32_t> vertices, std::span<const float> weights);

/// Does something go along the faces around a ridge rather than towards them, where these form a smooth side
/// that rises above the plane with this normal through the ridge? Then they are nearer than the ridge, and
/// the plane would stop what slides along the side at every edge within it.
/// @param normal  from the ridge to what goes
/// @param way     how that goes, relative to the ridge
bool slides_past(const Ridge& ridge, const Elements& elements, const PointArrays& positions,
                 const Vec3f& normal, const Vec3f& way);

} // namespace echinus
