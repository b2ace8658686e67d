#pragma once

#include <echinus/collider.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

namespace echinus {

/// A 3 x 3 matrix by rows.
struct Matrix3d {
    Vec3d row_x, row_y, row_z;

    Vec3d operator*(const Vec3d& v) const { return {dot(row_x, v), dot(row_y, v), dot(row_z, v)}; }
    Matrix3d transposed() const {
        return {{row_x.x, row_y.x, row_z.x}, {row_x.y, row_y.y, row_z.y}, {row_x.z, row_y.z, row_z.z}};
    }
};

inline Matrix3d matrix_of(const Rotation& rotation) {
    const Matrix3d columns{rotation.apply({1, 0, 0}), rotation.apply({0, 1, 0}), rotation.apply({0, 0, 1})};
    return columns.transposed();
}

inline Vec3d times(const Vec3d& a, const Vec3d& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// The origin of the local frame of a collider's map; 0 for a custom map.
inline Vec3d origin_of(const std::shared_ptr<const CustomMap>&) {
    return {};
}
inline Vec3d origin_of(const auto& map) {
    return map.view().origin;
}
inline Vec3d origin_of(const ColliderMap& map) {
    return std::visit([](const auto& kind) { return origin_of(kind); }, map.kind);
}

/// A pose and a scale, prepared for many points: a matrix of nine products in place of a quaternion.
class FrameChange {
  public:
    FrameChange(const RigidTransform& pose, const Vec3d& scale)
        : rotation_(matrix_of(pose.rotation)), translation_(pose.translation),
          scale_(scale), inverse_scale_{1 / scale.x, 1 / scale.y, 1 / scale.z} {
        const Matrix3d back = rotation_.transposed();
        to_local_ = {back.row_x * inverse_scale_.x, back.row_y * inverse_scale_.y,
                     back.row_z * inverse_scale_.z};
        const Vec3d sizes{std::fabs(scale.x), std::fabs(scale.y), std::fabs(scale.z)};
        least_scale_ = std::min({sizes.x, sizes.y, sizes.z});
        uniform_ = scale.x > 0 && scale.x == scale.y && scale.x == scale.z;
    }
    explicit FrameChange(const Collider& collider) : FrameChange(collider, collider.pose) {}
    /// The frame change of the collider in a given pose.
    FrameChange(const Collider& collider, const RigidTransform& pose) : FrameChange(pose, collider.scale) {
        const Vec3d origin = origin_of(collider.map);
        if (origin != Vec3d{}) translation_ = pose.to_world(times(origin, scale_));
    }

    template <typename T>
    Vec3f point_to_local(const Vec3<T>& point_world) const {
        return Vec3f(to_local_ * (Vec3d(point_world) - translation_));
    }
    template <typename T = float>
    Vec3<T> point_to_world(const Vec3f& point_local) const {
        return Vec3<T>(rotation_ * times(Vec3d(point_local), scale_) + translation_);
    }
    /// Rotates a unit normal of the scaled surface, given along the map's axes, to the world.
    Vec3f normal_to_world(const Vec3f& normal) const { return Vec3f(rotation_ * Vec3d(normal)); }
    /// Converts a normal of the unscaled surface to one of the scaled surface, both along the map's axes. It
    /// multiplies by the inverse transpose of the scale, so that outward normals stay outward in a mirror
    /// image, too.
    Vec3f scaled_normal(const Vec3f& normal) const {
        const Vec3d scaled = times(Vec3d(normal), inverse_scale_);
        const double size = length(scaled);
        return size > 0 ? Vec3f(scaled * (1 / size)) : Vec3f{};
    }
    /// The length in the world of a local displacement, divided by its local length.
    double stretch_along(const Vec3d& step_local) const {
        const double size = length(step_local);
        return size > 0 ? length(times(step_local, scale_)) / size : least_scale_;
    }
    /// The smallest factor by which a length changes.
    double least_scale() const { return least_scale_; }
    /// Three equal positive scales: all lengths change by the same factor, and normals do not change.
    bool uniform() const { return uniform_; }
    const Vec3d& scale() const { return scale_; }

  private:
    Matrix3d rotation_, to_local_;
    Vec3d translation_, scale_, inverse_scale_;
    double least_scale_ = 1;
    bool uniform_ = true;
};

} // namespace echinus
