#pragma once

#include <echinus/any_map.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>
#include <echinus/tetrahedra.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// The set-up of a simulation as JSON (docs/scenes.md has every key). Library echinus::scene (needs
/// nlohmann-json). It reads no meshes: the caller reads the model, with echinus::io or otherwise, and passes
/// its map, and likewise a cloth's mesh.
namespace echinus {

struct ModelFile {
    std::string name; ///< as written in the scene, for instance "horse.3ds"; see find_model()
};
struct TorusModel { ///< arguments of make_torus()
    double major_radius = 1, minor_radius = 0.4;
    std::uint32_t major_segments = 60, minor_segments = 24;
};
struct SphereModel { ///< arguments of make_sphere()
    double radius = 1;
    std::uint32_t meridian_count = 60, parallel_count = 30;
};
struct BoxModel { ///< arguments of make_box()
    Vec3d size{1, 1, 1};
    std::uint32_t segments = 1;
};
/// How the map is built, and thereby its kind. The default is an exact map.
using MapOptions = std::variant<ExactMapOptions, DistanceMapOptions>;

using SceneModel = std::variant<ModelFile, TorusModel, SphereModel, BoxModel>;

/// All vertices in a box along the mesh's axes, its sides included; in the mesh's own coordinates.
struct VertexBox {
    Vec3d from, to;
};
/// Vertices of a mesh, by their numbers or by where they are.
using VertexChoice = std::variant<std::vector<std::uint32_t>, VertexBox>;

/// Vertices, or particles of a sheet, that move with a collider.
struct SceneAttachment {
    VertexChoice vertices;
    std::uint32_t collider = 0; ///< its number
};

/// Vertices, or particles of a sheet, that are led along a path and let go: a Handle of them.
struct SceneHandle {
    VertexChoice vertices;
    std::vector<PoseKey> keyframes; ///< none: it stands still
    std::optional<double> release;  ///< seconds; none: it never lets go
};

/// Of all particles at the start that are not pinned, in the world.
struct SceneVelocity {
    Vec3d linear;  ///< units per second
    Vec3d angular; ///< radians per second, about their centre of mass
};

/// A cloth of any shape: what make_cloth() of a mesh takes, by name.
struct MeshCloth {
    SceneModel mesh;                     ///< where it starts
    std::optional<SceneModel> rest_mesh; ///< the same faces; if not given, it starts at rest
    RigidTransform pose;
    double scale = 1;
    VertexChoice pins;
};

/// A soft body: what make_soft_body() takes, by name.
struct SceneBody {
    /// A closed surface, which is filled with tetrahedra; or a file of tetrahedra, for read_tetrahedra().
    SceneModel mesh;
    double element = 0;      ///< about their size, units; 0 where the file has them
    SoftBodyOptions options; ///< without pins and attachments
    VertexChoice pins;
    std::vector<SceneAttachment> attachments;
    std::vector<SceneHandle> handles;
    SceneVelocity velocity;
    std::vector<std::uint32_t> ignores; ///< colliders that it passes through, by their numbers
};

/// The meshes of a scene's cloth and bodies that come from files, as the caller has read them; the others are
/// left empty.
struct ClothMeshes {
    TriangleMesh mesh, rest_mesh;
    std::vector<std::array<std::uint32_t, 2>> threads{}; ///< of `mesh`: see read_mesh_and_edges()
    std::vector<TetrahedralMesh> bodies{};               ///< by body; those of surfaces filled
};

/// How a model deforms: a file or a folder for read_vertex_cache().
struct CacheFile {
    std::string name; ///< as written in the scene; see find_model()
    double frames_per_second = 24;
    std::string animation = {}; ///< its name; empty: the only one of the file, or a file without any
};

/// A model in the world, and how it moves.
struct SceneCollider {
    SceneModel model;
    RepairOptions repair; ///< for the mesh, before the map is built
    RigidTransform pose;  ///< at the start
    Vec3d scale{1, 1, 1}; ///< along the axes of the mesh
    Vec3d linear_velocity;
    Vec3d angular_velocity;         ///< radians per second
    std::vector<PoseKey> keyframes; ///< in place of velocities, where there are any
    std::optional<CacheFile> cache; ///< the model deforms
    std::optional<double> mass;     ///< kg: it moves freely, from its velocities
};

/// The complete initial state of a simulation. A scene that was read is complete, with each number in its
/// range; the generators check whether a shape is possible.
struct Scene {
    std::vector<SceneCollider> colliders; ///< at least one
    MapOptions map;                       ///< of each collider
    bool has_cloth = true;
    ClothOptions cloth;
    std::optional<MeshCloth> mesh_cloth;            ///< in place of `cloth`
    std::vector<SceneAttachment> cloth_attachments; ///< by numbers, of a sheet: row * column_count + column
    std::vector<SceneHandle> cloth_handles;         ///< likewise
    SceneVelocity cloth_velocity;
    std::vector<std::uint32_t> cloth_ignores; ///< colliders that it passes through, by their numbers
    std::vector<SceneBody> bodies;            ///< soft bodies, after the cloth
    std::vector<Teleport> teleports;
    SimulationOptions simulation;
    std::uint32_t frame_limit = 3000; ///< the simulation ends here at the latest
    /// Sentences about keys of earlier versions, or of another solver, that have no effect, and about what to
    /// write in their place. For users to see.
    std::vector<std::string> warnings;
};

/// @throws Error Unreadable, or InvalidScene with a sentence that begins with the path and names the key at
/// fault: unknown (then with the most similar one that exists), missing, given twice, of the wrong type or
/// out of range
Scene read_scene(const std::filesystem::path& path);

/// The same from text; `name` replaces the path in errors.
Scene parse_scene(std::string_view json, const std::string& name);

/// Only the object under a scene's `map`; {} gives the defaults.
/// @throws Error InvalidScene as above
MapOptions parse_map_options(std::string_view json, const std::string& name);

/// The path of a model's file, or of a cache's file or folder, in the first of the folders that has it. An
/// absolute name needs no folder.
/// @throws Error Unreadable, naming the folders that were searched
std::filesystem::path find_model(const ModelFile& model, std::span<const std::filesystem::path> folders);
std::filesystem::path find_cache(const CacheFile& cache, std::span<const std::filesystem::path> folders);

/// The mesh of a generated model.
/// @throws Error InvalidOptions as the generators do
TriangleMesh make_mesh(const TorusModel& model);
TriangleMesh make_mesh(const SphereModel& model);
TriangleMesh make_mesh(const BoxModel& model);

/// A map of the options' kind.
/// @param thread_count  0: all cores; replaces the one in the options
/// @throws Error as the map's build() does
AnyMap build_map(const TriangleMesh& mesh, const MapOptions& options, unsigned thread_count = 0);

/// The collider as it starts, with a map of its model.
Collider make_collider(const SceneCollider& collider, const ColliderMap& map);

/// The scene's map of a model, by build_map(); beside a distance map, where surfaces collide, with the exact
/// map of the same mesh.
/// @throws Error as build_map()
ColliderMap make_collider_map(const Scene& scene, const TriangleMesh& mesh, unsigned thread_count = 0);

/// The tetrahedra that fill a closed surface, with the longest edge inside that the body asks for.
/// @throws Error InvalidMesh for an open surface, InvalidOptions; as tetrahedralize()
TetrahedralMesh fill_body(const SceneBody& body, const TriangleMesh& surface);

/// The scene's cloth where it starts, at rest.
/// @param meshes  of a cloth that is made of files
/// @throws Error as the two make_cloth() do; for a mesh the sentence begins with its name. InvalidOptions
/// where a mesh from a file is not given, or there is no vertex in a box; InvalidMesh where the rest mesh has
/// other faces
Deformable make_cloth(const Scene& scene, const ClothMeshes& meshes = {});

/// The tetrahedra that fill a generated shape: a box exactly, by cuboids of about this size; others as
/// tetrahedralize() does.
/// @throws Error InvalidOptions as the generators and tetrahedralize() do
TetrahedralMesh make_solid(const SceneModel& shape, double element);

/// The scene's cloth and its bodies, which follow it, as one deformable with their velocities.
/// @throws Error as make_cloth() and make_soft_body() do; for a body the sentence begins with "bodies[0]" or
/// so. InvalidOptions where a body's file is not given, or there is no vertex in a box
Deformable make_deformable(const Scene& scene, const ClothMeshes& meshes = {});

/// The scene's cloth, bodies and colliders, ready to step.
/// @param maps  of the colliders' models, in their order; of one with a cache, with the vertices that
/// vertices_at()
///              gives for 0 s, or the first frame would lead it there
/// @param caches  [collider_count] of the colliders that have one in the scene, as the caller has read them;
/// may
///                be left out where none has
/// @throws Error InvalidOptions, also when there are more or fewer maps than colliders, or a cache is
/// missing, and as make_deformable()
Simulation make_simulation(const Scene& scene, std::span<const ColliderMap> maps,
                           const ClothMeshes& meshes = {}, std::span<const VertexCache> caches = {});
/// The same of a scene with one collider.
Simulation make_simulation(const Scene& scene, const ColliderMap& map, const ClothMeshes& meshes = {});

} // namespace echinus

ECHINUS_EXPORT_END
