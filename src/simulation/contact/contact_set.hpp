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

/// In place of the number of an obstacle.
inline constexpr std::uint32_t kNoObstacle = 0xFFFFFFFF;

/// The parts that touch: a pair of a deformable and an obstacle, by its number.
struct ContactKey {
    std::uint32_t obstacle;
    PairKind kind;
    std::array<std::uint32_t, 4> points;
    /// That of one particle, the first of its points, lie together.
    auto order() const { return std::tie(points, kind, obstacle); }
};

/// The energy of contact and friction of pairs whose gap is linear in the places (docs/mechanics.md): a
/// barrier that grows as the gap closes (Li et al. 2020), and friction as bristles (Dahl 1968) that bend
/// elastically until Coulomb's limit and then slip. Bristles last from step to step, so what they hold does
/// not creep.
class ContactSet : public ContactEnergy {
  public:
    struct Contact {
        /// Four points of the pair, and the control points of a free collider.
        static constexpr std::size_t kMostParts = 8;

        ContactKey key;
        std::array<std::uint32_t, kMostParts> particles{};
        std::array<double, kMostParts> weights{}; ///< 0 of what is no unknown
        std::size_t part_count = 4;
        Vec3d normal;         ///< of unit length, towards positive weights
        double offset = 0;    ///< gap = offset + normal . sum of weights * place
        double thickness = 0; ///< the gap from which on it pushes
        double friction = 0;  ///< Coulomb's coefficient
        double mobility = 0;  ///< of the gap: sum of weight^2 / mass
        double yielding = 0;  ///< sum of weight^2 / the force that strains the material there by 1
    };

    /// @param obstacle_count  those that contacts name: colliders, then perhaps the deformable itself
    /// @param collider_count  of them those of which loads are kept
    ContactSet(std::size_t particle_count, std::size_t obstacle_count, std::size_t collider_count,
               double gravity);

    /// @param masses  [obstacle] of free bodies; 0 of all others @param bodies  [particle] the first one of
    /// its body
    void set_free_bodies(std::vector<double> masses, std::span<const std::uint32_t> bodies);

    /// Begins a frame of one step or more, whose loads are summed.
    void begin_frame();
    /// Sums up what its steps have recorded of each contact.
    void end_frame();
    /// Whether steps record the contacts that push.
    void record(bool is_on) { records_ = is_on; }
    /// Of the last frame. After end_frame()
    std::span<const ContactPoint> points() const { return points_; }
    /// @param frames  [obstacle] of the colliders where the step ends, in which their bristles turn along;
    /// none of what stands in the world
    void begin_step(double step, std::span<const std::optional<FrameChange>> frames);
    /// Forgets the contacts, not the bristles.
    void clear() { contacts_.clear(); }
    bool empty() const { return contacts_.empty(); }
    /// Undoes begin_step(), up to rounding of the bristles' directions. @param frames  those that it was
    /// given
    void cancel_step(std::span<const std::optional<FrameChange>> frames);
    /// @param start  the sum of weight * place where the step began, taken along with the obstacle
    /// @param gap  whose normal force limits its friction; none: that of the step before does
    void add(const Contact& contact, const Vec3d& start, std::optional<double> gap);
    /// Keeps bristles and loads of the step that ends here. @param is_touching  out: 1 where a contact pushes
    void end_step(Places places, std::span<const std::optional<FrameChange>> frames,
                  std::span<std::uint8_t> is_touching);

    /// Adds the load of a particle that is stopped by a collider, or held by it.
    /// @param force  on the particle
    void add_load(std::uint32_t collider, const Vec3d& place, const Vec3d& force,
                  const std::optional<FrameChange>& frame);

    double energy(Places places, const Workers& workers) const override;
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                         const Workers& workers) const override;

    /// Contacts that push at these places.
    std::size_t pushing_count(Places places) const;
    /// The load of the deformable on a collider in this frame, as its mean over so many seconds.
    Load load_on(std::size_t collider, double seconds) const;

    /// Between steps: turns the bristles of what stands in the world.
    void turn(std::uint32_t obstacle, const Rotation& turn);
    void archive(StateArchive& state);

  private:
    struct Held : Contact {
        double force;                        ///< of the barrier
        double stiffness, most_friction = 0; ///< of the bristle
        Vec3d slip_offset;                   ///< slip = tangential part of this + sum of weights * place
    };
    /// The forces by which the parts of a contact held each other when the step before ended.
    struct Bristle {
        ContactKey key;
        std::array<float, 4> weights{};
        Vec3d normal, friction; ///< in the obstacle's frame between steps, in the world during one
        double push = 0;        ///< the normal force when the step ended
        double force = 0;       ///< of the barrier
    };
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;
    /// The bristles around a particle that lie in about the same plane, seen from there.
    struct Patch {
        std::uint32_t obstacle, next; ///< the next one of the particle
        Vec3d normal, friction;       ///< the friction weighted, as the push
        double push = 0, force = 0, weight = 0;
    };
    struct Impulse {
        Vec3d linear, angular; ///< the moment about where the collider stood when the frame's last step ended
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
    std::vector<Bristle> bristles_;            ///< of the step before, by key
    std::vector<std::uint32_t> first_bristle_; ///< [particle count + 1] those whose first point it is
    std::vector<std::uint32_t> first_patch_;   ///< [particle] into patches_
    std::vector<Patch> patches_;               ///< in this step
    std::vector<double> free_masses_;          ///< [obstacle] none where there are no free bodies
    std::vector<std::uint32_t> bodies_;        ///< [particle] the same
    std::vector<double> borne_;     ///< [body, by its first particle] mass of the heaviest free body
                                    ///< that contacts of the last step connect with it
    std::vector<Impulse> impulses_; ///< by collider, in this frame
    /// A contact in one step of the frame.
    struct Recorded {
        ContactKey key;
        std::uint32_t number; ///< in the order of the steps
        ContactPoint point;
    };
    bool records_ = false;
    std::vector<Recorded> recorded_;
    std::vector<ContactPoint> points_;
};

} // namespace echinus
