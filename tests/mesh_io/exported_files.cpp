#include "mesh_io/exported_files.hpp"

#ifdef ECHINUS_WITH_ASSIMP
#include <assimp/Exporter.hpp>
#include <assimp/scene.h>
#endif

#include <stdexcept>

namespace echinus::test {

#ifdef ECHINUS_WITH_ASSIMP

namespace {

aiMesh* make_mesh(const TriangleMesh& mesh) {
    auto* result = new aiMesh; // the scene deletes it
    result->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    result->mNumVertices = static_cast<unsigned>(mesh.vertices.size());
    result->mVertices = new aiVector3D[mesh.vertices.size()];
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        result->mVertices[i] = {mesh.vertices[i].x, mesh.vertices[i].y, mesh.vertices[i].z};
    result->mNumFaces = static_cast<unsigned>(mesh.faces.size());
    result->mFaces = new aiFace[mesh.faces.size()];
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        result->mFaces[i].mNumIndices = 3;
        result->mFaces[i].mIndices = new unsigned[3]{mesh.faces[i][0], mesh.faces[i][1], mesh.faces[i][2]};
    }
    return result;
}

} // namespace

bool can_export() {
    return true;
}

void export_with_assimp(const std::filesystem::path& path, const TriangleMesh& mesh, const ExportedKind& kind,
                        const Placement& placement) {
    aiScene scene;
    scene.mNumMeshes = 1;
    scene.mMeshes = new aiMesh* [1] { make_mesh(mesh) };
    scene.mNumMaterials = 1;
    scene.mMaterials = new aiMaterial* [1] { new aiMaterial };
    scene.mRootNode = new aiNode("root");
    auto* node = new aiNode("model");
    scene.mRootNode->addChildren(1, &node);
    node->mNumMeshes = 1;
    node->mMeshes = new unsigned[1]{0};
    const Placement& p = placement;
    node->mTransformation =
        aiMatrix4x4(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11], 0, 0, 0, 1);
    Assimp::Exporter exporter;
    if (exporter.Export(&scene, kind.exporter, path.string()) != aiReturn_SUCCESS)
        throw std::runtime_error(exporter.GetErrorString());
}

#else

bool can_export() {
    return false;
}

void export_with_assimp(const std::filesystem::path&, const TriangleMesh&, const ExportedKind&,
                        const Placement&) {
    throw std::logic_error(kCannotExport);
}

#endif

} // namespace echinus::test
