#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Positions as floats, relative to an origin.
struct LocalPositions {
    std::vector<Vec3f> positions;
    Vec3d origin; ///< 0, or a multiple of a power of two on each axis
};

/// Moves positions to a local origin where float would be too coarse for them, and rounds them to float.
///
/// The origin is 0 as long as float, at the largest coordinate that is used, rounds by no more than 2^-15
/// (3e-5) of half the longest side of the used positions' box. Otherwise it is the middle of this box, on a
/// grid of the largest power of two within that half. Then the subtraction is exact in double, except for
/// coordinates that are far smaller than the box, and float rounds the differences by no more than 2^-24 of
/// its longest side.
/// @param used  indices of the positions that count; those out of range do not, as little as positions that
///              are not finite
LocalPositions to_local_frame(std::span<const Vec3d> positions, std::span<const std::uint32_t> used);

/// Expresses the vertices relative to another origin, each rounded once.
void move_to_origin(const Vec3d& origin, TriangleMesh& mesh);

/// Refuses what a simulation, whose positions are floats around 0, cannot hold.
/// @param what  "the cloth", for instance
/// @throws Error InvalidMesh unless the origin is 0
void require_no_origin(const Vec3d& origin, const std::string& what);

/// By how much float, at such a coordinate, rounds at most: half of its step.
double float_rounding(double coordinate);

} // namespace echinus

ECHINUS_EXPORT_END
