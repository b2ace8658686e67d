#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/geometry.hpp>

#include <vector>

namespace echinus {

/// Moves crossing layers of a deformable apart. Where an edge passes through a face, one of its ends is
/// carried across the face's plane to the other, and so the part that has come through goes back, one row of
/// particles a round.
///
/// Which part that is shows once all edges that pass through something are cut: of the pieces that the
/// surface falls into, the smaller one has come through. Where the cuts do not go all the way across, because
/// each layer cuts into the other from its own border, the layer of the smaller particle numbers moves to the
/// other one's front, or to its back, or each of its edges by the end that is nearer to the face: the way
/// after which the fewest pairs intersect, and of those the one that stretches edges least.
///
/// @param gap        that is left between them, units
/// @param face_moves  instead of the particle, to the same effect: where a model is in the particle's way
/// @param positions  [particle_count] of the particles; pinned ones, and pinned faces, stay where they are,
/// and
///                   the other of the two moves
/// @return whether a particle was moved
bool part_layers(const Elements& elements, const std::vector<float>& inverse_masses, float gap,
                 bool face_moves, std::vector<Vec3f>& positions);

} // namespace echinus
