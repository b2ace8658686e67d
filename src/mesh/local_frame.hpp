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

/// Moves positions to a local origin if float would be too coarse for them otherwise, and rounds them to
/// float.
///
/// The origin is 0 if float, at the largest coordinate that is used, rounds by at most 2^-15 (3e-5) of half
/// the longest side of the used positions' box. Otherwise it is the middle of this box, rounded to a grid of
/// the largest power of two within that half. Then the subtraction is exact in double, except for coordinates
/// that are far smaller than the box, and float rounds the differences by at most 2^-24 of the box's longest
/// side.
/// @param used  indices of the used positions; indices out of range are ignored, and so are positions that
///              are not finite
LocalPositions to_local_frame(std::span<const Vec3d> positions, std::span<const std::uint32_t> used);

/// Expresses the vertices relative to another origin, each rounded once.
void move_to_origin(const Vec3d& origin, TriangleMesh& mesh);

/// Rejects meshes that a simulation, whose positions are floats around 0, cannot represent.
/// @param what  for the message; "the cloth", for instance
/// @throws Error InvalidMesh unless the origin is 0
void require_no_origin(const Vec3d& origin, const std::string& what);

/// The most by which float rounds a coordinate of this size: half the distance between neighbouring floats.
double float_rounding(double coordinate);

} // namespace echinus

ECHINUS_EXPORT_END
