#pragma once

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>

#include <cstddef>
#include <span>

/// Where particles are, judged by the mesh itself.
struct Verdict {
    std::size_t inside_count = 0;
    double deepest = 0; ///< distance of the deepest of them from the surface, units
};

/// A mesh stretched along its axes. Where that mirrors it, its faces are turned round, so that what was
/// inside stays inside.
echinus::TriangleMesh scaled(echinus::TriangleMesh mesh, const echinus::Vec3d& scale);

/// Judges every particle by its winding number and its distance from the surface, both brute force over all
/// faces; of the collider only pose and scale enter, not the map.
/// @param thread_count  0: all cores
Verdict judge(std::span<const echinus::Vec3f> positions_world, const echinus::TriangleMesh& mesh,
              const echinus::Collider& collider, unsigned thread_count);
