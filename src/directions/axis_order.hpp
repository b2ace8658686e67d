#pragma once

#include <echinus/directions.hpp>
#include <echinus/geometry.hpp>

namespace echinus {

/// Rotates coordinates cyclically until the one along `axis` is the last; the bits stay the same.
template <typename T>
Vec3<T> turned_last(PoleAxis axis, const Vec3<T>& v) {
    switch (axis) {
    case PoleAxis::X:
        return {v.y, v.z, v.x};
    case PoleAxis::Y:
        return {v.z, v.x, v.y};
    default:
        return v;
    }
}

/// The inverse: X and Y are inverse to each other.
template <typename T>
Vec3<T> turned_back(PoleAxis axis, const Vec3<T>& v) {
    if (axis == PoleAxis::Z) return v;
    return turned_last(axis == PoleAxis::X ? PoleAxis::Y : PoleAxis::X, v);
}

} // namespace echinus
