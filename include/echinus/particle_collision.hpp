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

/// Collision for a solver of one's own (examples/11_own_solver, docs/own_solver.md).
namespace echinus {

struct ParticleCollisionOptions {
    /// Coulomb's coefficient; 0 is ice. Motion along a surface is shortened by this times the length of the
    /// push out of it, and never reversed.
    double friction = 0.5;
    /// Accept exact maps of open meshes. Nothing is promised for them: near a gap it is only estimated what
    /// is inside, so particles get in there.
    bool allow_open_colliders = false;
    /// Threads that share a correct(); 0: all cores. The bits do not depend on it. More than one wait awake
    /// while a call lasts, and need oneTBB.
    unsigned thread_count = 1;
};

/// The particles of a solver after one of its steps, in world units and axes. None of the arrays overlap.
struct SolverStep {
    std::span<const Vec3f> previous_positions; ///< [n] where the step began
    std::span<Vec3f> positions;                ///< [n] in: where the solver has put them. Out: corrected
    std::span<Vec3f> velocities{};             ///< [n] in and out, units per second; or none
    /// [n] 1 / mass, in any unit; 0 for a pinned particle, which no collider pushes. None: all are pushed.
    std::span<const float> inverse_masses{};
};

/// Keeps the particles of any solver out of models. After each step of the solver, correct() takes back what
/// led a particle inside or through a model, and leaves the solver all else.
///
///     ParticleCollision collision({{.map = map}}, 0.01);
///     for (;;) {
///         previous = positions;
///         my_solver_step(positions, velocities, seconds);
///         collision.set_collider_pose(0, where_it_is_now);
///         collision.correct({previous, positions, velocities}, seconds);
///     }
///
/// Between exact maps a particle that began a step outside ends it outside and on its side of every surface,
/// however fast it or the models moved and however thin they are: it is swept from where the step began, as
/// seen from each collider, which goes evenly from its pose before to its pose now (Collider's sweep()).
/// Exceptions, which lost_count() counts, are particles between colliders that leave them less room than the
/// thickness, and gaps of open meshes. A particle that begins inside is put to the nearest surface point.
/// Distance maps and custom maps are not swept: they push out what ended inside.
///
/// Between steps it keeps what it knows of the surfaces around each particle, so that those that hardly move
/// need no query; this is a cache, and where each particle was free last. Copies are independent. Different
/// objects may be used by different threads at a time, one object by one.
class ParticleCollision {
  public:
    /// A particle whose position is not finite, or farther than this from the origin along an axis, has
    /// exploded, units.
    static constexpr float kFarthest = 1e12F;

    /// @param colliders  of any kind of map, where they stand; their velocities do not count, but have to be
    /// finite
    /// @param thickness  the distance that particles keep from the surface, units; 0 to 1e9. At least 16
    ///                   steps of a map's lattice (2^-19 of its radius) are kept. A particle that is swept
    ///                   to a surface may be nearer until the next step. docs/thickness.md
    /// @throws Error InvalidOptions
    ParticleCollision(std::vector<Collider> colliders, double thickness,
                      const ParticleCollisionOptions& options = {});
    ~ParticleCollision();
    ParticleCollision(const ParticleCollision& other);
    ParticleCollision& operator=(const ParticleCollision& other);
    ParticleCollision(ParticleCollision&& other) noexcept;
    ParticleCollision& operator=(ParticleCollision&& other) noexcept;

    /// The solver's next step leads a collider there, evenly and the shorter way round; then it rests.
    /// @pre collider_index < colliders().size()
    /// @throws Error InvalidOptions for a pose that is not finite or a rotation off unit length by over 1e-4
    void set_collider_pose(std::size_t collider_index, const RigidTransform& pose);
    /// The collider is there from now on, as after a cut in a film: nothing is swept on the way, and the next
    /// step begins anew. The same otherwise.
    void place_collider(std::size_t collider_index, const RigidTransform& pose);

    /// Of one collider, in place of the options' friction. The same otherwise.
    /// @throws Error InvalidOptions for a friction out of range
    void set_collider_friction(std::size_t collider_index, double friction);

    /// Corrects the particles after a step of the solver, and moves the colliders.
    ///
    /// A position is corrected where a particle comes nearer to a surface than the thickness: out along the
    /// normal, and back along the surface by friction. Its velocity gets the same change, and then nothing of
    /// it leads into the surface, relative to its material, which a collider carries along; impacts do not
    /// bounce. Velocities are those at the end of the step; without them, (position - previous) / seconds is
    /// the solver's to take.
    ///
    /// A particle whose position has exploded is left as it is and meets nothing; one whose previous position
    /// has begins where it is now. A velocity that is not finite is left so. A particle that does not begin
    /// where the last step ended (the solver has put it elsewhere) begins anew there; with another number of
    /// particles all do.
    ///
    /// Cost: O(n) for each collider that particles may be near, by bounding spheres; 20 ns a particle away
    /// from surfaces and below 1 us for one that moves along them (docs/own_solver.md). Allocates in the
    /// first step, with another number of particles and after place_collider(), else nothing.
    /// @param seconds  that the step took; positive
    /// @return the particles whose positions were corrected, ascending; until the next call
    /// @throws Error InvalidOptions for arrays of different sizes, an inverse mass that is negative or not
    /// finite, or a time that is not positive; then nothing has changed
    std::span<const std::uint32_t> correct(const SolverStep& step, double seconds);

    /// Where they stand.
    const std::vector<Collider>& colliders() const;
    /// How often a particle has ended a step inside an exact map, or on the other side of its surface, though
    /// it was once outside.
    std::uint64_t lost_count() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace echinus

ECHINUS_EXPORT_END
