#include "mesh/local_frame.hpp"
#include "scene/vertex_choice.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <string>
#include <utility>

namespace echinus {

namespace {

/// How sentences call a mesh, and how it is made: a file's as it was read.
struct NamedMesh {
    std::string name;
    TriangleMesh mesh;

    NamedMesh(const SceneModel& model, const TriangleMesh& read, const std::string& key) {
        if (const auto* file = std::get_if<ModelFile>(&model)) {
            name = file->name;
            mesh = read;
            if (mesh.vertices.empty())
                throw Error(ErrorCode::InvalidOptions,
                            "the scene's " + key + " is the file " + name + ": read it and pass its mesh");
            return;
        }
        name = key;
        mesh = std::visit([](const auto& shape) { return shape_of(shape); }, model);
    }

  private:
    static TriangleMesh shape_of(const ModelFile&) { return {}; }
    static TriangleMesh shape_of(const auto& shape) { return make_mesh(shape); }
};

void require_same_faces(const NamedMesh& cloth, const NamedMesh& rest) {
    if (cloth.mesh.faces != rest.mesh.faces || cloth.mesh.vertices.size() != rest.mesh.vertices.size())
        throw Error(ErrorCode::InvalidMesh, "its rest mesh " + rest.name + " has other vertices or faces: " +
                                                std::to_string(rest.mesh.vertices.size()) + " and " +
                                                std::to_string(rest.mesh.faces.size()) + " where it has " +
                                                std::to_string(cloth.mesh.vertices.size()) + " and " +
                                                std::to_string(cloth.mesh.faces.size()) +
                                                "; both must name the same vertices in the same order");
}

Deformable make_cloth(const MeshCloth& cloth, const NamedMesh& start, const ClothMeshes& meshes) {
    require_no_origin(start.mesh.origin, "the cloth"); // before boxes choose vertices
    MeshClothOptions options{.pose = cloth.pose, .scale = cloth.scale, .bending = cloth.bending};
    if (cloth.rest_mesh) {
        NamedMesh rest(*cloth.rest_mesh, meshes.rest_mesh, "cloth.rest_mesh");
        require_same_faces(start, rest);
        options.rest_vertices = std::move(rest.mesh.vertices);
    }
    options.threads = meshes.threads;
    options.pins = chosen(cloth.pins, start.mesh.vertices, "cloth.pins");
    for (const std::uint32_t vertex : chosen(cloth.attachments, start.mesh.vertices, "cloth.attachments"))
        options.attachments.push_back({.particle = vertex});
    return make_cloth(start.mesh, options);
}

} // namespace

Deformable make_cloth(const Scene& scene, const ClothMeshes& meshes) {
    if (!scene.mesh_cloth) return make_cloth(scene.cloth);
    const NamedMesh start(scene.mesh_cloth->mesh, meshes.mesh, "cloth.mesh");
    try {
        return make_cloth(*scene.mesh_cloth, start, meshes);
    } catch (const Error& error) {
        throw Error(error.code(), start.name + ": " + error.what());
    }
}

} // namespace echinus
