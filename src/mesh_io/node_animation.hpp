#pragma once

#include "mesh_io/import_scene.hpp"

#include <string_view>
#include <vector>

struct aiAnimation;
struct aiMeshMorphAnim;
struct aiNodeAnim;

namespace echinus {

/// The animation with this name, or the only one when the name is empty.
/// @throws Error InvalidMesh when there is none of this name, or several and no name
const aiAnimation& choose_animation(const SceneFile& file, std::string_view name, const MeshSource& source);

/// How an animation moves the nodes of a file. Between two keys, positions, scales and the weights of morph
/// targets go evenly, and rotations about one axis, the shorter way round; before the first key and after the
/// last they rest. The handles of splines are not used.
class NodeAnimation {
  public:
    /// @throws Error InvalidMesh when keys are out of order or a number is not finite
    NodeAnimation(const SceneFile& file, const aiAnimation& animation, const MeshSource& source);

    double seconds() const { return seconds_; } ///< of the last key
    /// [node_count] where the nodes stand in the world.
    std::vector<Transform> to_world_at(double seconds) const;
    /// [target_count] the weights of the morph targets of the meshes of a node. Empty where they are not
    /// animated.
    std::vector<double> morph_weights_at(std::size_t node, double seconds) const;

  private:
    Transform local_at(std::size_t node, double seconds) const;

    const SceneFile& file_;
    double ticks_per_second_;
    double seconds_ = 0;
    std::vector<const aiNodeAnim*> channels_;            ///< [node_count] null of nodes that are not animated
    std::vector<const aiMeshMorphAnim*> morph_channels_; ///< [node_count] likewise
};

} // namespace echinus
