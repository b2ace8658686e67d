#pragma once

#include <echinus/collider.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Collision of particles for your own solver (examples/11_own_solver, docs/own_solver.md).
namespace echinus {

struct ParticleCollisionOptions {
    /// Coulomb's coefficient; 0 is no friction. The tangential motion is reduced by the coefficient times the
    /// length of the push-out, but at most to 0.
    double friction = 0.5;
    /// Accept exact maps of open meshes. Nothing is guaranteed for them: near a hole the inside is only
    /// estimated, so particles may get in there.
    bool allow_open_colliders = false;
    /// The number of threads that share the work of correct(); 0 means all cores. The results are
    /// bit-identical for any number. More than one thread needs oneTBB; waiting threads spin during a call.
    unsigned thread_count = 1;
};

/// The particles of a solver after one of its steps, in world units and axes. The arrays must not overlap.
struct SolverStep {
    std::span<const Vec3f> previous_positions; ///< [n] positions at the start of the step
    std::span<Vec3f> positions;                ///< [n] in: the solver's positions; out: corrected positions
    std::span<Vec3f> velocities{};             ///< [n] in and out: velocities, units per second; or empty
    /// [n] 1 / mass, in any unit; 0 for a pinned particle, which no collider pushes. If empty, all particles
    /// are pushed.
    std::span<const float> inverse_masses{};
};

/// Keeps the particles of any solver out of models. After each step of the solver, correct() moves particles
/// that entered or crossed a model back out; the solver does everything else.
///
///     ParticleCollision collision({{.map = map}}, 0.01);
///     for (;;) {
///         previous = positions;
///         my_solver_step(positions, velocities, seconds);
///         collision.set_collider_pose(0, where_it_is_now);
///         collision.correct({previous, positions, velocities}, seconds);
///     }
///
/// With exact maps, a particle that begins a step outside ends it outside and on the same side of every
/// surface, however fast it or the models move and however thin they are: it is swept from its position at
/// the start of the step in the frame of each collider, which moves from its previous pose to its present one
/// (see sweep() of a Collider). The exceptions, which lost_count() counts, are particles between colliders
/// that leave less room than the thickness, and particles near holes of open meshes. A particle that begins
/// inside is moved to the nearest surface point. With distance maps and custom maps, particles are not swept,
/// but pushed out if they end a step inside.
///
/// Between steps the object remembers the last free position of each particle and the surfaces around it, so
/// that a particle that hardly moves needs no query. Copies are independent. Different threads may use
/// different objects at the same time, but only one thread may use an object at a time.
class ParticleCollision {
  public:
    /// A particle counts as exploded if its position is not finite, or is farther than this many units from
    /// the origin along an axis.
    static constexpr float kFarthest = 1e12F;

    /// @param colliders  colliders with any kind of map, in their initial poses; their velocities are
    /// ignored, but must be finite
    /// @param thickness  the distance in units that particles keep from the surface, 0 to 1e9; the effective
    ///                   value is at least 16 steps of the map's lattice, each 2^-19 of the map's radius. A
    ///                   particle that is swept to a surface may be closer until the next step. See
    ///                   docs/thickness.md
    /// @throws Error InvalidOptions
    ParticleCollision(std::vector<Collider> colliders, double thickness,
                      const ParticleCollisionOptions& options = {});
    ~ParticleCollision();
    ParticleCollision(const ParticleCollision& other);
    ParticleCollision& operator=(const ParticleCollision& other);
    ParticleCollision(ParticleCollision&& other) noexcept;
    ParticleCollision& operator=(ParticleCollision&& other) noexcept;

    /// Moves a collider to a pose during the solver's next step, at constant velocity and rotating along the
    /// shorter arc. Then it stops.
    /// @pre collider_index < colliders().size()
    /// @throws Error InvalidOptions for a pose that is not finite, or a rotation whose length differs from 1
    /// by more than 1e-4
    void set_collider_pose(std::size_t collider_index, const RigidTransform& pose);
    /// Places a collider at a pose at once, as after a cut in a film: nothing is swept in between, and
    /// collision starts afresh in the next step. Preconditions and errors are those of set_collider_pose().
    void place_collider(std::size_t collider_index, const RigidTransform& pose);

    /// Sets the friction of one collider, in place of the friction in the options.
    /// @pre collider_index < colliders().size()
    /// @throws Error InvalidOptions for a friction out of range
    void set_collider_friction(std::size_t collider_index, double friction);

    /// Corrects the particles after a step of the solver, and moves the colliders.
    ///
    /// A particle closer to a surface than the thickness is moved out along the normal, and friction reduces
    /// its motion along the surface. Its velocity changes accordingly: relative to the moving material of the
    /// collider it then has no component into the surface, so particles do not bounce. Velocities are those
    /// at the end of the step; a solver without velocities may pass (position - previous) / seconds.
    ///
    /// A particle whose position has exploded is not changed and collides with nothing; one whose previous
    /// position has exploded starts at its present position. A velocity that is not finite is not changed. If
    /// a particle's previous position differs from its position at the end of the last step, because the
    /// solver has moved the particle, its collision starts afresh. If the number of particles changes,
    /// collision starts afresh for all.
    ///
    /// The cost is O(n) for n particles and each collider whose bounding sphere they may touch: about 20 ns
    /// for a particle away from surfaces, and less than 1 us for a particle that moves along them
    /// (docs/own_solver.md). The function allocates only in the first step, when the number of particles
    /// changes, after place_collider(), and in a thread's first batches (docs/conventions.md).
    /// @param seconds  the duration of the step; positive
    /// @return the indices of particles whose positions were corrected, ascending; valid until the next call
    /// @throws Error InvalidOptions for arrays of different sizes, an inverse mass that is negative or not
    /// finite, or a duration that is not positive; if it throws, nothing has changed
    std::span<const std::uint32_t> correct(const SolverStep& step, double seconds);

    /// The colliders in their present poses.
    const std::vector<Collider>& colliders() const;
    /// The number of times that a particle ended a step inside an exact map of which it had once been
    /// outside, or on the other side of its surface.
    std::uint64_t lost_count() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace echinus

ECHINUS_EXPORT_END
