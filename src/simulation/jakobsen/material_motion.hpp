#pragma once

#include "collider/frame_change.hpp"

#include <echinus/geometry.hpp>

namespace echinus {

/// The displacement of a moving collider's material since the previous frame, at any point p that it occupies
/// now: p - previous_pose(pose^-1(p)), an affine function of p. Velocity times time would have an error for a
/// rotation, which would push particles outwards a little in every frame.
struct MaterialMotion {
    Vec3f turn_x, turn_y, turn_z; ///< rows of a matrix; 0 for a collider at rest
    Vec3f centre, shift;

    MaterialMotion() = default;
    MaterialMotion(const RigidTransform& previous_pose, const RigidTransform& pose)
        : centre(pose.translation) {
        const Matrix3d back = matrix_of(previous_pose.rotation * pose.rotation.inverse());
        const Matrix3d turn{Vec3d{1, 0, 0} - back.row_x, Vec3d{0, 1, 0} - back.row_y,
                            Vec3d{0, 0, 1} - back.row_z};
        turn_x = Vec3f(turn.row_x);
        turn_y = Vec3f(turn.row_y);
        turn_z = Vec3f(turn.row_z);
        // The centre was rounded to single precision; the shift compensates for this.
        shift =
            Vec3f(turn * (Vec3d(centre) - pose.translation) + pose.translation - previous_pose.translation);
    }

    Vec3f at(const Vec3f& point_world) const {
        const Vec3f from_centre = point_world - centre;
        return Vec3f{dot(turn_x, from_centre), dot(turn_y, from_centre), dot(turn_z, from_centre)} + shift;
    }
};

} // namespace echinus
