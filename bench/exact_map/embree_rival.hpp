#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <memory>

/// The rival: Embree 3 on one thread, with its robust intersections and its best tree. It answers as one
/// would with a ray tracer: inside when the first face along a fixed direction is seen from behind, and the
/// distance by a point query.
class EmbreeRival {
  public:
    /// @param mesh  kept by reference
    explicit EmbreeRival(const echinus::TriangleMesh& mesh);
    ~EmbreeRival();

    bool inside(const echinus::Vec3f& point) const;

    /// To the nearest point of the surface.
    float distance(const echinus::Vec3f& point) const;

    /// Does a face cross the straight way between two points?
    bool crossed(const echinus::Vec3f& from, const echinus::Vec3f& to) const;

    /// By Embree's own account: tree, vertices and faces.
    std::size_t byte_count() const;

    /// Processor time of the construction.
    double build_seconds() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
