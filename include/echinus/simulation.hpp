#pragma once

#include <echinus/collider.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>
#include <echinus/tetrahedra.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Simulation of deformable models: cloth and soft bodies. The default solver treats them as continuous
/// materials and takes implicit steps, in which contact and friction are part of the energy
/// (docs/mechanics.md). The other solver is that of the paper's simulations (section 2.3), after Jakobsen,
/// "Advanced Character Physics" (GDC 2001): particles are moved by Verlet integration, distance constraints
/// (*sticks*) between them are relaxed one after the other, and each relaxation includes collision with rigid
/// models.
namespace echinus {

/// The purpose of a distance constraint; each kind has its own stiffness.
enum class ConstraintKind : std::uint8_t {
    Structural, ///< between neighbours in a row or column: resists stretching
    Shear,      ///< between neighbours along a diagonal: resists shear
    Bending,    ///< between a particle and the next but one in a row or column: resists bending
};
inline constexpr std::size_t kConstraintKindCount = 3;

/// A distance constraint, which pulls or pushes two particles to the distance `rest_length`. The paper calls
/// it a stick.
struct DistanceConstraint {
    std::uint32_t a, b;
    float rest_length; ///< not negative
    ConstraintKind kind;
};

/// Fixes a particle to a collider: it moves rigidly with the collider from its initial position.
struct Attachment {
    std::uint32_t particle;
    std::uint32_t collider = 0; ///< index in the simulation's colliders
};

/// A particle and a collider that do not collide. Faces and edges that contain the particle also pass through
/// the collider.
struct CollisionFilter {
    std::uint32_t particle;
    std::uint32_t collider = 0; ///< index in the simulation's colliders
};

/// Particles that are held, moved along a path, and finally released.
struct Handle {
    std::vector<std::uint32_t> particles; ///< none is pinned, and each is in at most one handle
    /// The path of the handle: poses over the time since the simulation began, interpolated as in pose_at().
    /// The particles move rigidly with the handle from their positions at 0 s. Without keys the handle does
    /// not move.
    std::vector<PoseKey> keys{};
    /// The time in seconds after which the handle releases its particles: the first frame that begins then or
    /// later releases them. They keep their velocity. If the time is infinite, they are not released.
    double release_time = std::numeric_limits<double>::infinity();
};

/// Particles, their constraints and materials, all in world units and axes.
struct Deformable {
    std::vector<Vec3f> positions; ///< [particle_count]
    /// [particle_count] Units per second. If empty, all particles are at rest, and a simulation stores zeros
    /// here.
    std::vector<Vec3f> velocities{};
    /// [particle_count] 1 / mass; 0 for a pinned particle, which stays in place or moves with its attachment.
    /// If surfaces collide, a pinned particle gives way to anything that would meet it, and returns
    /// afterwards. With Jakobsen masses may have any unit, since only their ratios matter. Newton takes the
    /// masses of soft bodies from here, in kg, and those of cloth from its ClothMaterial.
    std::vector<float> inverse_masses;
    /// The distance constraints, in the order in which Jakobsen relaxes them. Newton uses only the structural
    /// constraints of threads, which run along no edge of a face.
    std::vector<DistanceConstraint> constraints;
    std::vector<Triangle> faces;           ///< used by Newton's cloth, rendering, wind and surface collision
    std::vector<Attachment> attachments{}; ///< attachments of pinned particles, at most one for each
    /// The elements of soft bodies. A particle of an element that belongs to no face is an interior particle
    /// and does not collide.
    std::vector<ElasticTetrahedron> tetrahedra{};
    std::vector<CollisionFilter> filters{}; ///< the pairs that do not collide, in any order
    /// [particle_count] The rest shape, in any pose. If empty, it is the initial shape, which a simulation
    /// stores here. Newton computes the strain and the bending angles of cloth from it; distance constraints
    /// have their own rest lengths.
    std::vector<Vec3f> rest_positions{};
    std::vector<Handle> handles{}; ///< held particles; only Newton supports handles

    std::size_t particle_count() const { return positions.size(); }
};

/// Adds filters to a deformable that disable the collision of all its particles with a collider. After
/// combine(), the filters apply to this part only.
Deformable passing_through(std::uint32_t collider, Deformable deformable);

/// [particle_count] 1 for each particle that passes through a collider because of the deformable's filters;
/// empty if there is none. Filters of particles that the deformable does not have are ignored.
std::vector<std::uint8_t> let_through(const Deformable& deformable, std::size_t collider);
/// Does a face pass through the collider? It does if any of its particles does. @param passes as returned by
/// let_through()
inline bool passes_through(const Triangle& face, std::span<const std::uint8_t> passes) {
    return !passes.empty() && (passes[face[0]] | passes[face[1]] | passes[face[2]]) != 0;
}

// ---- Cloth ----

/// A rectangular sheet of cloth at rest. In its local frame the middle of the sheet is at the origin, columns
/// follow each other along x and rows along y, and z is the normal.
struct ClothOptions {
    std::uint32_t column_count = 100; ///< particles along x; at least 2
    std::uint32_t row_count = 100;    ///< particles along y; at least 2
    double width = 1;                 ///< along x, units
    double height = 1;                ///< along y, units
    RigidTransform pose{}; ///< initial pose of the sheet; its rotation has unit length, to within 1e-4
    std::vector<std::uint32_t> pins{}; ///< particles that do not move: row * column_count + column
};

/// Makes a sheet with structural, shear and bending constraints; a sheet of 100 x 100 particles has 59 002
/// constraints. Particle (row, column) has the index row * column_count + column; the front of every face
/// points along the sheet's local z. Constraints are ordered row by row.
/// @throws Error InvalidOptions
Deformable make_cloth(const ClothOptions& options);

/// The conversion of a mesh to a cloth, and its initial pose.
struct MeshClothOptions {
    RigidTransform pose{}; ///< its rotation has unit length, to within 1e-4
    double scale = 1;      ///< a vertex starts at pose.to_world(scale * vertex); positive
    /// [vertex_count] The rest shape of the cloth, if it differs from the initial mesh; it is scaled as well.
    /// If empty, the mesh is at rest.
    std::vector<Vec3f> rest_vertices{};
    /// Edges without faces: threads and needles. If exactly two threads meet at a vertex, a bending
    /// constraint across the vertex keeps them straight.
    std::vector<std::array<std::uint32_t, 2>> threads{};
    std::vector<std::uint32_t> pins{};     ///< vertices that do not move
    std::vector<Attachment> attachments{}; ///< vertices that move with a collider
};

/// Makes a cloth of any shape: a garment, a sheet with holes, a closed bag, or several pieces at once, in O(n
/// log n) time for n vertices, faces and threads. Its particles are the mesh's vertices and its faces those
/// of the mesh. A face that traverses a common edge in the same direction as an earlier face is flipped. On a
/// one-sided surface faces cannot agree everywhere; this affects only rendering.
///
/// Each edge and each thread gets a structural constraint. Two triangles that form a quadrilateral with
/// nearly right angles (within 20 degrees) get shear constraints along both diagonals instead of one along
/// their common edge, like the squares of a sheet. Every other edge between two faces gets a bending
/// constraint between the opposite corners. Newton computes bending from the faces, and uses only the
/// structural constraints of threads.
///
/// Masses are proportional to the areas around the particles in the rest shape, with a mean of 1, as in a
/// sheet; a thread weighs as much as a strip of cloth whose width is the mean edge length. Newton takes the
/// masses of cloth from its ClothMaterial.
/// @throws Error InvalidMesh, naming the face, edge or vertex, when inspect() would throw, an edge has
/// more than two faces, two faces have the same corners, a face has no area or a thread no length in the
/// rest shape, or a vertex belongs to no face or thread (weld() drops such vertices); InvalidOptions for
/// options out of range, and for vertices that the mesh does not have
Deformable make_cloth(const TriangleMesh& mesh, const MeshClothOptions& options);

/// The condition of rest: for `frame_count` frames in a row every particle has stayed within `distance` of
/// one position and has been no faster than `speed`. Neither condition suffices alone: a trembling particle
/// stays near one position, and cloth at the end of a swing is slow for a moment.
///
/// With SolverKind::Jakobsen, a much lower speed may not be reached: gravity alone adds 0.04 units per second
/// in one frame of 1/240 s, and a particle that contacts and constraints push slightly back and forth keeps
/// trembling at about this speed.
struct RestCondition {
    double distance = 0.001; ///< largest distance from one position, units
    double speed = 0.1;      ///< largest speed at the end of a frame, units per second; may be infinite
    std::uint32_t frame_count = 60; ///< number of frames in a row; at least 1
};

/// The material of cloth, for NewtonOptions. The defaults describe a cotton, in SI units. Faces of tetrahedra
/// are not cloth: bodies have their own material.
struct ClothMaterial {
    double density = 0.2;            ///< mass per area, kg/m^2; positive
    double stretch_stiffness = 1000; ///< force per width along warp and weft, N/m; positive. A thread is as
                                     ///< stiff as a strip whose width is the mean edge length
    double shear_stiffness = 400;    ///< between warp and weft, N/m; not negative
    double bending_stiffness = 1e-5; ///< N m; not negative
    double damping = 0.01; ///< viscosity divided by stiffness, seconds; not negative. Motions that take much
                           ///< longer than this are hardly damped

    bool operator==(const ClothMaterial&) const = default;
};

/// The parts of a deformable that collide.
enum class CollisionMode : std::uint8_t {
    /// Particles collide with colliders. An edge of a collider may protrude between particles.
    Particles,
    /// Edges and faces collide with colliders, too: no face of the deformable intersects a collider, within
    /// the limits of docs/limits.md (docs/surfaces.md explains the method). This needs an exact map of the
    /// collider, as its map or as ColliderMap::surface; with a collider that has no exact map only particles
    /// collide. The exact map of an open mesh does not need allow_open_colliders, and keeps each particle on
    /// its side of the surface. In the initial state no face may intersect a collider, and no particle may be
    /// inside a closed model (but see NewtonOptions::untangle).
    Surfaces,
    /// In addition, faces of the deformable do not intersect each other; in the initial state they must not.
    SurfacesAndSelf,
};

/// A continuous material in SI units (docs/mechanics.md): each step minimises the energy of inertia, material
/// and contact by Newton's method with multigrid. Cloth and soft bodies stretch according to their materials,
/// nearly independently of the resolution and the time step; 1/60 s per frame is a good step.
struct NewtonOptions {
    ClothMaterial material{};
    /// The largest number of steps of Newton's method in each frame or substep; twice as many are allowed
    /// while there is no contact. Fewer are taken if the method converges. With a limit below two, contacts
    /// remain unresolved.
    std::uint32_t step_count = 4;
    /// Tolerance of Newton's method, relative to the mean edge length. The method has converged when the
    /// decrease of the energy corresponds to a root-mean-square displacement of at most the tolerance times
    /// that length.
    double tolerance = 5e-4;
    /// Resistance of still air, 1/s: the rate at which the velocity of a free particle decays, whatever the
    /// time step. 0 is a vacuum.
    double air_drag = 0.5;
    /// Pressure inside closed pieces of cloth in excess of the surrounding pressure, N/m^2. It is constant,
    /// as if a pump maintained it, and pushes each face outwards. Not negative.
    double pressure = 0;
    CollisionMode collision = CollisionMode::SurfacesAndSelf;
    /// Distance in units that layers of the deformable keep from each other; by default the thickness. The
    /// distance is less near small faces: at most 0.4 of the smallest height of a face, and at most a quarter
    /// of the mean edge length, so that neighbours have room.
    std::optional<double> self_thickness{};
    /// Separate an initial state that intersects a model or itself, or lies inside a closed model, before the
    /// first frame instead of rejecting it, by moving particles that are not pinned (docs/surfaces.md). An
    /// initial state that cannot be separated is rejected. Each round costs a search for intersecting pairs
    /// and a step of the material; there may be hundreds, so that 10 000 particles on a detailed model take
    /// up to a minute. Needs the collision of surfaces.
    bool untangle = false;

    bool operator==(const NewtonOptions&) const = default;
};

/// The paper's method (section 2.3), for reproduction and comparison: Verlet integration, distance
/// constraints, relaxed one after the other (Jakobsen 2001), and collision of particles. Each relaxation of a
/// constraint removes a share of its error. More relaxations per second make the cloth stiffer, so frames of
/// 1/240 s or less are needed: halving the step doubles the computing time and reduces the stretch to a
/// quarter. This solver rejects tetrahedra and measures no loads.
struct JakobsenOptions {
    /// Number of relaxations per frame; each relaxes all distance constraints and then all contacts. More
    /// relaxations take longer and leave less stretch.
    std::uint32_t iteration_count = 10;
    double drag = 0.005; ///< share of the velocity that is lost per frame, 0 to 1
    /// Share of a constraint's error that one relaxation removes, by ConstraintKind. 1 removes all of it; a
    /// value between 1 and 2 overshoots, which propagates tension farther per relaxation.
    std::array<double, kConstraintKindCount> stiffness{1, 1, 0.3};
    /// If false, no particle is rescued; a particle that crosses the surface of an exact map counts as lost
    /// and stays there. This serves only to demonstrate the effect of the proof at the end of a frame.
    bool keep_free = true;

    bool operator==(const JakobsenOptions&) const = default;
};

/// The solver that moves a deformable: the alternatives of SimulationOptions::solver, in their order.
enum class SolverKind : std::uint8_t { Newton, Jakobsen };

struct SimulationOptions {
    std::variant<NewtonOptions, JakobsenOptions> solver{};
    double time_step = 1.0 / 60; ///< seconds per frame. Jakobsen needs a quarter of the default or less
    Vec3d gravity{0, 0, -9.81};  ///< units per second squared
    /// Distance in units that the deformable keeps from colliders. By default it is half the mean rest length
    /// of the structural constraints or, for soft bodies, half the mean edge length (docs/thickness.md).
    /// Newton: the effective value is at least a fiftieth of the mean edge length, and at least 1e-6.
    /// Jakobsen: 0 is possible but slow, since particles on the surface itself need a query in every
    /// relaxation; with this value one face in twenty intersects the model.
    std::optional<double> thickness{};
    /// Coulomb's coefficient of friction; 0 is no friction. Jakobsen: the tangential motion relative to the
    /// collider is reduced by the coefficient times the length of the push-out, but at most to 0.
    double friction = 0.5;
    RestCondition rest{};
    /// Accept exact maps of open meshes for the collision of particles. Nothing is guaranteed for them: near
    /// a hole the inside is only estimated, so particles get in there, and some of them are pushed out
    /// through the surface and count as lost (lost_count). Prefer a closed mesh (see repair()) or a distance
    /// map.
    bool allow_open_colliders = false;
    /// The largest distance, in units, of a particle from the initial middle of the deformable. If a particle
    /// is farther away, the simulation ends as diverged. 0 means 10 000 times the initial extent of the
    /// deformable.
    double bound = 0;
    /// The number of threads that compute a frame; 0 means all cores. The results are bit-identical for any
    /// number. More than one thread needs oneTBB; waiting threads spin during a frame.
    unsigned thread_count = 1;
    /// The wind in every frame for which blow() is not called, given by the arguments of blow(). A rate of 0
    /// means no air; the wind must then be 0, too.
    Vec3d wind{};         ///< velocity of the air, units per second
    double wind_rate = 0; ///< per second

    SolverKind kind() const { return static_cast<SolverKind>(solver.index()); }
    /// The options of the solver that is set. @throws std::bad_variant_access if the other solver is set
    NewtonOptions& newton() { return std::get<NewtonOptions>(solver); }
    const NewtonOptions& newton() const { return std::get<NewtonOptions>(solver); }
    JakobsenOptions& jakobsen() { return std::get<JakobsenOptions>(solver); }
    const JakobsenOptions& jakobsen() const { return std::get<JakobsenOptions>(solver); }
    /// Whether edges and faces collide with colliders, and whether they collide with each other. Both are
    /// false with Jakobsen.
    bool surfaces_collide() const {
        return kind() == SolverKind::Newton && newton().collision != CollisionMode::Particles;
    }
    bool layers_collide() const {
        return kind() == SolverKind::Newton && newton().collision == CollisionMode::SurfacesAndSelf;
    }
};

/// The options of both solvers side by side and the choice between them, for programs whose options are flat,
/// such as files, dialogs and other languages.
struct SolverChoice {
    SolverKind kind = SolverKind::Newton;
    NewtonOptions newton{};
    JakobsenOptions jakobsen{};

    /// Takes the options that are set, and the defaults of the other solver; if Jakobsen is set,
    /// newton.collision becomes CollisionMode::Particles.
    explicit SolverChoice(const SimulationOptions& options);
    /// The options of the chosen solver.
    std::variant<NewtonOptions, JakobsenOptions> chosen() const;
    /// @throws Error InvalidOptions, naming the option, if an option that only the other solver has differs
    /// from its default. CollisionMode::Particles is accepted with Jakobsen
    void require_defaults_of_other() const;
};

/// A force and a torque on a collider, in world axes.
struct Load {
    Vec3d force;  ///< N
    Vec3d torque; ///< N m, about the pose's translation, which moves with the collider
};

/// A contact that exerted a force in the last frame, between a particle, edge or face of the deformable and a
/// collider, or between two elements of the deformable.
struct ContactPoint {
    Vec3d position; ///< position on the deformable when the contact last exerted a force; world frame
    Vec3d normal; ///< unit; points towards the deformable or, in self-collision, towards the first of the two
                  ///< elements in contact
    double gap;   ///< the distance when the contact last exerted a force; positive
    double normal_impulse;  ///< impulse of the frame along the normal, on the deformable or, in
                            ///< self-collision, on the first of the two elements, N s
    Vec3d friction_impulse; ///< impulse of the frame perpendicular to the normal, on the same element, N s
    std::uint32_t collider; ///< its index; kNoIndex if the deformable is in contact with itself
    /// The particles of the deformable's element, followed in self-collision by those of the second element:
    /// a vertex and the three corners of a face, or the two ends of each edge. Unused entries are kNoIndex.
    std::array<std::uint32_t, 4> particles;
};

/// Times and counts of step() since the simulation began. Times vary from run to run.
struct SimulationProfile {
    double integration_seconds = 0; ///< Jakobsen: Verlet integration, and the checks for divergence and rest
    double constraint_seconds = 0;  ///< Newton: the steps of its method; Jakobsen: distance constraints
    double collision_seconds = 0;   ///< contact and the motion of colliders
    std::uint64_t query_count = 0;  ///< Jakobsen: particle queries, counted per iteration and collider
    std::uint64_t contact_count =
        0; ///< Newton: active contacts, summed over steps; Jakobsen: queries that pushed a particle
    /// Jakobsen: queries that needed the map; with an exact map, the query for a particle that has hardly
    /// moved is answered from cached data.
    std::uint64_t map_query_count = 0;
    /// Jakobsen: number of times that a particle was rescued, that is, moved back to a free position because
    /// after the relaxations of a frame it was no longer free of all exact maps. docs/conventions.md defines
    /// free, rescued and lost.
    std::uint64_t rescued_count = 0;
    /// Jakobsen: number of times that a particle was lost, that is, ended a frame no longer free of an exact
    /// map of which it had once been free. A particle counts once for each such map in each such frame. A
    /// particle that began inside and has not been outside yet does not count.
    std::uint64_t lost_count = 0;
    /// If surfaces collide: number of times that the displacement of a particle in a frame or substep was
    /// truncated, because an edge or face of the particle could have met a surface on the path.
    std::uint64_t truncated_count = 0;
    /// If surfaces collide: number of vertex-face and edge-edge pairs whose distance was measured.
    std::uint64_t measured_pair_count = 0;
    /// If surfaces collide: number of unresolved vertex-face and edge-edge pairs, for which no free space was
    /// proven at the start of a substep because colliders left no room, summed over all substeps. While this
    /// number is 0, no faces intersect at the end of a frame. Intersections because of rounding, hundreds of
    /// a collider's radii from the origin, are not counted (docs/limits.md).
    std::uint64_t unresolved_count = 0;
};

/// The relative deviation of structural constraints from their rest lengths; 0.01 is 1 %. With Jakobsen, it
/// is the residual error of the relaxations; with Newton it includes the strain of the material.
struct Residual {
    double root_mean_square = 0, largest = 0; ///< 0 without such constraints
};

/// A cut, as in a film: objects change their position from one frame to the next without moving in between.
struct Teleport {
    RigidTransform motion; ///< a point p goes to motion.to_world(p); velocities rotate with it
    /// Indices of the colliders that are teleported, with their keyframes.
    std::vector<std::uint32_t> colliders{};
    /// Whether the deformable is teleported, together with pinned particles and the paths of handles.
    /// Colliders to which particles are attached must be teleported with it.
    bool deformable = true;
    /// Seconds since the simulation began: the cut takes place in the first frame that begins then or later.
    double time = 0;
};

class [[gnu::visibility("hidden")]] Solver; // src/simulation/solver.hpp

/// The simulation of a deformable and its colliders. The same input gives the same positions, bit for bit, in
/// every run and with any instruction set and number of threads; this is tested on x86-64 and WebAssembly.
/// Copies are independent.
class Simulation {
  public:
    /// Prepares a simulation. With Jakobsen it allocates all memory that step() needs, except for the memory
    /// that each thread keeps from its first batches on (docs/conventions.md). Rotations whose length differs
    /// from 1 by at most 1e-4, as after rounding to float, are normalised.
    /// @throws Error InvalidOptions, naming the fault, when an option is out of range, the arrays of the
    /// deformable do not fit together, a constraint or a face refers to a particle that does not exist, a
    /// number is not finite, or a collider has a scale of 0, a rotation that does not have unit length, a
    /// null pointer for a map, or, if only particles collide, the exact map of an open mesh without
    /// options.allow_open_colliders. InvalidOptions is also thrown if surfaces collide and the deformable
    /// initially intersects a collider or, with CollisionMode::SurfacesAndSelf, itself, or is inside a
    /// collider, unless untangle is set and can separate them; the message names the first pairs
    Simulation(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);
    ~Simulation();
    Simulation(const Simulation& other);
    Simulation& operator=(const Simulation& other);
    Simulation(Simulation&& other) noexcept;
    Simulation& operator=(Simulation&& other) noexcept;

    /// Computes one frame. Newton: colliders advance by their velocities and carry nearby particles along;
    /// then the energy is minimised, and every step towards the minimum is limited so that faces stay apart.
    /// When a frame ends, no face intersects a collider or, with CollisionMode::SurfacesAndSelf, another
    /// face. docs/limits.md lists the limits; unresolved_count counts most of the cases in which the
    /// guarantee did not hold. A frame in which a collider moves far, in which something strikes hard, or
    /// in which there is no room to move is divided into substeps, fewer than 128. Memory is kept from frame
    /// to frame: a frame that needs no more than the previous ones allocates nothing, except for the maps of
    /// deforming colliders.
    ///
    /// Jakobsen: a frame consists of Verlet integration with drag, the motion of the colliders,
    /// iteration_count relaxations of all distance constraints and all collisions of particles with
    /// colliders, and finally the proof that no particle passed through an exact map. It allocates nothing
    /// after a thread's first batches.
    ///
    /// A distance map pushes particles along its rays (docs/paper.md), and a custom map to the points that it
    /// returns; both push a particle that is not inside by no more than its motion towards the surface. An
    /// exact map pushes particles to a distance equal to the thickness above the nearest point. At the end of
    /// the frame each particle is swept from its last free position to its present one, in the frame of the
    /// moving collider. A particle that is not free is rescued: it is moved back in front of the crossing if
    /// the same sweep finds it free there, or else to its last free position, which moves with the collider.
    ///
    /// So no particle passes through an exact map, however fast it is and however thin the model: with one
    /// exact map, close enough to the origin for floats, lost_count stays 0. This guarantee has limits:
    /// - It applies to particles. An edge of a collider may protrude between them.
    /// - Distance maps and custom maps are not swept. Nothing is guaranteed for them, nor for the exact map
    /// of an open mesh.
    /// - If only particles collide, pinned and attached particles stay where they are held.
    /// - A particle that begins inside is pushed to the nearest surface point, and is kept outside from then
    /// on.
    /// - A particle that is squeezed between several exact maps returns to its last position free of the
    /// first of them, or else of the next, and counts as lost to the others.
    /// - Far from the origin floats may be too coarse for the room around the last free position. A particle
    /// that cannot be placed there counts as lost.
    ///
    /// @throws Error Diverged, naming the frame, in this and in each further step; as teleport() does; as
    /// ExactMap::build() does if no map can be built from the vertices of a vertex cache: in that case
    /// nothing changes, and the simulation can continue after set_collider_cache() with a different cache
    void step();

    const Deformable& deformable() const;
    std::span<const Vec3f> positions() const { return deformable().positions; }
    const std::vector<Collider>& colliders() const;
    /// The given options, with the effective thickness.
    const SimulationOptions& options() const;
    /// Number of frames that have been computed.
    std::uint32_t frame() const;
    /// Speed of the fastest particle in the last frame, units per second; infinite before the first.
    double largest_speed() const;
    /// Has the rest condition held for the required number of frames?
    bool at_rest() const;
    const SimulationProfile& profile() const;
    /// The residual at the end of the last frame. With Jakobsen, a large residual calls for more relaxations
    /// or smaller steps. Computing it takes about a third as long as one relaxation of all constraints.
    Residual residual() const;
    /// XXH64 hash of the bits of all positions and velocities.
    std::uint64_t state_hash() const;

    // Motion of colliders. For each collider, the last call of one of the following four functions applies.
    // All have the precondition collider_index < colliders().size().

    /// Sets the velocities of a collider, which it keeps until they are set again.
    void set_collider_velocity(std::size_t collider_index, const Vec3d& linear, const Vec3d& angular);

    /// Makes the collider move to this pose during the next frame, at constant velocity and rotating along
    /// the shorter arc, and then stay there, up to rounding, until the next call. On its path it collides,
    /// with friction, like any moving collider.
    /// @throws Error InvalidOptions when the pose is not finite, or the length of its rotation differs from 1
    /// by more than 1e-4
    void set_collider_pose(std::size_t collider_index, const RigidTransform& pose);

    /// Makes the collider follow keyframes: each frame moves it to the pose that pose_at() returns for the
    /// end of the frame, options().time_step * (frame() + 1) seconds after the simulation began, with frame()
    /// as it is before the frame. The collider starts from its present pose, so place it at the present
    /// pose_at() first. The simulation is not at rest before the last key. Without keys the collider does not
    /// move.
    /// @throws Error InvalidOptions, naming the key, when a time or a pose is not finite, a rotation does
    /// not have unit length to within 1e-4, or a time is not later than the previous one
    void set_collider_keyframes(std::size_t collider_index, std::vector<PoseKey> keys);

    /// Newton: makes the collider move freely, from its present velocities, as a solid of uniform density.
    /// Each step solves for its pose together with the deformable, under gravity, contact and friction. Other
    /// colliders do not stop it. A collider with attached particles is moved by the load of the previous
    /// frame instead.
    /// @param mass  kg, 1e-9 to 1e15
    /// @throws Error InvalidOptions when the mass is out of range, the solver is Jakobsen, or the collider
    /// has no exact map of a closed mesh
    void set_collider_free(std::size_t collider_index, double mass);

    /// Newton: moves colliders, the deformable or both without traversing the space in between: at once if
    /// the teleport's time has come, otherwise in the frame of that time. Velocities keep their magnitudes
    /// and rotate with the motion. A collider that is teleported without the deformable neither carries
    /// anything along nor pushes anything on the way. Objects that are teleported together keep their
    /// relative positions, up to rounding.
    /// @throws Error InvalidOptions when the motion is not finite or the length of its rotation differs from
    /// 1 by more than 1e-4, a collider does not exist, the solver is Jakobsen, only one of a collider and the
    /// particles attached to it is teleported, or, if surfaces collide, the deformable would intersect a
    /// collider; the last error comes from step() if the time is in the future. After an error nothing has
    /// changed, and the teleport is dropped
    void teleport(const Teleport& teleport);

    // Deforming colliders: their vertices move, and their faces stay the same. The precondition is
    // collider_index < colliders().size(). The collider needs an exact map, and surfaces must collide.
    // Surfaces are kept off the moving faces as off any other faces (docs/surfaces.md), and attached
    // particles follow the face that was nearest to them when the collider first deformed. Each frame that
    // deforms a collider rebuilds its exact map on one thread, and may allocate.

    /// Makes the vertices of a collider's mesh move to these positions along straight lines during the next
    /// frame, and then stop. The pose is independent and may move at the same time. The map is built in this
    /// call.
    /// @param vertices_local  [vertex_count] the vertices of the mesh from which its exact map was built, in
    /// the same order
    /// @throws Error InvalidOptions for a different number of vertices, a position that is not finite, a
    /// collider without an exact map, or if only particles collide; as ExactMap::build() does. If it throws,
    /// nothing has changed
    void set_collider_vertices(std::size_t collider_index, std::span<const Vec3f> vertices_local);

    /// Makes each frame move the vertices to the positions that vertices_at() returns for the end of the
    /// frame. The simulation is not at rest before the last sample.
    /// @throws Error InvalidOptions for a cache with a different number of vertices, without a sample, or
    /// with times or positions that are not finite; and as set_collider_vertices() does
    void set_collider_cache(std::size_t collider_index, VertexCache cache);

    /// Newton: the force and torque that the deformable exerted on a collider in the last frame by contact,
    /// friction and attached particles, averaged over the frame. It is 0 before the first frame, and always
    /// with Jakobsen. A program with rigid bodies of its own should let step() move them, by
    /// set_collider_free() (examples/08_load): a program that applies the load of the previous frame to them
    /// is stable only with small steps.
    /// @pre collider_index < colliders().size()
    Load load_on(std::size_t collider_index) const;

    /// Newton: sets whether the following frames record the contacts that exert a force. Recording is off by
    /// default, and costs nothing while it is off. The setting is not part of a saved state.
    void record_contacts(bool is_on);
    /// The contacts that were recorded in the last frame, in unspecified order; valid until the next frame.
    /// For each collider, the impulses of its contacts divided by the time step sum to the opposite of
    /// load_on(), except for the loads of attached particles and of particles that the collider stopped
    /// before contact acted (SimulationProfile::truncated_count). Empty under Jakobsen.
    std::span<const ContactPoint> contact_points() const;

    /// Sets the velocity of a particle, in units per second. The next frame treats it like any other
    /// velocity: the material pulls at the particle and colliders stop it. To drag particles, set their
    /// velocities towards the pointer before each frame; none of them is dragged into a model. A pinned
    /// particle does not move.
    /// @pre particle < particle_count(), and the velocity is finite
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity);

    /// Sets the wind for one frame. Each particle takes on the share rate * time_step of the velocity of the
    /// air relative to the surrounding faces; only the components along their normals count, averaged over
    /// the faces. Air slips along faces. Call this before each frame, in which it replaces the wind of the
    /// options.
    /// @param wind  velocity of the air, units per second; with 0 the air is at rest and slows motion
    /// @param rate  per second; higher for lighter cloth. Not negative
    /// @pre both are finite
    void blow(const Vec3d& wind, double rate);

    // Saved states (docs/saved_states.md). Call these functions between frames.

    /// Returns the state of the simulation as bytes: particles, cached data on the surfaces around them, the
    /// motion of the colliders, and counts. The same state gives the same bytes. The inputs of the simulation
    /// are not included: deformable, maps, options and vertex caches. A state takes about 100 bytes per
    /// particle, and more with surface collision; saving takes about as long as copying these bytes.
    std::vector<std::byte> save_state() const;
    /// Writes the state to a file atomically.
    /// @throws Error Unwritable
    void save_state(const std::filesystem::path& path) const;

    /// Restores a saved state: the following frames are bit-identical to the frames that followed the call of
    /// save_state(). The simulation must have been made from the same deformable, colliders in their initial
    /// poses, and options; a collider that followed a vertex cache must already follow the same cache. Poses,
    /// velocities and keyframes come from the state. A custom map is not compared. The times in profile() are
    /// not restored.
    ///
    /// All bytes are checked before use. References and spans that this simulation returned become invalid.
    /// @param name  a name for the bytes, with which error messages begin
    /// @throws Error WrongFormat, UnsupportedVersion or Damaged for bytes that are not a state, are of
    /// another version, or are truncated or altered; InvalidOptions for a state of another simulation, naming
    /// the difference. If it throws, nothing has changed
    void restore_state(std::span<const std::byte> bytes, const std::string& name = "the saved state");
    /// Restores a state from a file. @throws Error as for bytes, and Unreadable; the message begins with the
    /// path
    void restore_state(const std::filesystem::path& path);

  private:
    std::unique_ptr<Solver> solver_;
};

} // namespace echinus

ECHINUS_EXPORT_END
