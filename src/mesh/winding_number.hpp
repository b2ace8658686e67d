#pragma once

#include <echinus/mesh.hpp>

#include <span>

namespace echinus {

/// winding_number() of some faces.
double winding_number(std::span<const Vec3f> vertices, std::span<const Triangle> faces, const Vec3d& point);

} // namespace echinus
