#pragma once

#include "collider/frame_change.hpp"
#include "geometry/union_find.hpp"
#include "mechanics/implicit_step.hpp"
#include "simulation/contact/pair_set.hpp"
#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace echinus {

/// Contact of a deformable's surface with models and with itself, in one room: the same pairs, planes and
/// gaps serve the energy of contact and friction and the proof that nothing meets (docs/mechanics.md).
///
/// A step goes from one safe state, in which nothing meets, to the next: pairs are measured in a safe state,
/// the solver proposes places, and advance() goes towards them as far as the planes between the pairs allow.
class SurfaceContacts : public ContactEnergy {
  public:
    /// @param masses  [particle]; infinite or of any size where a particle is held
    SurfaceContacts(const Deformable& deformable, const std::vector<Collider>& colliders,
                    std::span<const double> masses, const SimulationOptions& options);
    SurfaceContacts(const SurfaceContacts& other);
    SurfaceContacts& operator=(const SurfaceContacts&) = delete;
    ~SurfaceContacts() override;

    /// Begins a frame of one step or more, whose loads are summed.
    void begin_frame();

    /// Where a step begins into which colliders that move carry particles, so that nothing meets on the way.
    /// @param from  safe
    /// @param carried  in: where the field of the colliders carries each particle. Out: where it begins
    void carry(const std::vector<Collider>& before, const std::vector<Collider>& after,
               const PointArrays& from, PointArrays& carried, std::span<const std::uint8_t> is_held,
               const Workers& workers);

    /// Begins a step: colliders stand where it ends.
    /// @param places  safe beside the colliders as they stand then: those of the step before, carried along
    /// @param guess   where particles would go without contact
    /// @param is_held [particle]
    void begin_step(const std::vector<Collider>& colliders, const PointArrays& places, Places guess,
                    std::span<const std::uint8_t> is_held, double step, const Workers& workers);

    /// Goes from the safe state towards these places as far as is proven safe, and measures all pairs there.
    /// @param places  in: the goals. Out: where the particles are. Those that nothing stops keep all their
    /// digits
    /// @param is_solved  the goals come from the solver: contact forces there are those of the step, and
    /// limit
    ///                   friction. Those at a guess are of any size; then those of the step before do
    /// @return how many particles were stopped
    std::size_t advance(std::span<Vec3d> places, bool is_solved, const Workers& workers);

    /// The friction that this step has left in contacts stays for the next.
    void end_step(Places places);

    double energy(Places places, const Workers& workers) const override;
    void add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix& hessian,
                         const Workers& workers) const override;

    /// Contacts that push at these places.
    std::size_t pushing_count(Places places) const;
    std::size_t pair_count() const;
    /// Pairs that touched, or could not be told apart, when the last step began or ended.
    std::size_t unresolved_count() const { return unresolved_count_; }
    /// The load of the deformable on a collider in this frame, as its mean over so many seconds.
    Load load_on(std::size_t collider, double seconds) const;

    void archive(StateArchive& state);

    /// [particle] 1 for those that a contact pushes, or that were stopped in this step. After end_step()
    std::span<const std::uint8_t> touching() const { return is_touching_; }

  private:
    struct Side;
    struct Contact;
    struct Friction;
    /// Given to a collider in this frame; the moment about where it stood when the frame's last step ended.
    struct Impulse {
        Vec3d linear, angular;
    };

    Side* own_side() { return sides_.size() > collider_count_ ? sides_.back().get() : nullptr; }
    static bool carry_whole(Side& side, const PointArrays& from, const PointArrays& carried,
                            PointArrays& wanted, std::span<const std::uint8_t> is_held,
                            const Workers& workers);
    static bool join_closing(const Side& side, const PointArrays& from, const PointArrays& carried,
                             UnionFind& groups);
    static void carry_together(UnionFind& groups, const PointArrays& from, const PointArrays& wanted,
                               std::span<const std::uint8_t> is_held, PointArrays& carried);
    void list(Side& side, Places goals, const Workers& workers);
    void measure(const Workers& workers);
    void limit(const Side& side, Places goals, std::span<float> shares) const;
    void find_contacts(Places goals);
    void add_contacts(std::size_t side_number, Places goals);
    void note_load(const Contact& contact, Places places, const Vec3d& force);
    double gap_of(const Contact& contact, Places places) const;
    Vec3d slip_of(const Contact& contact, Places places) const;

    std::shared_ptr<const Elements> own_;
    std::vector<double> masses_;
    std::size_t collider_count_;
    SimulationOptions options_;
    std::vector<std::unique_ptr<Side>> sides_;
    std::vector<float> most_; ///< by vertex: the most thickness that the faces around it leave room for
    std::span<const std::uint8_t> is_held_;
    double step_ = 0;
    std::vector<Impulse> impulses_; ///< by collider
    std::size_t unresolved_count_ = 0;
    bool is_carried_ = false; ///< the pairs of the step that begins are listed in part
    bool is_solved_ = false;
    PointArrays base_;               ///< where the step began
    PointArrays safe_;               ///< the safe state
    std::vector<Vec3d> safe_places_; ///< the same, with all digits
    std::vector<Contact> contacts_;
    std::vector<Friction> friction_;        ///< of the step before, sorted
    std::vector<std::uint8_t> is_touching_; ///< [particle] in this step
};

} // namespace echinus
