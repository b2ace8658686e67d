#pragma once

#include <echinus/geometry.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace echinus::test {

/// How to treat a point on the plane of a face.
enum class OnPlane : std::uint8_t {
    /// The face does not count. Right for every point that does not lie on the surface itself.
    Skip,
    /// The point is displaced by (e, e^2, e^3) with e = 2^-60 and judged in exact integers. Right for every
    /// point of whole numbers, even on the surface; corners and points must be whole numbers below 2^21.
    Displace,
};

/// Winding numbers of a closed surface, even self-intersecting: signed crossings along a ray, each decided by
/// CGAL's exact predicates (EPICK). Unlike those of a map, the rays are not aimed at its centre.
///
/// All rays have the same direction up to jitter, so a grid across that direction lists the faces that a ray
/// can meet. It allows for rounding and jitter: a surplus face costs a predicate but changes no answer.
class CrossingCounter {
  public:
    using Corners = std::array<Vec3d, 3>;

    /// @param unit  about 2^-19 of the surface's radius; exactly 1 for OnPlane::Displace. Points must lie
    ///              within 2^20 units of the surface.
    CrossingCounter(std::vector<Corners> faces, double unit, OnPlane on_plane);
    CrossingCounter(CrossingCounter&& other) noexcept;
    ~CrossingCounter();

    /// Thread-safe.
    int winding(const Vec3d& point) const;

  private:
    struct Structure;
    std::unique_ptr<const Structure> structure_;
};

} // namespace echinus::test
