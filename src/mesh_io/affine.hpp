#pragma once

#include <echinus/geometry.hpp>

namespace echinus {

/// An affine map of space: x p.x + y p.y + z p.z + origin.
struct Affine {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}; ///< columns of the linear part
    Vec3d origin;

    Vec3d apply_linear(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
    Vec3d apply(const Vec3d& p) const { return apply_linear(p) + origin; }
    double determinant() const { return dot(x, cross(y, z)); }
    /// @pre determinant() is not 0
    Affine inverse() const {
        const double scale = 1 / determinant();
        const Vec3d a = cross(y, z) * scale, b = cross(z, x) * scale, c = cross(x, y) * scale; // rows
        Affine result{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, {}};
        result.origin = -result.apply_linear(origin);
        return result;
    }
};

/// First `b`, then `a`.
inline Affine operator*(const Affine& a, const Affine& b) {
    return {a.apply_linear(b.x), a.apply_linear(b.y), a.apply_linear(b.z), a.apply(b.origin)};
}

/// Scales, then turns, then moves.
struct NodePlacement {
    Vec3d position;
    Rotation rotation;
    Vec3d scale{1, 1, 1};

    Affine affine() const {
        return {rotation.apply({scale.x, 0, 0}), rotation.apply({0, scale.y, 0}),
                rotation.apply({0, 0, scale.z}), position};
    }
};

} // namespace echinus
