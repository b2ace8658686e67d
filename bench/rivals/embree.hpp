#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

/// Embree 3 on one thread, with its robust intersections and its best tree. It answers as one would with a
/// ray tracer: the sign by a ray along a fixed direction, the distance by a point query.
class EmbreeRival {
  public:
    /// @param mesh  kept by reference
    explicit EmbreeRival(const echinus::TriangleMesh& mesh);
    ~EmbreeRival();

    /// Is the first face along the ray seen from behind?
    bool inside(const echinus::Vec3f& point) const;

    /// inside() for many points. @param inside  [n] out
    void first_hits(std::span<const echinus::Vec3f> points, std::span<std::uint8_t> inside) const;
    /// The same with sixteen rays a call.
    void first_hits_by_packets(std::span<const echinus::Vec3f> points, std::span<std::uint8_t> inside) const;
    /// Does the ray cross an odd number of faces?
    void parities(std::span<const echinus::Vec3f> points, std::span<std::uint8_t> inside) const;
    /// The same with sixteen rays a call.
    void parities_by_packets(std::span<const echinus::Vec3f> points, std::span<std::uint8_t> inside) const;

    /// The nearest point of the surface, by a point query with an exact distance to each face.
    struct Nearest {
        echinus::Vec3f point;
        float distance;
    };
    Nearest nearest(const echinus::Vec3f& point) const;
    float distance(const echinus::Vec3f& point) const { return nearest(point).distance; }

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
