#pragma once

#include <echinus/collider.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Surfaces outside of a simulation: their collision in your own solver (docs/own_solver.md), and the
/// separation of surfaces that already intersect, such as a garment and its body.
namespace echinus {

struct SurfaceCollisionOptions {
    double friction = 0.5;      ///< Coulomb's coefficient; 0 is no friction
    bool self_collision = true; ///< keep faces from intersecting each other, too
    /// Distance in units that layers keep from each other; by default the thickness. The distance is less
    /// near small faces.
    std::optional<double> self_thickness{};
    /// If possible, separate an initial state that intersects a model or itself, or lies inside a closed
    /// model, instead of rejecting it.
    bool untangle = false;
    unsigned thread_count = 1; ///< as in ParticleCollisionOptions
};

/// Keeps not only the particles of any solver (ParticleCollision), but also the faces between them, off
/// models and off each other. Each step goes from an intersection-free state towards the solver's positions,
/// as far as the paths are proven to be free of collisions (docs/surfaces.md). Contact and friction work as
/// with NewtonOptions, for a surface without stiffness.
///
/// After correct() no face intersects a model or, with self_collision, another face. The exceptions are those
/// of CollisionMode::Surfaces; unresolved_count() counts most of them. Only particles collide with a collider
/// that has no exact map. Contact forces begin at a distance equal to the thickness and grow as a face comes
/// closer, so the distance may be small after a hard impact. Copies are independent. Different threads may
/// use different objects at the same time, but only one thread may use an object at a time.
class SurfaceCollision {
  public:
    /// @param positions  [n] the initial positions, at which no faces may intersect (but see untangle)
    /// @param faces      the faces between the particles; at least one
    /// @param colliders  in their initial poses; their velocities are ignored, but must be finite
    /// @param thickness  the distance in units to keep from colliders, 0 to 1e9; the effective value is at
    /// least a fiftieth of the mean edge length, and at least 1e-6. Particles that begin closer are pushed
    /// off. See docs/thickness.md
    /// @throws Error InvalidOptions, naming intersecting faces if there are any; InvalidMesh if so many faces
    /// intersect that intersecting_pairs() refuses to list them
    SurfaceCollision(std::vector<Vec3f> positions, std::vector<Triangle> faces,
                     std::vector<Collider> colliders, double thickness,
                     const SurfaceCollisionOptions& options = {});
    ~SurfaceCollision();
    SurfaceCollision(const SurfaceCollision& other);
    SurfaceCollision& operator=(const SurfaceCollision& other);
    SurfaceCollision(SurfaceCollision&& other) noexcept;
    SurfaceCollision& operator=(SurfaceCollision&& other) noexcept;

    /// Moves a collider to a pose during the solver's next step, at constant velocity and rotating along the
    /// shorter arc. Then it stops.
    /// @pre collider_index < colliders().size()
    /// @throws Error InvalidOptions for a pose that is not finite, or a rotation whose length differs from 1
    /// by more than 1e-4
    void set_collider_pose(std::size_t collider_index, const RigidTransform& pose);

    /// Corrects the particles after a step of the solver, and moves the colliders. The step starts from
    /// positions(), at which the previous step ended.
    ///
    /// A particle counts as corrected if it ends farther than a thousandth of the thickness from the solver's
    /// position. For other particles the array keeps the solver's position, so only positions() is exactly
    /// free of intersections. The velocity of a corrected particle changes by the correction divided by the
    /// duration of the step, and after an impact it has no component into the surface. A particle whose
    /// position is not finite, or more than 1e12 units from the previous one, keeps its previous position as
    /// an obstacle for others, and is not corrected.
    ///
    /// The cost is that of a frame of a simulation whose surfaces collide (docs/surfaces_measured.md). The
    /// function allocates when its arrays of pairs grow.
    /// @param positions   [n] in: the solver's positions; out: corrected positions
    /// @param velocities  [n] in and out, units per second; or empty
    /// @param seconds     the duration of the step; positive
    /// @return the indices of particles whose positions were corrected, ascending; valid until the next call
    /// @throws Error InvalidOptions for arrays of the wrong size or a duration that is not positive, without
    /// changing anything; Diverged if a collider leaves all bounds, after which the object cannot be used any
    /// more
    std::span<const std::uint32_t> correct(std::span<Vec3f> positions, std::span<Vec3f> velocities,
                                           double seconds);

    /// [n] The present positions of the particles, which are free of intersections.
    const std::vector<Vec3f>& positions() const;
    const std::vector<Collider>& colliders() const;
    /// The number of unresolved pairs of elements, for which no free space was proven, summed over all steps:
    /// SimulationProfile::unresolved_count.
    std::uint64_t unresolved_count() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// ---- Surfaces that already intersect ----

struct PartOptions {
    /// The material that resists the displacements; its weight has no effect.
    ClothMaterial material{};
    /// Distance in units, above 0 and at most four mean edge lengths, from which contact pushes the surface
    /// off the models; layers off each other, too, but less near small faces. Where the material presses, the
    /// distance is less. By default a tenth of the mean edge length. The cost grows with its square.
    std::optional<double> thickness{};
    /// [vertex_count] 1 for vertices that stay where they are, otherwise 0; or empty.
    std::vector<std::uint8_t> pinned = {};
    /// [vertex_count] The layer of each vertex, a larger number farther outside; all vertices of a face are
    /// in the same one. A layer moves to the outer side of those with smaller numbers, out of all that is
    /// behind them, even if it does not intersect them; they hardly give way. The outer side is the one that
    /// faces away from the closed models on average, or without any, the one to which the normals of the
    /// faces point; neighbouring faces have to agree about it. Or empty: layers that intersect then separate
    /// to where most of each one already is.
    std::vector<std::uint8_t> layers = {};
    unsigned thread_count = 1; ///< as in SimulationOptions; the result does not depend on it
    /// Called with the completed share of the work, 0 to 1, in the thread that called part(). An exception
    /// that it throws ends the work and reaches the caller.
    std::function<void(double share)> progress = nullptr;
};

/// The surface after part(), and what still intersects.
struct Parted {
    std::vector<Vec3f> vertices;          ///< [vertex_count]
    std::vector<FacePair> own_pairs = {}; ///< pairs of faces of the surface
    /// [model_count] pairs of a face of the surface and a face of the model
    std::vector<std::vector<FacePair>> model_pairs = {};
    /// The vertices that are inside a closed model, ascending. An open model has no inside.
    std::vector<std::uint32_t> inside = {};
    double stretched_share = 0;      ///< the share of edges whose length changed by more than 5 %
    double largest_displacement = 0; ///< of a vertex, in units
    double largest_stretch = 0;      ///< the largest length of an edge over its length before, minus 1

    /// Whether nothing intersects and no vertex is inside.
    bool is_apart() const;
};

/// Moves the vertices of a surface, as little as its material permits, until no face intersects a model or
/// another face of the surface, and no vertex is inside a closed model. The method is that of
/// NewtonOptions::untangle (docs/surfaces.md), after which the material contracts in a simulation without
/// gravity, in which no face can intersect anything. Models stay where they are, and may intersect
/// themselves and each other: the surface leaves their union.
///
/// If the surface cannot be parted, for instance because it is knotted or the models leave no room, the
/// result has the fewest intersections found. A surface that neither intersects anything nor is inside a
/// model, with its layers in order, is returned as it is.
///
/// The cost is that of untangling, minutes for 10 000 vertices on a detailed model, and of up to
/// thirty frames of a simulation. The function may be called in several threads at once.
/// A pinned vertex inside a model cannot be parted, and what it holds is stretched in vain.
/// @param models  open or closed meshes; those in other frames are moved to that of the surface, where their
/// coordinates are rounded to float
/// @throws Error InvalidMesh as make_cloth() does for the surface and ExactMap::build() does for a model,
/// whose message begins with its index, and for layers whose neighbouring faces do not agree; InvalidOptions
/// for options out of range
Parted part(const TriangleMesh& surface, std::span<const TriangleMesh> models,
            const PartOptions& options = {});

} // namespace echinus

ECHINUS_EXPORT_END
