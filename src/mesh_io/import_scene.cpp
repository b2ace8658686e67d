#include "mesh_io/import_scene.hpp"

#include "files/read_file.hpp"
#include "mesh_io/scene_guards.hpp"

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <span>

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
        neighbours_.push_back(read_file(path));
        return stream_over(neighbours_.back());
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

  private:
    /// Some of Assimp's readers delete a stream, some close it, and some forget it where a file is damaged:
    /// the stream owns nothing, so that little is lost then.
    static Assimp::IOStream* stream_over(std::span<const std::byte> bytes) {
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }

    const MeshSource& source_;
    std::vector<std::vector<std::byte>> neighbours_;
};

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
        const aiVector3D& p = mesh.mVertices[vertex];
        polygons.vertices.push_back(transformed(to_world, {p.x, p.y, p.z}));
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

/// Parents first, depth first. Not recursive, however deep the tree.
std::vector<SceneNode> nodes_of(const aiScene& scene) {
    std::vector<SceneNode> nodes;
    std::vector<SceneNode> pending{{scene.mRootNode, 0}};
    while (!pending.empty()) {
        const std::size_t number = nodes.size();
        nodes.push_back(pending.back());
        pending.pop_back();
        const aiNode& node = *nodes.back().node;
        for (unsigned child = node.mNumChildren; child-- > 0;)
            pending.push_back({node.mChildren[child], number});
    }
    return nodes;
}

std::vector<MeshInstance> instances_of(const aiScene& scene, const std::vector<SceneNode>& nodes) {
    std::vector<MeshInstance> instances;
    std::size_t vertex_count = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (unsigned mesh = 0; mesh < nodes[i].node->mNumMeshes; ++mesh) {
            instances.push_back({scene.mMeshes[nodes[i].node->mMeshes[mesh]], i, vertex_count});
            vertex_count += instances.back().mesh->mNumVertices;
        }
    return instances;
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

Vec3f transformed(const Transform& m, const Vec3d& p) {
    return Vec3f(Vec3d{m.a1 * p.x + m.a2 * p.y + m.a3 * p.z + m.a4,
                       m.b1 * p.x + m.b2 * p.y + m.b3 * p.z + m.b4,
                       m.c1 * p.x + m.c2 * p.y + m.c3 * p.z + m.c4});
}

SceneFile::SceneFile(const MeshSource& source)
    : source_(source), importer_(std::make_unique<Assimp::Importer>()) {
    require_readable(source);
    scene_ = import_scene(*importer_, source);
    if (scene_ == nullptr)
        source.fail(ErrorCode::Damaged,
                    "Assimp cannot read the file: " + printable(importer_->GetErrorString()));
    if (scene_->mRootNode == nullptr) source.fail(ErrorCode::InvalidMesh, "the file has no nodes");
    nodes_ = nodes_of(*scene_);
    instances_ = instances_of(*scene_, nodes_);
}

SceneFile::~SceneFile() = default;

Transform SceneFile::rest_transform(const aiNode& node) {
    // 3DS files have no root; Assimp adds one that rotates the model.
    if (node.mName == aiString("<3DSDummyRoot>")) return {};
    return Transform(node.mTransformation);
}

PolygonMesh SceneFile::join() const {
    std::vector<Transform> to_world;
    for (const SceneNode& node : nodes_)
        to_world.push_back((to_world.empty() ? Transform() : to_world[node.parent]) *
                           rest_transform(*node.node));
    PolygonMesh polygons;
    for (const MeshInstance& instance : instances_)
        add_mesh(*instance.mesh, to_world[instance.node], source_, polygons);
    return polygons;
}

} // namespace echinus
