#include "mesh/local_frame.hpp"
#include "scene/vertex_choice.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace echinus {

namespace {

TetrahedralMesh fill(const TriangleMesh& surface, double element) {
    const ExactMap map = ExactMap::build(surface);
    return tetrahedralize(map, {.size = element}).mesh;
}

/// Cuboids of about this size.
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

void set_velocity(const Vec3d& velocity, const SimulationOptions& options, Deformable& deformable) {
    const Vec3d way = velocity * (options.time_step / options.substep_count);
    for (std::size_t i = 0; i < deformable.particle_count(); ++i)
        if (deformable.inverse_masses[i] != 0)
            deformable.previous_positions[i] = Vec3f(Vec3d(deformable.positions[i]) - way);
}

double area_of(const Deformable& deformable) {
    const auto at = [&](std::uint32_t i) { return Vec3d(deformable.positions[i]); };
    double area = 0;
    for (const auto& [a, b, c] : deformable.faces) area += length(cross(at(b) - at(a), at(c) - at(a))) / 2;
    return area;
}

Deformable cloth_of(const Scene& scene, const ClothMeshes& meshes) {
    Deformable cloth = make_cloth(scene, meshes);
    if (scene.cloth_density) {
        const double factor =
            *scene.cloth_density * area_of(cloth) / static_cast<double>(cloth.particle_count());
        cloth = with_masses_times(factor, std::move(cloth));
    }
    set_velocity(scene.cloth_velocity, scene.simulation, cloth);
    return cloth;
}

Deformable make_body(const SceneBody& body, const TetrahedralMesh* read,
                     const SimulationOptions& simulation) {
    const TetrahedralMesh mesh =
        read != nullptr && !read->tetrahedra.empty() ? *read : make_solid(body.mesh, body.element);
    require_no_origin(mesh.origin, "the soft body"); // before boxes choose vertices
    SoftBodyOptions options = body.options;
    options.pins = chosen(body.pins, mesh.vertices, "pins");
    for (const std::uint32_t vertex : chosen(body.attachments, mesh.vertices, "attachments"))
        options.attachments.push_back({.particle = vertex});
    Deformable made = make_soft_body(mesh, options);
    set_velocity(body.velocity, simulation, made);
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
            parts.push_back(
                passing_through(scene.bodies[i].ignores, make_body(scene.bodies[i], read, scene.simulation)));
        } catch (const Error& error) {
            throw Error(error.code(), "bodies[" + std::to_string(i) + "]: " + error.what());
        }
    }
    return parts.size() == 1 ? std::move(parts.front()) : combine(parts);
}

} // namespace echinus
