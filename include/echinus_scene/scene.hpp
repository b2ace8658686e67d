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

/// Scenes: the set-up of a simulation as JSON (docs/scenes.md documents every key). The declarations belong
/// to the library echinus::scene, which needs nlohmann-json. The library reads no meshes: the caller reads
/// the models and the mesh of a cloth, with echinus::io or otherwise, and passes the models' maps and that
/// mesh.
namespace echinus {

struct ModelFile {
    std::string name; ///< the file's name as written in the scene, for instance "horse.3ds"; see find_model()
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
/// The options of the map, which determine its kind. The default is an exact map.
using MapOptions = std::variant<ExactMapOptions, DistanceMapOptions>;

using SceneModel = std::variant<ModelFile, TorusModel, SphereModel, BoxModel>;

/// All vertices in an axis-aligned box, including its sides, in the mesh's own coordinates.
struct VertexBox {
    Vec3d from, to;
};
/// Vertices of a mesh, by index or by position.
using VertexChoice = std::variant<std::vector<std::uint32_t>, VertexBox>;

/// Vertices, or particles of a sheet, that move with a collider.
struct SceneAttachment {
    VertexChoice vertices;
    std::uint32_t collider = 0; ///< index in Scene::colliders
};

/// The arguments of a Handle: vertices, or particles of a sheet, that are moved along a path and released.
struct SceneHandle {
    VertexChoice vertices;
    std::vector<PoseKey> keyframes; ///< the path; if empty, the handle does not move
    std::optional<double> release;  ///< time in seconds; without it the particles are not released
};

/// The initial velocity of all particles that are not pinned, in the world.
struct SceneVelocity {
    Vec3d linear;  ///< velocity of the centre of mass, units per second
    Vec3d angular; ///< rotation about the centre of mass of these particles, radians per second
};

/// A cloth of any shape: the arguments of make_cloth() for a mesh, with the name of a file or the sizes of a
/// shape in place of the mesh.
struct MeshCloth {
    SceneModel mesh;                     ///< the initial shape
    std::optional<SceneModel> rest_mesh; ///< the rest shape, with the same faces; by default `mesh`
    RigidTransform pose;
    double scale = 1;
    VertexChoice pins;
};

/// A soft body: the arguments of make_soft_body(), with the name of a file or the sizes of a shape in place
/// of the mesh.
struct SceneBody {
    /// A closed surface, which is filled with tetrahedra; or a file of tetrahedra, for read_tetrahedra().
    SceneModel mesh;
    double element = 0;      ///< approximate size of tetrahedra, units; 0 for a file of tetrahedra
    SoftBodyOptions options; ///< their pins and attachments are ignored
    VertexChoice pins;
    std::vector<SceneAttachment> attachments;
    std::vector<SceneHandle> handles;
    SceneVelocity velocity;
    std::vector<std::uint32_t> ignores; ///< indices of the colliders that the body passes through
};

/// The meshes of a scene's cloth and bodies that come from files, as read by the caller. The meshes of
/// generated shapes stay empty.
struct ClothMeshes {
    TriangleMesh mesh, rest_mesh;
    std::vector<std::array<std::uint32_t, 2>> threads{}; ///< the threads of `mesh`: see read_mesh_and_edges()
    std::vector<TetrahedralMesh> bodies{}; ///< one for each body; the caller has filled surfaces
};

/// The vertex cache of a deforming model: a file or a folder for read_vertex_cache().
struct CacheFile {
    std::string name; ///< the name as written in the scene; see find_model()
    double frames_per_second = 24;
    std::string animation = {}; ///< the animation's name; empty if the file has one animation or none
};

/// A model in the world, and its motion.
struct SceneCollider {
    SceneModel model;
    RepairOptions repair; ///< repairs of the mesh before the map is built
    RigidTransform pose;  ///< the initial pose
    Vec3d scale{1, 1, 1}; ///< factors along the axes of the mesh
    Vec3d linear_velocity;
    Vec3d angular_velocity;         ///< radians per second
    std::vector<PoseKey> keyframes; ///< the motion, if not empty, in place of velocities
    std::optional<CacheFile> cache; ///< the moving vertices of a deforming model
    std::optional<double> mass;     ///< kg; with a mass the model moves freely from its velocities
};

/// The complete initial state of a simulation. In a scene that was read, every number is in its range; the
/// generators check whether a shape is possible.
struct Scene {
    std::vector<SceneCollider> colliders; ///< at least one
    MapOptions map;                       ///< the options of every collider's map
    bool has_cloth = true;
    ClothOptions cloth;
    std::optional<MeshCloth> mesh_cloth;            ///< if set, the cloth's shape in place of `cloth`
    std::vector<SceneAttachment> cloth_attachments; ///< a sheet's particles: row * column_count + column
    std::vector<SceneHandle> cloth_handles;         ///< particles as in cloth_attachments
    SceneVelocity cloth_velocity;
    std::vector<std::uint32_t> cloth_ignores; ///< indices of the colliders that the cloth passes through
    std::vector<SceneBody> bodies;            ///< soft bodies, after the cloth
    std::vector<Teleport> teleports;
    SimulationOptions simulation;
    std::uint32_t frame_limit = 3000; ///< the simulation ends after at most this number of frames
    /// Warnings for the user about keys of earlier versions, or of another solver, that have no effect, and
    /// about their replacements.
    std::vector<std::string> warnings;
};

/// Reads a scene.
/// @throws Error Unreadable; InvalidScene if the text is not JSON, or a key is unknown, missing, given twice,
/// of the wrong type or out of range. The message begins with the path and names the key; for an unknown key
/// it also names the most similar known one
Scene read_scene(const std::filesystem::path& path);

/// Reads a scene from text; `name` replaces the path in error messages.
Scene parse_scene(std::string_view json, const std::string& name);

/// Reads map options from the JSON object that a scene has under `map`; {} gives the defaults.
/// @throws Error InvalidScene as read_scene() does
MapOptions parse_map_options(std::string_view json, const std::string& name);

/// The path of a model's file, or of a cache's file or folder, in the first of the folders that contains it.
/// An absolute name needs no folder.
/// @throws Error Unreadable, naming the folders that were searched
std::filesystem::path find_model(const ModelFile& model, std::span<const std::filesystem::path> folders);
std::filesystem::path find_cache(const CacheFile& cache, std::span<const std::filesystem::path> folders);

/// The mesh of a generated model.
/// @throws Error InvalidOptions as the generators do
TriangleMesh make_mesh(const TorusModel& model);
TriangleMesh make_mesh(const SphereModel& model);
TriangleMesh make_mesh(const BoxModel& model);

/// Builds a map of the kind that the options determine.
/// @param thread_count  replaces the number in the options; 0: all cores
/// @throws Error as the map's build() does
AnyMap build_map(const TriangleMesh& mesh, const MapOptions& options, unsigned thread_count = 0);

/// The collider in its initial pose, with a map of its model.
Collider make_collider(const SceneCollider& collider, const ColliderMap& map);

/// Builds the scene's map of a model with build_map(). If the map is a distance map and surfaces collide, the
/// exact map of the same mesh is added.
/// @throws Error as build_map()
ColliderMap make_collider_map(const Scene& scene, const TriangleMesh& mesh, unsigned thread_count = 0);

/// Fills a closed surface with tetrahedra of the body's element size.
/// @throws Error InvalidMesh for an open surface; and as tetrahedralize() does
TetrahedralMesh fill_body(const SceneBody& body, const TriangleMesh& surface);

/// Makes the scene's cloth in its initial pose, at rest.
/// @param meshes  the meshes of a cloth from files
/// @throws Error as make_cloth() does for a sheet or a mesh; for a mesh the message begins with the mesh's
/// name. InvalidOptions if a mesh from a file is missing, or a box contains no vertex; InvalidMesh if the
/// faces of the rest mesh differ from those of the initial mesh
Deformable make_cloth(const Scene& scene, const ClothMeshes& meshes = {});

/// Fills a generated shape with tetrahedra: a box exactly, divided into cuboids with edges of about
/// `element`; other shapes by tetrahedralize().
/// @throws Error InvalidOptions as the generators and tetrahedralize() do
TetrahedralMesh make_solid(const SceneModel& shape, double element);

/// Makes one deformable of the scene's cloth, followed by its bodies, with their velocities.
/// @throws Error as make_cloth() and make_soft_body() do; for a body the message begins with its key, such as
/// "bodies[0]". InvalidOptions if a body's file is missing, or a box contains no vertex
Deformable make_deformable(const Scene& scene, const ClothMeshes& meshes = {});

/// Makes a simulation of the scene's cloth, bodies and colliders.
/// @param maps  the maps of the colliders' models, in their order. Build the map of a model with a cache from
/// the vertices of vertices_at() at 0 s; otherwise the first frame would move the vertices there
/// @param caches  [collider_count] the cache of each collider that has one in the scene, as read by the
/// caller; other elements are ignored. May be empty if no collider has a cache
/// @throws Error as make_deformable() and the constructor of Simulation do; InvalidOptions if the number of
/// maps differs from that of colliders, or a cache is missing
Simulation make_simulation(const Scene& scene, std::span<const ColliderMap> maps,
                           const ClothMeshes& meshes = {}, std::span<const VertexCache> caches = {});
/// Makes the simulation of a scene with one collider.
Simulation make_simulation(const Scene& scene, const ColliderMap& map, const ClothMeshes& meshes = {});

} // namespace echinus

ECHINUS_EXPORT_END
