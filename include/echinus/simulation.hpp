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
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Deformable models, cloth and soft bodies, as continuous materials in implicit steps, with contact and
/// friction in the same energy (docs/mechanics.md). Or cloth after Jakobsen, "Advanced Character Physics"
/// (GDC 2001), the method that the paper's simulations use (section 2.3): particles moved by Verlet
/// integration, sticks between them relaxed one after the other, and collision with rigid models inside every
/// relaxation.
namespace echinus {

/// The purpose of a stick; each kind has its own stiffness.
enum class StickKind : std::uint8_t {
    Structural, ///< between neighbours of a row or column: keeps the cloth from stretching
    Shear,      ///< between neighbours along a diagonal: keeps its squares square
    Bending,    ///< between every second particle of a row or column: keeps it from folding sharply
};
inline constexpr std::size_t kStickKindCount = 3;

/// Pulls or pushes two particles to the distance `rest_length`.
struct Stick {
    std::uint32_t a, b;
    float rest_length; ///< not negative
    StickKind kind;
};

/// Fixes a particle to a collider: it moves rigidly with the collider, from where it is at the start.
struct Attachment {
    std::uint32_t particle;
    std::uint32_t collider = 0; ///< index in the simulation's colliders
};

/// A particle and a collider that do not collide. Faces and edges of the particle pass through that collider,
/// too.
struct CollisionFilter {
    std::uint32_t particle;
    std::uint32_t collider = 0; ///< index in the simulation's colliders
};

/// Particles that are held, led along a path, and let go.
struct Handle {
    std::vector<std::uint32_t> particles; ///< that are not pinned, each in one handle at most
    /// Its path: where it is at which time after the simulation began, as pose_at() has it. Particles move
    /// rigidly with it from where they begin, which is where they are at 0 s. No keys: it stands still.
    std::vector<PoseKey> keys{};
    /// It lets go in the first frame that begins then or later, seconds, and what it held goes on with its
    /// velocity. Infinite: never.
    double release_time = std::numeric_limits<double>::infinity();
};

/// Particles and what holds them together, all in world units and axes.
struct Deformable {
    std::vector<Vec3f> positions; ///< [particle_count]
    /// [particle_count] where a particle at its present velocity was one frame ago: positions -
    /// previous_positions = velocity * time_step. Under Jakobsen that is where it was.
    std::vector<Vec3f> previous_positions;
    /// [particle_count] 1 / mass; 0 for a pinned particle: it stays in place, or where it is attached, and no
    /// collider pushes it. Jakobsen: in any unit, since only ratios count. Newton takes the masses of soft
    /// bodies from here, in kg, and those of cloth from its ClothMaterial.
    std::vector<float> inverse_masses;
    /// In the order in which Jakobsen relaxes them. Of Newton's cloth only those count that are structural
    /// and no edges of faces: threads.
    std::vector<Stick> sticks;
    std::vector<Triangle> faces;           ///< for Newton's cloth, pictures, wind and contact of surfaces
    std::vector<Attachment> attachments{}; ///< of pinned particles, at most one of each
    /// A particle of theirs that is in no face lies inside: those around it collide, and it does not.
    std::vector<ElasticTetrahedron> tetrahedra{};
    std::vector<CollisionFilter> filters{}; ///< in any order
    /// [particle_count] The shape at rest, in any place and pose; empty: as it begins, which a simulation
    /// writes here. Newton's cloth has its strain and its angles from it; sticks have their lengths
    /// themselves.
    std::vector<Vec3f> rest_positions{};
    std::vector<Handle> handles{}; ///< Newton

    std::size_t particle_count() const { return positions.size(); }
};

/// The same deformable, of which nothing collides with a collider. combine() makes a filter by pair of it: of
/// this part and that collider.
Deformable passing_through(std::uint32_t collider, Deformable deformable);

/// [particle_count] 1 for the particles that a collider lets through by the deformable's filters; empty if
/// there are none. Filters of particles that the deformable does not have are left out.
std::vector<std::uint8_t> let_through(const Deformable& deformable, std::size_t collider);
/// The same of a face: does one of its particles pass? @param passes  as let_through() has it
inline bool passes_through(const Triangle& face, std::span<const std::uint8_t> passes) {
    return !passes.empty() && (passes[face[0]] | passes[face[1]] | passes[face[2]]) != 0;
}

// ---- Cloth ----

/// A rectangular sheet of cloth at rest. Its local frame has the sheet's middle at the origin, the columns
/// along x, the rows along y, and z across it.
struct ClothOptions {
    std::uint32_t column_count = 100; ///< particles along x; at least 2
    std::uint32_t row_count = 100;    ///< particles along y; at least 2. Time per step grows with the product
    double width = 1;                 ///< along x, units
    double height = 1;                ///< along y, units
    RigidTransform pose{};            ///< where the sheet starts; its rotation of unit length, to 1e-4
    std::vector<std::uint32_t> pins{}; ///< particles that never move: row * column_count + column
};

/// A sheet with structural, shear and bending sticks; for 100 x 100 particles 59 002 of them. Particle (row,
/// column) has index row * column_count + column; every face turns its front along the sheet's local z.
/// Sticks are ordered row by row.
/// @throws Error InvalidOptions
Deformable make_cloth(const ClothOptions& options);

/// How a mesh becomes a cloth, and where it starts.
struct MeshClothOptions {
    RigidTransform pose{}; ///< its rotation of unit length, to 1e-4
    double scale = 1;      ///< a vertex starts at pose.to_world(scale * vertex); positive
    /// [vertex_count] The shape of the cloth at rest, where it differs from the mesh that it starts as;
    /// scaled as well. If empty, the mesh is at rest.
    std::vector<Vec3f> rest_vertices{};
    /// Edges without faces: threads and needles. Where just two of them meet in a vertex, a bending stick
    /// across it keeps them straight.
    std::vector<std::array<std::uint32_t, 2>> threads{};
    std::vector<std::uint32_t> pins{};     ///< vertices that never move
    std::vector<Attachment> attachments{}; ///< vertices that move with a collider
};

/// A cloth of any shape: a garment, a sheet with holes, a closed bag, several pieces at once. Its particles
/// are the mesh's vertices, and its faces the mesh's, of which those that run along a common edge the same
/// way as an earlier one are turned round. On a one-sided surface that is not possible everywhere; only
/// pictures show it.
///
/// There is a structural stick along each edge and each thread. Two triangles that make up a quadrilateral
/// with about right angles (within 20 degrees) have shear sticks along both diagonals instead, like the
/// squares of a sheet. Across each other edge between two faces there is a bending stick, between the corners
/// opposite it. Newton bends the faces themselves, and reads of the sticks only the threads.
///
/// Masses are those of the areas around the particles in the rest shape; a thread weighs as much as a strip
/// of cloth that is as wide as the mean edge is long. Their mean is 1, as in a sheet; Newton weighs cloth by
/// its ClothMaterial. Time O(n log n).
/// @throws Error InvalidMesh, naming a face, edge or vertex at fault, when inspect() would throw, an edge has
/// more than two faces, two faces have the same corners, a face has no area or a thread no length in the
/// rest shape, or a vertex belongs to no face or thread (weld() drops such vertices); InvalidOptions for
/// options out of range, and for vertices that the mesh does not have
Deformable make_cloth(const TriangleMesh& mesh, const MeshClothOptions& options);

/// When a deformable counts as at rest: for `frame_count` frames in a row every particle has stayed
/// within `distance` of one place and has been no faster than `speed`. Neither suffices alone: a particle
/// that trembles stays near one place, and cloth at the end of a swing is slow for a moment.
///
/// Under SolverKind::Jakobsen a much lower speed may never be reached: gravity alone adds 0.04 units per
/// second in one frame of 1/240 s, and a particle that contacts and sticks move slightly back and forth
/// trembles at such a speed forever.
struct RestCondition {
    double distance = 0.001;        ///< units
    double speed = 0.1;             ///< units per second, at the end of a frame; may be infinite
    std::uint32_t frame_count = 60; ///< at least 1
};

/// How a deformable moves.
enum class SolverKind : std::uint8_t {
    /// As a continuous material (docs/mechanics.md): each step minimises the energy of inertia, of the
    /// material and of contact by Newton's method with multigrid. Cloth stretches as its ClothMaterial says
    /// and soft bodies as theirs, whatever the resolution and the time step; 1/60 s per frame is a good step.
    /// In SI units.
    Newton,
    /// The paper's (section 2.3), for reproduction and comparison: Verlet integration, sticks of which each
    /// relaxation removes a share of the error (Jakobsen 2001), and particles that collide. More relaxations
    /// per second make a stiffer cloth, so frames of 1/240 s or less are needed. It refuses tetrahedra and
    /// surface_collision, and measures no loads.
    Jakobsen,
};

/// The material of cloth, for SolverKind::Newton. The defaults are those of a cotton, in SI units. Faces of
/// tetrahedra are not cloth: bodies have a material of their own.
struct ClothMaterial {
    double density = 0.2;            ///< mass per area, kg/m^2; positive
    double stretch_stiffness = 1000; ///< force per width of warp and weft, N/m; positive. Threads have that
                                     ///< of a strip as wide as the mean edge is long
    double shear_stiffness = 400;    ///< between warp and weft, N/m; not negative
    double bending_stiffness = 1e-5; ///< N m; not negative
    double damping = 0.01; ///< viscosity over stiffness, seconds: not negative. Motions that take much
                           ///< longer are hardly damped
};

struct SimulationOptions {
    SolverKind solver = SolverKind::Newton;
    double time_step = 1.0 / 60; ///< seconds per frame. Jakobsen needs a quarter of that or less: half of it
                                 ///< takes twice the time and leaves a quarter of the stretch
    /// Jakobsen: relaxations per frame, of all sticks and then of all contacts: more take longer and stretch
    /// less.
    std::uint32_t iteration_count = 10;
    Vec3d gravity{0, 0, -9.81}; ///< units per second squared
    double drag = 0.005; ///< Jakobsen: share of the velocity that is lost per frame, 0 to 1. Newton: air_drag
    /// Jakobsen: share of a stick's error that one relaxation removes, by StickKind. 1 removes all; from 1 to
    /// 2 (not included) it overshoots, which carries tension further per relaxation.
    std::array<double, kStickKindCount> stiffness{1, 1, 0.3};
    ClothMaterial material{}; ///< Newton
    /// Newton: at most so many steps of Newton's method in each frame, or part of one; fewer where it has
    /// converged. Fewer than two leave contacts unresolved.
    std::uint32_t newton_step_count = 4;
    /// Newton: a step of Newton's method has converged if the energy that it gains could move particles no
    /// farther than this in the root mean square; share of the mean edge length.
    double newton_tolerance = 5e-4;
    /// Newton: resistance of still air, 1/s: the rate at which a velocity decays that nothing keeps up,
    /// whatever the time step. 0 is a vacuum.
    double air_drag = 0.5;
    /// Distance that the deformable keeps from colliders, units. If not given, half the mean rest length of
    /// the structural sticks or, of soft bodies, half the mean edge (docs/thickness.md). Newton: never less
    /// than a fiftieth of the mean edge. Jakobsen: 0 is possible and slow: particles on the surface itself
    /// need a query in every relaxation, and a face in twenty is cut.
    std::optional<double> thickness{};
    /// Coulomb's coefficient; 0 is ice. Jakobsen: tangential motion relative to the collider is shortened by
    /// this times the length of the push, and never reversed.
    double friction = 0.5;
    RestCondition rest{};
    /// false under Jakobsen: no particle is rescued; those that cross the surface of an exact map are counted
    /// as lost and left there. Only to demonstrate the effect of the proof at the end of a frame.
    bool keep_free = true;
    /// Accept exact maps of open meshes. Nothing is promised for them: near a gap it is only estimated what
    /// is inside, so particles get in there, some are pushed out through the surface, and lost_count tells
    /// how often. Prefer a closed mesh (see repair()) or a distance map.
    bool allow_open_colliders = false;
    /// Edges and faces collide too, not only particles: no face of the deformable ever meets a collider
    /// (docs/surfaces.md). Every collider needs an exact map, as its map or as ColliderMap::surface; under
    /// Newton only particles collide with one that has none. One of an open mesh needs no
    /// allow_open_colliders and keeps each particle on its side. Nothing may intersect at the start, no
    /// particle may begin inside a closed model (but see untangle), and keep_free must be true.
    bool surface_collision = false;
    /// Needs surface_collision: the faces of the deformable do not meet each other either.
    bool self_collision = false;
    /// Distance that layers of the deformable keep from each other, units. If not given, the thickness. Near
    /// small faces it is less: at most 0.4 of the least height of a face, and a quarter of the mean
    /// edge, so that neighbours have room.
    std::optional<double> self_thickness{};
    /// Needs surface_collision: what begins intersecting, or inside a closed model, is parted before the
    /// first frame instead of refused, by moving particles that are not pinned; what cannot be parted is
    /// refused. Time: up to some hundred times that of looking for the pairs that intersect
    /// (intersections.hpp).
    bool untangle = false;
    /// A particle farther than this from the middle of where the deformable began ends the simulation as
    /// diverged, units. 0: 10 000 times the deformable's extent at the start.
    double bound = 0;
    /// Threads that compute a frame; 0: all cores. The bits do not depend on it. More than one wait awake
    /// while a frame lasts, and need oneTBB.
    unsigned thread_count = 1;
    /// Wind of every frame for which blow() is not called, with the numbers that blow() takes. A rate of 0:
    /// no air; then the wind must be 0, too.
    Vec3d wind{};         ///< units per second
    double wind_rate = 0; ///< per second
    /// Newton: inside the closed pieces of cloth, beyond that around them, N/m^2; constant, as that of a
    /// pump. It pushes each face outwards. Not negative.
    double pressure = 0;
};

/// A force and a torque that bear on a collider, in the world's axes.
struct Load {
    Vec3d force;  ///< N
    Vec3d torque; ///< N m, about the pose's translation, as it moves
};

/// A contact that pushed in the last frame: of a particle, an edge or a face of the deformable with a
/// collider, or of two of its own.
struct ContactPoint {
    /// In place of the number of a collider or of a particle.
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    Vec3d position;         ///< on the deformable, at the end of the frame; world coordinates
    Vec3d normal;           ///< unit, towards the deformable; towards its first part where both are its own
    double gap;             ///< at the end of the frame; positive, less than the thickness
    double normal_impulse;  ///< on the deformable (its first part) along the normal in the frame, N s
    Vec3d friction_impulse; ///< the same across the normal, N s
    std::uint32_t collider; ///< kNone: the contact is of the deformable with itself
    /// Of the first part, and then of the second one if it is the deformable's own, too: a vertex and the
    /// three of a face, or two and two of edges. kNone where there are fewer.
    std::array<std::uint32_t, 4> particles;
};

/// Times and counts of step() since the simulation began. Times are not part of the result.
struct SimulationProfile {
    double integration_seconds = 0;  ///< Jakobsen: Verlet, and the check for divergence and rest
    double constraint_seconds = 0;   ///< Newton: its steps; Jakobsen: sticks
    double collision_seconds = 0;    ///< all about contact, and moving the colliders
    std::uint64_t query_count = 0;   ///< Jakobsen: particle queries, counted per iteration and collider
    std::uint64_t contact_count = 0; ///< Newton: contacts that push, by step; Jakobsen: queries that pushed
    /// Jakobsen: queries that needed the map; beside an exact map, a particle that has hardly moved is
    /// answered from memory.
    std::uint64_t map_query_count = 0;
    /// Jakobsen: times that a particle was rescued: not free of all exact maps after the relaxations of a
    /// frame, though it was once, and put back to a free place. docs/conventions.md defines free, rescued and
    /// lost.
    std::uint64_t rescued_count = 0;
    /// Jakobsen: times that a particle was lost: it ended a frame not free of an exact map, though it was
    /// once. It counts once for each such map, and again in each frame that it ends so. A particle that began
    /// inside and was never outside yet does not count.
    std::uint64_t lost_count = 0;
    /// With surface_collision: times that a particle ended a frame, or a part of one that is divided, short
    /// of where it was going, because its edges or faces could have met something on the way.
    std::uint64_t truncated_count = 0;
    /// With surface_collision: pairs of a vertex and a face or of two edges that were measured.
    std::uint64_t measured_pair_count = 0;
    /// With surface_collision: pairs of a vertex and a face or of two edges for which no room was proven when
    /// a step began, summed over all steps: a pinned particle was led through something, or colliders left no
    /// room between them. While it is 0, no faces intersect at the end of a frame, but for rounding, which is
    /// not counted, hundreds of a collider's radii from the origin (docs/surfaces.md).
    std::uint64_t squeezed_count = 0;
};

/// Of the structural sticks, how far their lengths are from those at rest, as a share of these. 0.01 is 1 %.
/// Under Jakobsen it is what relaxations have left undone; under Newton the strain of the material is part
/// of it.
struct Residual {
    double root_mean_square = 0, largest = 0; ///< 0 without such sticks
};

/// A cut, as in a film: things are elsewhere from one frame to the next, and nothing moves on the way.
struct Teleport {
    RigidTransform motion; ///< a point p goes to motion.to_world(p); velocities turn along
    /// Indices of the colliders that go along, with their keyframes.
    std::vector<std::uint32_t> colliders{};
    /// Whether the deformable goes along, with pinned particles and the paths of handles. Colliders to which
    /// any of it is attached have to do as it does.
    bool deformable = true;
    /// Seconds after the simulation began: in the first frame that begins then or later.
    double time = 0;
};

class [[gnu::visibility("hidden")]] Solver; // src/simulation/solver.hpp

/// A deformable among colliders. The same input gives the same positions bit for bit, on every run and with
/// every instruction set and number of threads; tested on x86-64 and WebAssembly. Copies are independent.
class Simulation {
  public:
    /// Under Jakobsen allocates all that step() needs. Rotations whose quaternion is off the unit length by
    /// no more than 1e-4, as rounding to float leaves them, are brought to it.
    /// @throws Error InvalidOptions, naming what is at fault, when an option is out of range, the arrays of
    /// the deformable do not fit together, a stick or a face names a particle that does not exist, a number
    /// is not finite, or a collider has a scale of 0, a rotation that is not of unit length, a null pointer
    /// for a map, or the exact map of an open mesh without options.allow_open_colliders; with
    /// options.surface_collision also when a collider has no exact map, or the deformable begins intersecting
    /// a collider or, with options.self_collision, itself, or inside, and options.untangle is not set or
    /// could not part them: the sentence names the first pairs
    Simulation(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);
    ~Simulation();
    Simulation(const Simulation& other);
    Simulation& operator=(const Simulation& other);
    Simulation(Simulation&& other) noexcept;
    Simulation& operator=(Simulation&& other) noexcept;

    /// One frame. Newton: colliders move on along their velocities and take along what is near them; then the
    /// energy is minimised, and no step towards the minimum is longer than what keeps faces apart: no face
    /// meets a collider, or another face with options.self_collision, when a frame ends. docs/surfaces.md has
    /// the limits, most of which squeezed_count counts where they were met. A frame in which a collider
    /// moves far is divided into up to 32 steps. Memory is kept from frame to frame: a frame that needs no
    /// more than those before allocates nothing, but where maps of colliders that deform are built.
    ///
    /// Jakobsen: Verlet integration with drag, colliders that move on, then iteration_count times all sticks
    /// and collision of all particles with all colliders; at last the proof that no particle passed through
    /// an exact map. Allocates nothing.
    ///
    /// A distance map pushes along its rays (docs/paper.md), and a custom map to the points that it names,
    /// both gently: a particle that is not inside is pushed no farther than it came. An exact map pushes to
    /// the thickness over the nearest point. At the end of the frame each particle is swept from where it was
    /// free last to where it is, as the moving collider sees it. A particle that is not free is rescued: it
    /// is put before the crossing, where the same sweep finds it free, or goes back to where it was free,
    /// moved along with the collider.
    ///
    /// So no particle passes through an exact map, however fast it is or thin the model: with one exact map,
    /// near enough to the origin for floats, lost_count stays 0. The limits of that promise:
    /// - It is about particles. An edge of the model may stick out between them.
    /// - Distance maps and custom maps are not swept. Nothing is promised for them, nor for the exact map of
    ///   an open mesh.
    /// - Pinned and attached particles are left where they are held.
    /// - A particle that begins inside is pushed to the nearest surface point, and kept outside once it is
    ///   outside.
    /// - A particle that several exact maps squeeze until it cannot be placed goes to where it was last free
    ///   of the first of them, or else of the next, and counts as lost to the others.
    /// - Far from the origin, floats may be too coarse for the room around the last free place. A particle
    ///   that cannot be placed there counts as lost.
    /// @throws Error Diverged, naming the frame, and so does each further step; as teleport(); as
    /// ExactMap::build() where a vertex cache leads a collider to a surface of which no map can be built:
    /// then nothing has changed, and the simulation can go on after set_collider_cache() with another cache
    void step();

    const Deformable& deformable() const;
    std::span<const Vec3f> positions() const { return deformable().positions; }
    const std::vector<Collider>& colliders() const;
    /// As given, with the thickness in force.
    const SimulationOptions& options() const;
    /// Frames computed so far.
    std::uint32_t frame() const;
    /// Speed of the fastest particle in the last frame, units per second; infinite before the first.
    double largest_speed() const;
    /// Has the rest condition held for the required number of frames?
    bool at_rest() const;
    const SimulationProfile& profile() const;
    /// At the end of the last frame. Under Jakobsen large residuals call for more relaxations or smaller
    /// steps. Time: about a third of a relaxation of all sticks.
    Residual residual() const;
    /// XXH64 of the bits of all positions and previous positions.
    std::uint64_t state_hash() const;

    // Steering colliders. Of these four the last one called holds; each needs collider_index <
    // colliders().size().

    /// The collider keeps these velocities.
    void set_collider_velocity(std::size_t collider_index, const Vec3d& linear, const Vec3d& angular);

    /// The next frame leads the collider to this pose, evenly and the shorter way round, and leaves it there,
    /// to rounding. Particles and surfaces are kept out of it on the way as of any collider that moves, and
    /// rub against it. Until the next call it stands still.
    /// @throws Error InvalidOptions when the pose is not finite, or its rotation off the unit length by more
    /// than 1e-4
    void set_collider_pose(std::size_t collider_index, const RigidTransform& pose);

    /// The collider follows the keys: each frame leads it to where pose_at() has it at the frame's end, which
    /// is options().time_step * frame() after the simulation began. It does so from where it is, so begin it
    /// at pose_at() of the present. The simulation is not at rest before the last key. No keys: it stands
    /// still.
    /// @throws Error InvalidOptions, naming the key, when a time or a pose is not finite, a rotation not of
    /// unit length to 1e-4, or a time not later than the one before it
    void set_collider_keyframes(std::size_t collider_index, std::vector<PoseKey> keys);

    /// Newton: the collider goes on freely from its velocities, as a solid of uniform density: by gravity
    /// and, in each frame, by the load of the frame before. So it is to weigh no less than the part of the
    /// deformable that it touches, or takes smaller time steps. Other colliders do not stop it.
    /// @param mass  kg
    /// @throws Error InvalidOptions when the mass is not positive and finite, the solver is Jakobsen, or the
    /// collider has no exact map, or one of an open mesh
    void set_collider_free(std::size_t collider_index, double mass);

    /// Newton: sets colliders, the deformable or both elsewhere, at once where its time has come, else in the
    /// frame of its time. Velocities stay as they are, but for their directions; a collider that goes without
    /// the deformable takes nothing along, pushes nothing on the way, and stands where it is then. Things
    /// that go together stay to each other as they were, to rounding of positions.
    /// @throws Error InvalidOptions when the motion is not finite or its rotation off the unit length by more
    /// than 1e-4, a collider does not exist, the solver is Jakobsen, only one of a collider and what is
    /// attached to it goes, or, with options().surface_collision, the deformable would meet a collider there;
    /// the last from step() where its time comes later. Then nothing has changed, and it is forgotten
    void teleport(const Teleport& teleport);

    // Colliders that deform: their vertices move, and their faces stay the same. Each needs collider_index <
    // colliders().size(), an exact map and options().surface_collision. Surfaces are kept off the moving
    // faces as off any (docs/surfaces.md), and attached particles stay beside the face that was nearest to
    // them when the collider first deformed. Each frame that deforms it builds its exact map anew, on one
    // thread, and may allocate.

    /// The next frame leads the vertices of a collider's mesh here, each on a straight way; then they rest.
    /// The pose, which may move meanwhile, is another thing. The map is built in this call.
    /// @param vertices_local  [vertex_count] of the mesh that its exact map was built of, in its order
    /// @throws Error InvalidOptions for another number of vertices, a place that is not finite, a collider
    /// without an exact map, or without options().surface_collision; as ExactMap::build(). Then nothing has
    /// changed
    void set_collider_vertices(std::size_t collider_index, std::span<const Vec3f> vertices_local);

    /// Each frame leads the vertices to where vertices_at() has them at its end. The simulation is not at
    /// rest before the last sample.
    /// @throws Error InvalidOptions for a cache of another number of vertices, without a sample, or with
    /// times or places that are not finite; and as above
    void set_collider_cache(std::size_t collider_index, VertexCache cache);

    /// Newton: what the deformable put on a collider in the last frame by contact and friction, as its mean
    /// over the frame. Before the first frame 0, and always under Jakobsen. A host that moves a rigid body by
    /// it and then the collider by the body exchanges momentum with the deformable (examples/08_load).
    /// @pre collider_index < colliders().size()
    Load load_on(std::size_t collider_index) const;

    /// Newton: whether the frames that follow record the contacts that push. Off at the beginning; it then
    /// costs nothing. Not part of a saved state.
    void record_contacts(bool is_on);
    /// The contacts that were recorded in the last frame, in an order of their own; valid until the next
    /// frame. Their impulses divided by the time step sum to load_on() of each collider, except for the loads
    /// of attached particles and of particles that a collider stopped before contact could
    /// (SimulationProfile::truncated_count). Empty under Jakobsen.
    std::span<const ContactPoint> contact_points() const;

    /// Gives a particle a velocity, units per second, from which the next frame goes on as from any other:
    /// the material pulls at it and colliders stop it, so a hand that drags particles by setting their
    /// velocities towards itself before each frame drags none of them into a model. A pinned particle stays.
    /// @pre particle < particle_count(), and the velocity is finite
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity);

    /// Wind for the time of one frame: of the velocity with which air moves across a face, along its normal,
    /// particles take on the share rate * time_step, each as the mean over the faces around it. Air slips
    /// along faces. Call before each frame, in which it takes the place of the options' wind.
    /// @param wind  of the air, units per second; 0 is air at rest, which brakes
    /// @param rate  per second: the higher, the lighter the cloth. Not negative
    /// @pre both are finite
    void blow(const Vec3d& wind, double rate);

    // Saved states (docs/saved_states.md). Between frames.

    /// All that decides how the simulation goes on, as bytes: particles, what is known of the surfaces
    /// around them, the motion of the colliders, counts. The same state gives the same bytes. Not in it is
    /// what the simulation was made of: deformable, maps, options and vertex caches.
    /// Cost: about 100 bytes for each particle, and more where surfaces collide; about the time of a
    /// copy.
    std::vector<std::byte> save_state() const;
    /// The same in a file, which appears whole or not at all.
    /// @throws Error Unwritable
    void save_state(const std::filesystem::path& path) const;

    /// Goes back, or on, to a saved state: the frames that follow have the same bits as those that followed
    /// it. The simulation has to be made of the same deformable, colliders where they began, and options; a
    /// collider that followed a vertex cache follows the same one already. Poses, velocities and keyframes
    /// come from the state. A custom map is not compared. Times in profile() stay as they are.
    ///
    /// Bytes are checked before use, whatever they are. References and spans that this simulation gave out
    /// end.
    /// @param name  of the bytes, as errors begin
    /// @throws Error WrongFormat, UnsupportedVersion or Damaged for bytes that are no state of this version,
    /// truncated or changed; InvalidOptions for a state of another simulation, saying what differs. Then
    /// nothing has changed
    void restore_state(std::span<const std::byte> bytes, const std::string& name = "the saved state");
    /// From a file. @throws Error as above, and Unreadable; the sentence begins with the path
    void restore_state(const std::filesystem::path& path);

  private:
    std::unique_ptr<Solver> solver_;
};

} // namespace echinus

ECHINUS_EXPORT_END
