#pragma once

#include "mesh_io/import_scene.hpp"
#include "mesh_io/node_animation.hpp"

#include <cstdint>
#include <vector>

namespace echinus {

/// The meshes of a file as an animation deforms them: first by morph targets, then each vertex by the bones
/// that have weight on it (linear blend skinning), or by its node where the mesh has no bones.
class SkinnedMeshes {
  public:
    /// @throws Error InvalidMesh when a bone is no node of the file, or a vertex of a mesh with bones has
    /// none
    SkinnedMeshes(const SceneFile& file, const NodeAnimation& animation, const MeshSource& source);

    /// [vertex_count of the joined mesh] in the world.
    std::vector<Vec3f> vertices_at(double seconds) const;

  private:
    struct Bone {
        std::size_t node;
        Transform offset; ///< from the mesh to the bone, in the pose in which they were bound
    };
    struct Influence {
        std::uint32_t bone; ///< in Skin::bones
        double weight;
    };
    struct Skin {
        std::vector<Bone> bones; ///< empty where the node leads the mesh
        /// Influences on vertex i: from first_influences[i] to before first_influences[i + 1]; they sum to 1.
        std::vector<std::uint32_t> first_influences;
        std::vector<Influence> influences;
    };

    static Skin make_skin(const SceneFile& file, const aiMesh& mesh, const MeshSource& source);
    void add_instance(std::size_t instance, const std::vector<Transform>& to_world, double seconds,
                      std::vector<Vec3f>& vertices) const;

    const SceneFile& file_;
    const NodeAnimation& animation_;
    std::vector<Skin> skins_; ///< [instance_count]
};

} // namespace echinus
