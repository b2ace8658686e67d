#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <memory>

/// CGAL's tree of boxes: the side of a particle by an exact ray parity (Side_of_triangle_mesh) and the
/// nearest point. With exact predicates and rounded constructions.
class CgalRival {
  public:
    explicit CgalRival(const echinus::TriangleMesh& mesh);
    ~CgalRival();

    bool inside(const echinus::Vec3f& point) const;
    echinus::Vec3d nearest(const echinus::Vec3f& point) const;

    /// What the construction took from the heap.
    std::size_t byte_count() const;

  private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};
