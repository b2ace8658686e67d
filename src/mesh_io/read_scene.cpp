#include "files/mapped_file.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"
#include "mesh_io/scene_guards.hpp"

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <span>
#include <utility>

namespace echinus {

namespace {

namespace fs = std::filesystem;

/// Gives Assimp the checked bytes, and the buffers of a glTF file if they are regular files: a pipe or a
/// device named there could block it forever.
class SceneFiles : public Assimp::IOSystem {
  public:
    explicit SceneFiles(const MeshSource& source) : source_(source) {}

    bool Exists(const char* path) const override {
        std::error_code ignored;
        return path == source_.name || fs::is_regular_file(path, ignored);
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char*) override {
        if (!Exists(path)) return nullptr;
        if (path == source_.name) return stream_over(std::as_bytes(std::span(source_.bytes)));
        neighbours_.push_back(std::make_unique<MappedFile>(path));
        return stream_over(neighbours_.back()->bytes());
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

  private:
    /// Some of Assimp's readers delete a stream, some close it, and some forget it where a file is damaged:
    /// the stream owns nothing, so that little is lost then.
    static Assimp::IOStream* stream_over(std::span<const std::byte> bytes) {
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }

    const MeshSource& source_;
    std::vector<std::unique_ptr<MappedFile>> neighbours_;
};

using Transform = aiMatrix4x4t<double>;

Transform transform_of(const aiNode& node) {
    // 3DS files have no root; Assimp adds one that rotates the model.
    if (node.mName == aiString("<3DSDummyRoot>")) return {};
    return Transform(node.mTransformation);
}

Vec3f transformed(const Transform& m, const aiVector3D& p) {
    return Vec3f(Vec3d{m.a1 * p.x + m.a2 * p.y + m.a3 * p.z + m.a4,
                       m.b1 * p.x + m.b2 * p.y + m.b3 * p.z + m.b4,
                       m.c1 * p.x + m.c2 * p.y + m.c3 * p.z + m.c4});
}

void require_sound(const aiMesh& mesh, const aiFace& face, const MeshSource& source) {
    for (unsigned corner = 0; corner < face.mNumIndices; ++corner)
        if (face.mIndices[corner] >= mesh.mNumVertices)
            source.fail(ErrorCode::InvalidMesh,
                        "a face of the mesh " + in_quotes(mesh.mName.C_Str()) + " refers to vertex " +
                            std::to_string(face.mIndices[corner]) + ", but there are " +
                            std::to_string(mesh.mNumVertices) + " vertices, numbered from 0");
}

void add_mesh(const aiMesh& mesh, const Transform& to_world, const MeshSource& source,
              PolygonMesh& polygons) {
    const auto first_vertex = static_cast<std::uint32_t>(polygons.vertices.size());
    for (unsigned vertex = 0; vertex < mesh.mNumVertices; ++vertex) {
        polygons.vertices.push_back(transformed(to_world, mesh.mVertices[vertex]));
        if (!is_finite(polygons.vertices.back()))
            source.fail(ErrorCode::InvalidMesh, "vertex " + std::to_string(vertex) + " of the mesh " +
                                                    in_quotes(mesh.mName.C_Str()) + " is not finite");
    }
    // A mirroring transform turns a counter-clockwise face into a clockwise one (glTF 2.0, section 3.7.4).
    const bool mirrored = to_world.Determinant() < 0;
    for (unsigned face = 0; face < mesh.mNumFaces; ++face) {
        const aiFace& corners = mesh.mFaces[face];
        require_sound(mesh, corners, source);
        for (unsigned i = 0; i < corners.mNumIndices; ++i)
            polygons.corners.push_back(first_vertex +
                                       corners.mIndices[mirrored ? corners.mNumIndices - 1 - i : i]);
        polygons.corner_counts.push_back(corners.mNumIndices);
    }
}

/// All meshes in the order of the nodes, parents first. Not recursive, however deep the tree.
PolygonMesh join_meshes(const aiScene& scene, const MeshSource& source) {
    PolygonMesh polygons;
    std::vector<std::pair<const aiNode*, Transform>> pending{{scene.mRootNode, {}}};
    while (!pending.empty()) {
        const auto [node, parent_to_world] = pending.back();
        pending.pop_back();
        const Transform to_world = parent_to_world * transform_of(*node);
        for (unsigned mesh = 0; mesh < node->mNumMeshes; ++mesh)
            add_mesh(*scene.mMeshes[node->mMeshes[mesh]], to_world, source, polygons);
        for (unsigned child = node->mNumChildren; child-- > 0;)
            pending.emplace_back(node->mChildren[child], to_world);
    }
    return polygons;
}

void require_readable(const MeshSource& source) {
    const std::string ending = lower_case_ending(source.name);
    if (ending == ".gltf") require_readable_gltf(source);
    if (ending == ".glb") require_readable_glb(source);
    if (ending == ".3ds") require_readable_3ds(source);
}

const aiScene* import_scene(Assimp::Importer& importer, const MeshSource& source) {
    importer.SetIOHandler(new SceneFiles(source)); // the importer deletes it
    try {
        return importer.ReadFile(source.name, 0);
    } catch (const std::exception& error) {
        source.fail(ErrorCode::Damaged, "Assimp cannot read the file: " + printable(error.what()));
    }
}

} // namespace

PolygonMesh read_scene(const MeshSource& source) {
    require_readable(source);
    Assimp::Importer importer;
    const aiScene* scene = import_scene(importer, source);
    if (scene == nullptr)
        source.fail(ErrorCode::Damaged,
                    "Assimp cannot read the file: " + printable(importer.GetErrorString()));
    if (scene->mRootNode == nullptr) source.fail(ErrorCode::InvalidMesh, "the file has no nodes");
    return join_meshes(*scene, source);
}

} // namespace echinus
