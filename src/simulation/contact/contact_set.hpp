#pragma once

#include "collider/frame_change.hpp"
#include "mechanics/implicit_step.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/surfaces/separation.hpp"

#include <echinus/simulation.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace echinus {

/// Marks the absence of an obstacle.
inline constexpr std::uint32_t kNoObstacle = 0xFFFFFFFF;

/// The parts that touch: a pair of a deformable and an obstacle, which is given by its number.
struct ContactKey {
    std::uint32_t obstacle;
    PairKind kind;
    std::array<std::uint32_t, 4> points;
    /// The order in which the keys that have the same first point are adjacent.
    auto order() const { return std::tie(points, kind, obstacle); }
};

/// The energy of contact and friction of pairs whose gap is linear in the positions (docs/mechanics.md): a
/// barrier that grows as the gap closes (Li et al. 2020), and friction as bristles (Dahl 1968) that bend
/// elastically until Coulomb's limit and then slip. Bristles last from step to step, so whatever they hold
/// does not creep.
class ContactSet : public ContactEnergy {
  public:
    struct Contact {
        /// The four points of the pair and the control points of a free collider.
        static constexpr std::size_t kMostParts = 8;

        ContactKey key;
        std::array<std::uint32_t, kMostParts> particles{};
        std::array<double, kMostParts> weights{}; ///< 0 for points that are not unknowns
        std::size_t part_count = 4;
        Vec3d normal;         ///< of unit length, towards positive weights
        double offset = 0;    ///< gap = offset + normal . (sum of weight * position)
        double thickness = 0; ///< the gap below which the contact pushes
        double friction = 0;  ///< Coulomb's coefficient
        double mobility = 0;  ///< of the gap: the sum of weight^2 / mass
        double yielding = 0;  ///< the sum of weight^2 / the force that strains the material there by 1
    };

    /// @param obstacle_count  the number of obstacles that contacts name: the colliders, then possibly the
    /// deformable itself
    /// @param collider_count  the number of colliders, whose loads are kept
    ContactSet(std::size_t particle_count, std::size_t obstacle_count, std::size_t collider_count,
               double gravity);

    /// @param masses  [obstacle] the masses of free bodies; 0 for all others @param bodies  [particle] the
    /// first particle of its body
    void set_free_bodies(std::vector<double> masses, std::span<const std::uint32_t> bodies);

    /// Begins a frame of one step or more, over which loads are summed.
    void begin_frame();
    /// Sums up the records that the steps of the frame have made of each contact.
    void end_frame();
    /// Sets whether steps record the contacts that push.
    void record(bool is_on) { records_ = is_on; }
    /// The contact points of the last frame, after end_frame().
    std::span<const ContactPoint> points() const { return points_; }
    /// @param frames  [obstacle] the frames of the colliders at the end of the step, with which their
    /// bristles turn; none for obstacles that are fixed in the world
    void begin_step(double step, std::span<const std::optional<FrameChange>> frames);
    /// Removes the contacts, but keeps the bristles.
    void clear() { contacts_.clear(); }
    bool empty() const { return contacts_.empty(); }
    /// Undoes begin_step(), up to rounding in the bristles' directions. @param frames  the same as for
    /// begin_step()
    void cancel_step(std::span<const std::optional<FrameChange>> frames);
    /// @param start  the sum of weight * position when the step began, carried along with the obstacle
    /// @param gap  its normal force limits the friction; if none, the normal force of the step before does
    void add(const Contact& contact, const Vec3d& start, std::optional<double> gap);
    /// Keeps the bristles and loads of the step, which ends at these positions. @param is_touching  out: 1 if
    /// a contact pushes the particle
    void end_step(Places places, std::span<const std::optional<FrameChange>> frames,
                  std::span<std::uint8_t> is_touching);

    /// Adds the load of a particle that a collider stops or holds.
    /// @param force  the force on the particle
    void add_load(std::uint32_t collider, const Vec3d& place, const Vec3d& force,
                  const std::optional<FrameChange>& frame);

    double energy(Places places, const Workers& workers) const override;
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const override;

    /// The number of contacts that push at these positions.
    std::size_t pushing_count(Places places) const;
    /// The load of the deformable on a collider in this frame, averaged over this time.
    Load load_on(std::size_t collider, double seconds) const;

    /// Turns the bristles of an obstacle that is fixed in the world; between steps.
    void turn(std::uint32_t obstacle, const Rotation& turn);
    void archive(StateArchive& state);

  private:
    struct Held : Contact {
        double force;                        ///< the force of the barrier
        double stiffness, most_friction = 0; ///< the stiffness and the Coulomb limit of the bristle
        Vec3d slip_offset; ///< slip = tangential part of (slip_offset + sum of weight * position)
    };
    /// The forces by which the parts of a contact held each other when the step before ended.
    struct Bristle {
        ContactKey key;
        std::array<float, 4> weights{};
        Vec3d normal, friction; ///< in the obstacle's frame between steps, in the world during one
        double push = 0;        ///< the normal force when the step ended
        double force = 0;       ///< the force of the barrier
    };
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;
    /// The bristles around a particle that lie in about the same plane as seen from the particle.
    struct Patch {
        std::uint32_t obstacle, next; ///< the next patch of the particle
        Vec3d normal, friction;       ///< the friction is weighted like the push
        double push = 0, force = 0, weight = 0;
    };
    struct Impulse {
        /// The moment is about the position of the collider at the end of the frame's last step.
        Vec3d linear, angular;
    };

    static double push_of(const Held& contact, double gap);
    const Bristle* find(const ContactKey& key) const;
    double barrier_force(const Contact& contact, const Bristle& before) const;
    Bristle remembered(const Contact& contact) const;
    void record(const Held& contact, Places places, double push, const Vec3d& friction);
    void index_bristles();
    void find_patches();
    void find_borne();
    double borne_by(const Contact& contact) const;
    Patch& patch_at(std::uint32_t particle, std::uint32_t obstacle, const Vec3d& normal);
    double gap_of(const Held& contact, Places places) const;
    Vec3d slip_of(const Held& contact, Places places) const;
    Vec3d held_slip(const Held& contact, Places places) const;
    Vec3d point_of(const Held& contact, Places places) const;

    double gravity_, step_ = 0;
    std::size_t obstacle_count_;
    std::vector<Held> contacts_;
    std::vector<Bristle> bristles_; ///< of the step before, by key
    /// [particle count + 1] those whose first point is the particle.
    std::vector<std::uint32_t> first_bristle_;
    std::vector<std::uint32_t> first_patch_; ///< [particle] an index into patches_
    std::vector<Patch> patches_;             ///< in this step
    std::vector<double> free_masses_;        ///< [obstacle] empty if there are no free bodies
    std::vector<std::uint32_t> bodies_;      ///< [particle] empty as well, or the first particle of its body
    std::vector<double> borne_;     ///< [body, by its first particle] mass of the heaviest free body that
                                    ///< contacts of the last step connect with it
    std::vector<Impulse> impulses_; ///< [collider] in this frame
    /// A contact in one step of the frame.
    struct Recorded {
        ContactKey key;
        std::uint32_t number; ///< counted in the order of the steps
        ContactPoint point;
    };
    bool records_ = false;
    std::vector<Recorded> recorded_;
    std::vector<ContactPoint> points_;
};

} // namespace echinus
