#pragma once
#include "mesh_io/scenes/gltf_file.hpp"
#include "mesh_io/scenes/scene_file.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace echinus {

/// Makes shapes of the primitives of glTF meshes (glTF 2.0, section 3.7.2). Even if many primitives share an
/// accessor, the time is linear in the number of elements that they use.
class GltfShapes {
  public:
    explicit GltfShapes(GltfFile& file) : file_(file) {}

    /// The shapes of a mesh: one for each primitive with triangles or lines.
    /// @param user  the value that names the mesh
    /// @return numbers in shapes()
    const std::vector<std::size_t>& shapes_of(const GltfValue& user);

    std::vector<SceneShape>& shapes() { return shapes_; }

  private:
    SceneShape make_shape(const GltfValue& primitive, const std::string& name);
    const std::vector<Vec3d>& positions_of(const GltfValue& user);
    std::vector<std::uint32_t> corners_of(const GltfValue& primitive, std::size_t vertex_count,
                                          const std::string& name);
    std::vector<std::uint32_t> keep_used_vertices(std::size_t vertex_count, SceneShape& shape);
    void read_targets(const GltfValue& primitive, std::size_t vertex_count,
                      const std::vector<std::uint32_t>& used, SceneShape& shape);
    void read_influences(const GltfValue& primitive, std::size_t vertex_count,
                         const std::vector<std::uint32_t>& used, SceneShape& shape);

    GltfFile& file_;
    std::vector<SceneShape> shapes_;
    std::map<std::size_t, std::vector<std::size_t>> shapes_of_meshes_;
    std::map<std::size_t, std::vector<Vec3d>> positions_; ///< by accessor
    /// The new numbers of vertices; all are kUnused except while a shape is being made.
    std::vector<std::uint32_t> new_numbers_;
};

} // namespace echinus
