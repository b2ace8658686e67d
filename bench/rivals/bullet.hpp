#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <memory>

/// Bullet's static triangle mesh with its tree of boxes. It has no test for a particle in the solid, so it is
/// asked as its users do: by a ray, and by a small sphere, which meets the surface only.
class BulletRival {
  public:
    explicit BulletRival(const echinus::TriangleMesh& mesh);
    ~BulletRival();

    /// Is the first face along a fixed ray seen from behind?
    bool inside(const echinus::Vec3f& point) const;

    /// What the construction took from the heap, and the arrays that Bullet reads in place.
    std::size_t byte_count() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
