#pragma once

#include <echinus/geometry.hpp>

#include <algorithm>
#include <limits>

namespace echinus {

/// The smallest closed axis-aligned box around everything that was added. At first it is empty: low is
/// infinity and high is minus infinity. NaN must not be added.
template <typename T>
struct AlignedBox {
    static constexpr T kInfinity = std::numeric_limits<T>::infinity();

    Vec3<T> low{kInfinity, kInfinity, kInfinity};
    Vec3<T> high{-kInfinity, -kInfinity, -kInfinity};

    void add(const Vec3<T>& point) {
        low = {std::min(low.x, point.x), std::min(low.y, point.y), std::min(low.z, point.z)};
        high = {std::max(high.x, point.x), std::max(high.y, point.y), std::max(high.z, point.z)};
    }
    void add(const AlignedBox& other) {
        low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y), std::min(low.z, other.low.z)};
        high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y),
                std::max(high.z, other.high.z)};
    }

    /// Boxes that touch overlap, too.
    bool overlaps(const AlignedBox& other) const {
        // Written without branches, since it is unpredictable which comparison fails.
        return (low.x <= other.high.x) & (low.y <= other.high.y) & (low.z <= other.high.z) &
               (other.low.x <= high.x) & (other.low.y <= high.y) & (other.low.z <= high.z);
    }
    bool contains(const AlignedBox& other) const {
        return low.x <= other.low.x && low.y <= other.low.y && low.z <= other.low.z &&
               high.x >= other.high.x && high.y >= other.high.y && high.z >= other.high.z;
    }

    /// The lengths of its sides; minus infinity for an empty box. In double, since the difference of two
    /// floats may exceed the range of float.
    Vec3d sides() const { return Vec3d(high) - Vec3d(low); }
    /// The axis along which the box is longest; of several, the first.
    T Vec3<T>::*longest_axis() const {
        const Vec3d side = sides();
        if (side.x >= side.y && side.x >= side.z) return &Vec3<T>::x;
        return side.y >= side.z ? &Vec3<T>::y : &Vec3<T>::z;
    }
    /// The largest absolute coordinate of its corners. @pre not empty
    T largest_coordinate() const { return std::max({-low.x, -low.y, -low.z, high.x, high.y, high.z}); }

    /// The distance from a point to the nearest point of the box: 0 inside, infinite for an empty box.
    double distance(const Vec3d& point) const {
        const Vec3d below = Vec3d(low) - point, above = point - Vec3d(high);
        return length(Vec3d{std::max({below.x, above.x, 0.0}), std::max({below.y, above.y, 0.0}),
                            std::max({below.z, above.z, 0.0})});
    }
    /// The distance from a point in the box to the farthest point of the box.
    double farthest_distance(const Vec3d& point) const {
        const Vec3d below = point - Vec3d(low), above = Vec3d(high) - point;
        return length(
            Vec3d{std::max(above.x, below.x), std::max(above.y, below.y), std::max(above.z, below.z)});
    }
};

} // namespace echinus
