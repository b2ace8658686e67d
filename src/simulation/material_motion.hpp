#pragma once

#include "collider/frame_change.hpp"

#include <echinus/geometry.hpp>

namespace echinus {

/// How far the material of a moving collider went since the previous frame, at any point that it occupies
/// now: p - previous_pose(pose^-1(p)), an affine function of p. Not velocity times time, whose error for a
/// rotation would push particles outwards a little in every frame.
class MaterialMotion {
  public:
    MaterialMotion(const RigidTransform& previous_pose, const RigidTransform& pose)
        : centre_(pose.translation), shift_(pose.translation - previous_pose.translation) {
        const Matrix3d back = matrix_of(previous_pose.rotation * pose.rotation.inverse());
        turn_ = {Vec3d{1, 0, 0} - back.row_x, Vec3d{0, 1, 0} - back.row_y, Vec3d{0, 0, 1} - back.row_z};
    }

    Vec3f at(const Vec3f& point_world) const {
        return Vec3f(turn_ * (Vec3d(point_world) - centre_) + shift_);
    }

  private:
    Matrix3d turn_;
    Vec3d centre_, shift_;
};

} // namespace echinus
