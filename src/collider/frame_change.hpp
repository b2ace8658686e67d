#pragma once

#include <echinus/collider.hpp>

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

/// A collider's pose and scale, ready to be applied to many points: nine products instead of a quaternion.
class FrameChange {
  public:
    explicit FrameChange(const Collider& collider)
        : to_world_(matrix_of(collider.pose.rotation)), to_local_(to_world_.transposed()),
          translation_(collider.pose.translation), scale_(collider.scale), inverse_scale_(1 / scale_) {}

    Vec3f point_to_local(const Vec3f& point_world) const {
        return Vec3f(to_local_ * (Vec3d(point_world) - translation_) * inverse_scale_);
    }
    float length_to_local(float length_world) const {
        return static_cast<float>(length_world * inverse_scale_);
    }
    Contact contact_to_world(const Contact& local, const Vec3f& point_world) const {
        Contact world = local;
        world.point = point_world;
        if (!local.found()) return world;
        world.point = Vec3f(to_world_ * Vec3d(local.point) * scale_ + translation_);
        world.normal = Vec3f(to_world_ * Vec3d(local.normal));
        world.depth = static_cast<float>(local.depth * scale_);
        return world;
    }

  private:
    Matrix3d to_world_, to_local_;
    Vec3d translation_;
    double scale_, inverse_scale_;
};

} // namespace echinus
