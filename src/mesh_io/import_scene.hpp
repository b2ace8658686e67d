#pragma once

#include "mesh_io/mesh_source.hpp"
#include "mesh_io/polygon_mesh.hpp"

#include <assimp/Importer.hpp>
#include <assimp/matrix4x4.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

struct aiMesh;
struct aiNode;
struct aiScene;

namespace echinus {

using Transform = aiMatrix4x4t<double>;

/// The local coordinates of a point, led to the world. Rounded to float.
Vec3f transformed(const Transform& to_world, const Vec3d& point);

struct SceneNode {
    const aiNode* node;
    std::size_t parent; ///< in SceneFile::nodes(), before the node; of the root itself
};

/// A mesh where a node has it.
struct MeshInstance {
    const aiMesh* mesh;
    std::size_t node;         ///< in SceneFile::nodes()
    std::size_t first_vertex; ///< in the joined mesh
};

/// A file in Assimp's hands, its meshes in the order in which they are joined.
class SceneFile {
  public:
    /// @throws Error WrongFormat, Damaged or InvalidMesh when the file cannot be read, has no nodes or names
    /// vertices that are not there
    explicit SceneFile(const MeshSource& source);
    ~SceneFile();
    SceneFile(const SceneFile&) = delete;
    SceneFile& operator=(const SceneFile&) = delete;

    const aiScene& scene() const { return *scene_; }
    const std::vector<SceneNode>& nodes() const { return nodes_; }            ///< parents first
    const std::vector<MeshInstance>& instances() const { return instances_; } ///< in the nodes' order

    /// Where a node stands in its parent, when nothing is animated.
    static Transform rest_transform(const aiNode& node);
    /// All meshes where they stand when nothing is animated and no bone leads them.
    /// @throws Error InvalidMesh when a vertex is not finite
    PolygonMesh join() const;

  private:
    const MeshSource& source_;
    std::unique_ptr<Assimp::Importer> importer_;
    const aiScene* scene_ = nullptr; ///< the importer's
    std::vector<SceneNode> nodes_;
    std::vector<MeshInstance> instances_;
};

} // namespace echinus
