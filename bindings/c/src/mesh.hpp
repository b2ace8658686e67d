#pragma once

#include <echinus/echinus.h>
#include <echinus/mesh.hpp>

#include <cstddef>
#include <vector>

struct echinus_mesh {
    echinus::TriangleMesh value;
};

namespace echinus::c {

/// Copies of a caller's arrays.
std::vector<Vec3f> points_from(const float* points, std::size_t count, std::size_t stride, const char* name);
std::vector<Triangle> faces_from(const std::uint32_t* faces, std::size_t count, const char* name);

} // namespace echinus::c
