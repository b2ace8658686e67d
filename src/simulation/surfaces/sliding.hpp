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

/// How something goes past a ridge.
struct Passage {
    Vec3f normal; ///< from the ridge to what goes
    Vec3f way;    ///< how that goes, relative to the ridge
};

/// When something goes along a side rather than towards it.
struct SlidingLimits {
    float smoothness;        ///< of a side: the cosine of the most by which its faces are turned
    float towards;           ///< its way along the faces' normal, as a share of that along the passage's
    float least_height = -1; ///< its height above the faces, as a share of its distance
};

/// What the faces around a ridge are for what goes past.
enum class Faces {
    Low,     ///< they do not rise above the plane through the ridge, or what goes comes towards them
    Passed,  ///< they are a smooth side that rises above the plane, and what goes goes along it
    Crumpled ///< they rise above the plane, and are not smooth
};

/// Where a smooth side rises above the plane with the passage's normal through a ridge, its faces are nearer
/// than the ridge, and the plane would stop what slides along the side at every edge within it.
Faces faces_at(const Ridge& ridge, const Elements& elements, const PointArrays& positions,
               const Passage& passage, const SlidingLimits& limits);

} // namespace echinus
