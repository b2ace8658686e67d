#include "mesh/local_frame.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// The indices of the vertices. @param key  of the choice, for sentences
/// @throws Error InvalidOptions if a box contains none
std::vector<std::uint32_t> chosen(const VertexChoice& choice, const std::vector<Vec3f>& vertices,
                                  const std::string& key) {
    if (const auto* numbers = std::get_if<std::vector<std::uint32_t>>(&choice)) return *numbers;
    const auto& [from, to] = std::get<VertexBox>(choice);
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        const Vec3d v(vertices[i]);
        if (v.x >= from.x && v.x <= to.x && v.y >= from.y && v.y <= to.y && v.z >= from.z && v.z <= to.z)
            found.push_back(i);
    }
    if (found.empty()) throw Error(ErrorCode::InvalidOptions, "none of its vertices is in the box of " + key);
    return found;
}

/// The name of a mesh in sentences, and the mesh; that of a file as it was read.
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

std::vector<Attachment> attached(const std::vector<SceneAttachment>& attachments,
                                 const std::vector<Vec3f>& vertices, const std::string& key) {
    std::vector<Attachment> all;
    for (const SceneAttachment& some : attachments)
        for (const std::uint32_t vertex : chosen(some.vertices, vertices, key))
            all.push_back({vertex, some.collider});
    return all;
}

/// @param held  the deformable to which they belong
void add_handles(const std::vector<SceneHandle>& handles, const std::vector<Vec3f>& vertices,
                 const std::string& key, Deformable& held) {
    for (std::size_t i = 0; i < handles.size(); ++i) {
        const auto& [choice, keyframes, release] = handles[i];
        Handle& handle = held.handles.emplace_back();
        handle.particles = chosen(choice, vertices, key + "[" + std::to_string(i) + "]");
        handle.keys = keyframes;
        if (release) handle.release_time = *release;
    }
}

/// A sheet's particles are not the vertices of a mesh; they are chosen by their numbers.
Deformable make_sheet(const Scene& scene) {
    Deformable sheet = make_cloth(scene.cloth);
    add_handles(scene.cloth_handles, {}, "cloth.handles", sheet);
    sheet.attachments = attached(scene.cloth_attachments, {}, "cloth.attachments");
    for (const Attachment& attachment : sheet.attachments) sheet.inverse_masses[attachment.particle] = 0;
    return sheet;
}

Deformable make_cloth(const MeshCloth& cloth, const Scene& scene, const NamedMesh& start,
                      const ClothMeshes& meshes) {
    require_no_origin(start.mesh.origin, "the cloth"); // before boxes choose vertices
    MeshClothOptions options{.pose = cloth.pose, .scale = cloth.scale};
    if (cloth.rest_mesh) {
        NamedMesh rest(*cloth.rest_mesh, meshes.rest_mesh, "cloth.rest_mesh");
        require_same_faces(start, rest);
        options.rest_vertices = std::move(rest.mesh.vertices);
    }
    options.threads = meshes.threads;
    options.pins = chosen(cloth.pins, start.mesh.vertices, "cloth.pins");
    options.attachments = attached(scene.cloth_attachments, start.mesh.vertices, "cloth.attachments");
    Deformable made = make_cloth(start.mesh, options);
    add_handles(scene.cloth_handles, start.mesh.vertices, "cloth.handles", made);
    return made;
}

} // namespace

Deformable make_cloth(const Scene& scene, const ClothMeshes& meshes) {
    if (!scene.mesh_cloth) return make_sheet(scene);
    const NamedMesh start(scene.mesh_cloth->mesh, meshes.mesh, "cloth.mesh");
    try {
        return make_cloth(*scene.mesh_cloth, scene, start, meshes);
    } catch (const Error& error) {
        throw Error(error.code(), start.name + ": " + error.what());
    }
}

namespace {

TetrahedralMesh fill(const TriangleMesh& surface, double element) {
    const ExactMap map = ExactMap::build(surface);
    return tetrahedralize(map, {.size = element}).mesh;
}

/// Fills the box with cuboids of about this size.
TetrahedralMesh solid_box(const BoxModel& box, double element) {
    const auto segments = [&](double side) {
        return static_cast<std::uint32_t>(std::clamp(std::round(side / element), 1.0, 1e6));
    };
    return make_solid_box(box.size, {segments(box.size.x), segments(box.size.y), segments(box.size.z)});
}

struct Filling {
    double element;

    TetrahedralMesh operator()(const ModelFile& file) const {
        throw Error(ErrorCode::InvalidOptions,
                    "its mesh is the file " + file.name + ": read it and pass its tetrahedra");
    }
    TetrahedralMesh operator()(const BoxModel& box) const { return solid_box(box, element); }
    TetrahedralMesh operator()(const auto& shape) const { return fill(make_mesh(shape), element); }
};

/// The centre of mass of the particles that are not pinned.
Vec3d centre_of_mass(const Deformable& deformable) {
    Vec3d sum;
    double mass = 0;
    for (std::size_t i = 0; i < deformable.particle_count(); ++i) {
        if (deformable.inverse_masses[i] == 0) continue;
        const double of_particle = 1 / double{deformable.inverse_masses[i]};
        sum += Vec3d(deformable.positions[i]) * of_particle;
        mass += of_particle;
    }
    return mass > 0 ? sum * (1 / mass) : Vec3d{};
}

void set_velocity(const SceneVelocity& velocity, Deformable& deformable) {
    const Vec3d centre = centre_of_mass(deformable);
    deformable.velocities.resize(deformable.particle_count());
    for (std::size_t i = 0; i < deformable.particle_count(); ++i) {
        if (deformable.inverse_masses[i] == 0) continue;
        const Vec3d arm = Vec3d(deformable.positions[i]) - centre;
        deformable.velocities[i] = Vec3f(velocity.linear + cross(velocity.angular, arm));
    }
}

Deformable cloth_of(const Scene& scene, const ClothMeshes& meshes) {
    Deformable cloth = make_cloth(scene, meshes);
    set_velocity(scene.cloth_velocity, cloth);
    return cloth;
}

Deformable make_body(const SceneBody& body, const TetrahedralMesh* read) {
    const TetrahedralMesh mesh =
        read != nullptr && !read->tetrahedra.empty() ? *read : make_solid(body.mesh, body.element);
    require_no_origin(mesh.origin, "the soft body"); // before boxes choose vertices
    SoftBodyOptions options = body.options;
    options.pins = chosen(body.pins, mesh.vertices, "pins");
    options.attachments = attached(body.attachments, mesh.vertices, "attachments");
    Deformable made = make_soft_body(mesh, options);
    add_handles(body.handles, mesh.vertices, "handles", made);
    set_velocity(body.velocity, made);
    return made;
}

Deformable passing_through(const std::vector<std::uint32_t>& colliders, Deformable deformable) {
    for (const std::uint32_t collider : colliders)
        deformable = echinus::passing_through(collider, std::move(deformable));
    return deformable;
}

} // namespace

TetrahedralMesh fill_body(const SceneBody& body, const TriangleMesh& surface) {
    if (!inspect(surface).closed)
        throw Error(ErrorCode::InvalidMesh,
                    "the surface of the body is not closed, so what it encloses would be a guess; close it "
                    "with `echinus mesh repair`, or name the file of tetrahedra that `echinus tetrahedralize "
                    "--allow-open` makes of it");
    return fill(surface, body.element);
}

TetrahedralMesh make_solid(const SceneModel& shape, double element) {
    return std::visit(Filling{element}, shape);
}

Deformable make_deformable(const Scene& scene, const ClothMeshes& meshes) {
    std::vector<Deformable> parts;
    if (scene.has_cloth) parts.push_back(passing_through(scene.cloth_ignores, cloth_of(scene, meshes)));
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        try {
            const TetrahedralMesh* read = i < meshes.bodies.size() ? &meshes.bodies[i] : nullptr;
            parts.push_back(passing_through(scene.bodies[i].ignores, make_body(scene.bodies[i], read)));
        } catch (const Error& error) {
            throw Error(error.code(), "bodies[" + std::to_string(i) + "]: " + error.what());
        }
    }
    return parts.size() == 1 ? std::move(parts.front()) : combine(parts);
}

} // namespace echinus
