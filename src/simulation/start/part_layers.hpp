#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/geometry.hpp>

#include <vector>

namespace echinus {

/// Separates crossing layers of a deformable. If an edge passes through a face, one of its ends is moved
/// across the face's plane to the side of the other end, so that the part that has come through moves back by
/// one row of particles per round.
///
/// To find that part, all edges that pass through something are cut: of the pieces into which the surface
/// falls, the smaller one has come through. If the cuts do not go all the way across, because each layer cuts
/// into the other from its own border, there are three variants: the layer with the smaller particle numbers
/// moves to the front of the other, or to its back, or, at each edge, the end nearer to the face moves. The
/// variant that leaves the fewest intersecting pairs is taken and, of several, the one that stretches edges
/// least.
///
/// @param gap        the gap left between the layers, in the caller's unit
/// @param face_moves  the face moves instead of the particle, to the same effect, for use if a model is in
/// the particle's way
/// @param positions  [particle_count] of the particles; if the particle or the face is pinned, the other of
/// the two moves
/// @return whether a particle was moved
bool part_layers(const Elements& elements, const std::vector<float>& inverse_masses, float gap,
                 bool face_moves, std::vector<Vec3f>& positions);

} // namespace echinus
