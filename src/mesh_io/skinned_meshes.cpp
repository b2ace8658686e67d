#include "mesh_io/skinned_meshes.hpp"

#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace echinus {

namespace {

Vec3d vector_of(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

/// The vertices of a mesh between its morph targets: v + sum of weight (target - v).
std::vector<Vec3d> morphed(const aiMesh& mesh, const std::vector<double>& weights) {
    std::vector<Vec3d> vertices(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) vertices[i] = vector_of(mesh.mVertices[i]);
    for (std::size_t target = 0; target < std::min<std::size_t>(weights.size(), mesh.mNumAnimMeshes);
         ++target) {
        const aiAnimMesh& shape = *mesh.mAnimMeshes[target];
        if (!shape.HasPositions() || shape.mNumVertices != mesh.mNumVertices) continue;
        for (unsigned i = 0; i < mesh.mNumVertices; ++i)
            vertices[i] += (vector_of(shape.mVertices[i]) - vector_of(mesh.mVertices[i])) * weights[target];
    }
    return vertices;
}

Transform blend(const Transform& sum, const Transform& transform, double weight) {
    Transform result = sum;
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned column = 0; column < 4; ++column)
            result[row][column] += weight * transform[row][column];
    return result;
}

std::map<std::string, std::size_t> nodes_by_name(const SceneFile& file) {
    std::map<std::string, std::size_t> nodes;
    for (std::size_t i = 0; i < file.nodes().size(); ++i)
        nodes.emplace(file.nodes()[i].node->mName.C_Str(), i); // of equal names the first
    return nodes;
}

} // namespace

SkinnedMeshes::SkinnedMeshes(const SceneFile& file, const NodeAnimation& animation, const MeshSource& source)
    : file_(file), animation_(animation) {
    for (const MeshInstance& instance : file.instances())
        skins_.push_back(make_skin(file, *instance.mesh, source));
}

SkinnedMeshes::Skin SkinnedMeshes::make_skin(const SceneFile& file, const aiMesh& mesh,
                                             const MeshSource& source) {
    Skin skin;
    if (mesh.mNumBones == 0) return skin;
    const std::string name = in_quotes(mesh.mName.C_Str());
    const std::map<std::string, std::size_t> nodes = nodes_by_name(file);
    std::vector<std::vector<Influence>> of_vertices(mesh.mNumVertices);
    for (std::uint32_t i = 0; i < mesh.mNumBones; ++i) {
        const aiBone& bone = *mesh.mBones[i];
        const auto node = nodes.find(bone.mName.C_Str());
        if (node == nodes.end())
            source.fail(ErrorCode::InvalidMesh,
                        "the bone " + in_quotes(bone.mName.C_Str()) + " of the mesh " + name +
                            " is no node of the file; give each bone a name of its own");
        skin.bones.push_back({node->second, Transform(bone.mOffsetMatrix)});
        for (unsigned k = 0; k < bone.mNumWeights; ++k) {
            const aiVertexWeight& weight = bone.mWeights[k];
            if (weight.mVertexId >= mesh.mNumVertices || !std::isfinite(weight.mWeight))
                source.fail(ErrorCode::InvalidMesh,
                            "the bone " + in_quotes(bone.mName.C_Str()) + " of the mesh " + name +
                                " has a weight that is not finite, or on a vertex that is not there");
            if (weight.mWeight > 0) of_vertices[weight.mVertexId].push_back({i, double{weight.mWeight}});
        }
    }
    for (std::size_t vertex = 0; vertex < of_vertices.size(); ++vertex) {
        double sum = 0;
        for (const Influence& influence : of_vertices[vertex]) sum += influence.weight;
        if (!(sum > 0))
            source.fail(ErrorCode::InvalidMesh, "vertex " + std::to_string(vertex) + " of the mesh " + name +
                                                    " has no bone, though others have; give it weights");
        skin.first_influences.push_back(static_cast<std::uint32_t>(skin.influences.size()));
        for (const Influence& influence : of_vertices[vertex])
            skin.influences.push_back({influence.bone, influence.weight / sum});
    }
    skin.first_influences.push_back(static_cast<std::uint32_t>(skin.influences.size()));
    return skin;
}

void SkinnedMeshes::add_instance(std::size_t instance, const std::vector<Transform>& to_world, double seconds,
                                 std::vector<Vec3f>& vertices) const {
    const auto& [mesh, node, first_vertex] = file_.instances()[instance];
    const Skin& skin = skins_[instance];
    std::vector<Transform> bones;
    for (const Bone& bone : skin.bones) bones.push_back(to_world[bone.node] * bone.offset);
    const std::vector<Vec3d> shape = morphed(*mesh, animation_.morph_weights_at(node, seconds));
    const Transform nothing(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1);
    for (std::size_t i = 0; i < shape.size(); ++i) {
        if (bones.empty()) {
            vertices.push_back(transformed(to_world[node], shape[i]));
            continue;
        }
        Transform sum = nothing;
        for (std::uint32_t k = skin.first_influences[i]; k < skin.first_influences[i + 1]; ++k)
            sum = blend(sum, bones[skin.influences[k].bone], skin.influences[k].weight);
        vertices.push_back(transformed(sum, shape[i]));
    }
}

std::vector<Vec3f> SkinnedMeshes::vertices_at(double seconds) const {
    const std::vector<Transform> to_world = animation_.to_world_at(seconds);
    std::vector<Vec3f> vertices;
    for (std::size_t i = 0; i < skins_.size(); ++i) add_instance(i, to_world, seconds, vertices);
    return vertices;
}

} // namespace echinus
