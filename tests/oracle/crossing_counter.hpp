#pragma once

#include <echinus/geometry.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace echinus::test {

/// What a point on the plane of a face does.
enum class OnPlane : std::uint8_t {
    /// The face is not counted. Right for every point that does not lie on the surface itself.
    Skip,
    /// The point is displaced by (e, e^2, e^3) with e = 2^-60 and judged in exact integers. Right for every
    /// point of whole numbers, on the surface too; corners and points must be whole numbers below 2^21.
    Displace,
};

/// Winding numbers of a closed surface, whatever its parts do to each other: signed crossings along a ray,
/// every one decided by CGAL's exact predicates (EPICK). No ray passes near the centre of a map on purpose.
///
/// All rays have the same direction but for jitter, so a grid across that direction lists the faces that a
/// ray can meet. It is wider than rounding and jitter: a face too many costs a predicate and no answer.
class CrossingCounter {
  public:
    using Corners = std::array<Vec3d, 3>;

    /// @param unit  about 2^-19 of the surface's radius; exactly 1 for OnPlane::Displace. Points must lie
    ///              within 2^20 units of the surface.
    CrossingCounter(std::vector<Corners> faces, double unit, OnPlane on_plane);
    CrossingCounter(CrossingCounter&& other) noexcept;
    ~CrossingCounter();

    /// Any number of threads may ask.
    int winding(const Vec3d& point) const;

  private:
    struct Structure;
    std::unique_ptr<const Structure> structure_;
};

} // namespace echinus::test
