#pragma once

#include <echinus/collider.hpp>
#include <echinus/echinus.h>

#include <span>
#include <vector>

namespace echinus::c {

/// A pose as it is; the library checks it.
RigidTransform pose_from(const echinus_pose& pose);
echinus_pose pose_to_c(const RigidTransform& pose);

/// @throws WrongArgument unless it is finite and its rotation of unit length
RigidTransform checked_pose(const echinus_pose& pose, const char* name);

/// Keys as they are; a simulation checks them.
std::vector<PoseKey> keys_from(std::span<const echinus_pose_key> keys);

/// A collider for queries, which do not check it.
/// @throws WrongArgument for what a query must not get
Collider collider_at(const echinus_collider* collider);

/// A collider for a simulation, which checks it.
/// @throws WrongArgument for a null map
Collider collider_from(const echinus_collider& collider);

} // namespace echinus::c
