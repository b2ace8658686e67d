#pragma once

#include <echinus/collider.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Collision of faces for a solver of one's own (docs/own_solver.md).
namespace echinus {

struct SurfaceCollisionOptions {
    double friction = 0.5;      ///< Coulomb's coefficient; 0 is ice
    bool self_collision = true; ///< the faces do not meet each other either
    /// Distance that layers keep from each other, units; the thickness if not given. Near small faces less.
    std::optional<double> self_thickness{};
    /// A start that intersects, or lies inside a closed model, is parted instead of refused, where it can be.
    bool untangle = false;
    unsigned thread_count = 1; ///< as in ParticleCollisionOptions
};

/// Keeps the faces that join the particles of any solver off models and off each other, not only the
/// particles (ParticleCollision). Each step goes from a state in which nothing meets towards where the solver
/// has put the particles, as far as it is proven that nothing meets on the way (docs/surfaces.md), with
/// contact and friction as in SolverKind::Newton, of a surface without stiffness.
///
/// No face meets a model, nor with self_collision another face, after any correct(); exceptions, which
/// unresolved_count() counts, are those of SimulationOptions::surface_collision. Beside a collider without an
/// exact map only particles collide. Contact begins to push at the thickness, and pushes the harder the
/// nearer: after a hard impact little of it may be left. Copies are independent. Different objects
/// may be used by different threads at a time, one object by one.
class SurfaceCollision {
  public:
    /// @param positions  [n] where the particles begin: no faces meet there, but see untangle
    /// @param faces      of those particles; at least one
    /// @param colliders  where they stand; their velocities do not count, but have to be finite
    /// @param thickness  the distance to keep from colliders, units; 0 to 1e9. It is never less than a
    ///                   fiftieth of the mean edge, and pushes off what begins nearer. docs/thickness.md
    /// @throws Error InvalidOptions, naming what intersects; InvalidMesh
    SurfaceCollision(std::vector<Vec3f> positions, std::vector<Triangle> faces,
                     std::vector<Collider> colliders, double thickness,
                     const SurfaceCollisionOptions& options = {});
    ~SurfaceCollision();
    SurfaceCollision(const SurfaceCollision& other);
    SurfaceCollision& operator=(const SurfaceCollision& other);
    SurfaceCollision(SurfaceCollision&& other) noexcept;
    SurfaceCollision& operator=(SurfaceCollision&& other) noexcept;

    /// The solver's next step leads a collider there, evenly and the shorter way round; then it rests.
    /// @pre collider_index < colliders().size()
    /// @throws Error InvalidOptions for a pose that is not finite or a rotation off unit length by over 1e-4
    void set_collider_pose(std::size_t collider_index, const RigidTransform& pose);

    /// Corrects the particles after a step of the solver, and moves the colliders. The step began where the
    /// last one ended, positions().
    ///
    /// A particle is corrected that ends farther than a thousandth of the thickness from where the solver has
    /// put it; others keep their bits there, so that only positions() is free of intersections to the bit.
    /// Its velocity gets the same change, and at an impact nothing of it leads into the surface. A particle
    /// whose position is not finite, or farther than 1e12 units from where it was, stays there for others to
    /// meet, and is not corrected.
    ///
    /// Cost: a frame of a simulation with surface_collision (docs/surfaces_measured.md). Allocates while its
    /// arrays of pairs grow.
    /// @param positions   [n] in: where the solver has put the particles. Out: corrected
    /// @param velocities  [n] in and out, units per second; or none
    /// @param seconds     that the step took; positive
    /// @return the particles whose positions were corrected, ascending; until the next call
    /// @throws Error InvalidOptions for arrays of other sizes and a time that is not positive; then nothing
    /// has changed. Diverged where a collider leaves all bounds; then the object is of no more use
    std::span<const std::uint32_t> correct(std::span<Vec3f> positions, std::span<Vec3f> velocities,
                                           double seconds);

    /// [n] Where the particles are: nothing meets there.
    const std::vector<Vec3f>& positions() const;
    const std::vector<Collider>& colliders() const;
    /// Pairs of parts of faces for which no room was proven, summed over all steps: SimulationProfile::
    /// squeezed_count.
    std::uint64_t unresolved_count() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace echinus

ECHINUS_EXPORT_END
