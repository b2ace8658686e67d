#pragma once

#include <echinus/directions.hpp>
#include <echinus/geometry.hpp>

namespace echinus {

/// Turns coordinates cyclically, until that along `axis` is the last: a rotation, which keeps bits.
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

/// The inverse: X and Y undo each other.
template <typename T>
Vec3<T> turned_back(PoleAxis axis, const Vec3<T>& v) {
    if (axis == PoleAxis::Z) return v;
    return turned_last(axis == PoleAxis::X ? PoleAxis::Y : PoleAxis::X, v);
}

} // namespace echinus
