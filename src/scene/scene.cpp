#include <echinus/error.hpp>
#include <echinus/scene.hpp>

#include <utility>

namespace echinus {

namespace fs = std::filesystem;

fs::path find_model(const ModelFile& model, std::span<const fs::path> folders) {
    std::string tried;
    for (const fs::path& folder : folders) {
        std::error_code ignored;
        const fs::path path = folder / model.name; // an absolute name replaces the folder
        if (fs::is_regular_file(path, ignored)) return path;
        tried += (tried.empty() ? "" : ", ") + folder.string();
    }
    throw Error(ErrorCode::Unreadable, "the mesh " + model.name + " is in none of the folders " + tried +
                                           "; scripts/setup puts the models of the scenes into models/");
}

TriangleMesh make_mesh(const TorusModel& model) {
    return make_torus(model.major_radius, model.minor_radius, model.major_segments, model.minor_segments);
}

TriangleMesh make_mesh(const SphereModel& model) {
    return make_sphere(model.radius, model.meridian_count, model.parallel_count);
}

TriangleMesh make_mesh(const BoxModel& model) {
    return make_box(model.size, model.segments);
}

AnyMap build_map(const TriangleMesh& mesh, const MapOptions& options, unsigned thread_count) {
    if (const auto* exact = std::get_if<ExactMapOptions>(&options)) {
        ExactMapOptions with_threads = *exact;
        with_threads.thread_count = thread_count;
        return ExactMap::build(mesh, with_threads);
    }
    DistanceMapOptions with_threads = std::get<DistanceMapOptions>(options);
    with_threads.thread_count = thread_count;
    return DistanceMap::build(mesh, with_threads);
}

namespace {

/// How sentences call a model.
struct NameOfModel {
    std::string operator()(const ModelFile& file) const { return fs::path(file.name).filename().string(); }
    std::string operator()(const TorusModel&) const { return "the torus"; }
    std::string operator()(const SphereModel&) const { return "the sphere"; }
    std::string operator()(const BoxModel&) const { return "the box"; }
};

} // namespace

Collider make_collider(const Scene& scene, const ColliderMap& map) {
    return {.map = map,
            .pose = scene.pose,
            .scale = scene.scale,
            .linear_velocity = scene.linear_velocity,
            .angular_velocity = scene.angular_velocity,
            .name = std::visit(NameOfModel{}, scene.model)};
}

Simulation make_simulation(const Scene& scene, const ColliderMap& map, const ClothMeshes& meshes) {
    Deformable cloth = make_cloth(scene, meshes);
    const Vec3d way = scene.cloth_velocity * (scene.simulation.time_step / scene.simulation.substep_count);
    for (std::size_t i = 0; i < cloth.particle_count(); ++i)
        if (cloth.inverse_masses[i] != 0)
            cloth.previous_positions[i] = Vec3f(Vec3d(cloth.positions[i]) - way);
    return Simulation(std::move(cloth), {make_collider(scene, map)}, scene.simulation);
}

} // namespace echinus
