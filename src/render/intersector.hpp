#pragma once

#include "mesh/faces.hpp"

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace echinus::render {

struct Ray {
    Vec3f origin;
    Vec3f direction; ///< need not have unit length
};

/// A ray's first hit on a mesh.
struct RayHit {
    std::uint32_t face = kNoFace;
    float distance = 0; ///< in lengths of the ray's direction
    float u = 0, v = 0; ///< the point is (1 - u - v) corner 0 + u corner 1 + v corner 2

    bool found() const { return face != kNoFace; }
};

/// Embree's tree over one mesh: finds the nearest hit, or whether there is any. Watertight at shared edges.
/// Gives the same answers on every run and for every number of threads; thread-safe.
class Intersector {
  public:
    /// @throws Error InvalidOptions if Embree cannot start or has no memory
    explicit Intersector(const TriangleMesh& mesh);
    ~Intersector();
    Intersector(const Intersector&) = delete;
    Intersector& operator=(const Intersector&) = delete;

    /// Rays are traced in packets; rays of one packet should start close together.
    static constexpr std::size_t kPacketSize = 16;

    /// @param rays  [n], n <= kPacketSize
    /// @param hits  [n] out
    void first_hits(std::span<const Ray> rays, std::span<RayHit> hits) const noexcept;

    /// Does a ray hit anything beyond its origin?
    /// @param rays  [n], n <= kPacketSize
    /// @return bit i set: ray i is blocked
    std::uint32_t blocked(std::span<const Ray> rays) const noexcept;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace echinus::render
