#pragma once

#include <echinus/collider.hpp>

namespace echinus {

/// A 3 x 3 matrix by rows.
struct Matrix3d {
    Vec3d row_x, row_y, row_z;

    Matrix3d operator*(double s) const { return {row_x * s, row_y * s, row_z * s}; }
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
        : rotation_(matrix_of(collider.pose.rotation)),
          to_local_(rotation_.transposed() * (1 / collider.scale)), translation_(collider.pose.translation),
          scale_(collider.scale) {}

    Vec3f point_to_local(const Vec3f& point_world) const {
        return Vec3f(to_local_ * (Vec3d(point_world) - translation_));
    }
    float length_to_local(float length_world) const { return static_cast<float>(length_world / scale_); }

    /// Takes what the map found for a particle to the world, in place: most particles have no contact, and
    /// copying their answers would take longer than this.
    void contact_to_world(Contact& contact, const Vec3f& point_world) const {
        if (!contact.found()) {
            contact.point = point_world;
            return;
        }
        contact.point = Vec3f(rotation_ * (Vec3d(contact.point) * scale_) + translation_);
        contact.normal = Vec3f(rotation_ * Vec3d(contact.normal));
        contact.depth = static_cast<float>(contact.depth * scale_);
    }

  private:
    Matrix3d rotation_, to_local_;
    Vec3d translation_;
    double scale_;
};

} // namespace echinus
