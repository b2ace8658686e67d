#pragma once

#include "rivals/depth_normal.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <memory>

/// FCL's tree of oriented boxes with spheres (OBBRSS), asked for the distance of a tiny sphere. FCL knows no
/// inside of a mesh: the side is taken from the nearest face, which errs where an edge or a vertex is
/// nearest.
class FclRival {
  public:
    explicit FclRival(const echinus::TriangleMesh& mesh);
    ~FclRival();

    DepthNormal contact(const echinus::Vec3f& point) const;

    /// What the construction took from the heap.
    std::size_t byte_count() const;

  private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};
