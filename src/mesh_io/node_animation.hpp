#pragma once

#include "mesh_io/mesh_source.hpp"
#include "mesh_io/scene_file.hpp"

#include <string_view>
#include <vector>

namespace echinus {

/// The animation with this name, or the only one when the name is empty.
/// @throws Error InvalidMesh when there is none of this name, or several and no name
const SceneAnimation& choose_animation(const SceneFile& file, std::string_view name,
                                       const MeshSource& source);

/// How an animation moves the nodes of a file. Between two keys, positions, scales and the weights of morph
/// targets go evenly, and rotations about one axis, the shorter way round; before the first key and after the
/// last they rest. The handles of splines are not used.
class NodeAnimation {
  public:
    /// @throws Error InvalidMesh when keys are out of order or a number is not finite
    NodeAnimation(const SceneFile& file, const SceneAnimation& animation, const MeshSource& source);

    double seconds() const { return seconds_; } ///< of the last key
    Pose pose_at(double seconds) const;

  private:
    const SceneFile& file_;
    const SceneAnimation& animation_;
    double seconds_ = 0;
};

} // namespace echinus
