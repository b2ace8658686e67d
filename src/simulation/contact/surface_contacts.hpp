#pragma once

#include "simulation/contact/carry_field.hpp"
#include "simulation/contact/contact_set.hpp"
#include "simulation/contact/contact_side.hpp"
#include "simulation/contact/free_body.hpp"
#include "simulation/contact/particle_contacts.hpp"
#include "simulation/contact/safe_displacements.hpp"
#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// Contact of a deformable's surface with models and with itself, in one room: the same pairs, planes and
/// gaps serve the energy of contact and friction and the proof that nothing meets (docs/mechanics.md). The
/// control points of free bodies are particles, too, which come after those of the deformable.
///
/// A step goes from one safe state, in which nothing meets, to the next: pairs are measured in a safe state,
/// the solver proposes places, and advance() goes towards them as far as the planes between the pairs allow.
class SurfaceContacts {
  public:
    /// @param masses  [particle]; infinite or of any size where a particle is held
    /// @param strengths  [particle] the force that strains the material around it by 1
    /// @param bodies  [particle] the first one of its body
    /// @param options  with a positive thickness
    SurfaceContacts(const Deformable& deformable, const std::vector<Collider>& colliders,
                    std::span<const double> masses, std::span<const double> strengths,
                    std::span<const std::uint32_t> bodies, const SimulationOptions& options);

    /// From the next step on these colliders are unknowns of it. @param masses, bodies  of all particles
    void set_free_bodies(std::vector<FreeBody> free_bodies, std::span<const double> masses,
                         std::span<const std::uint32_t> bodies);
    std::span<FreeBody> free_bodies() { return free_bodies_; }

    /// Begins a frame of one step or more, whose loads are summed.
    void begin_frame();
    void end_frame() { contacts_.end_frame(); }
    /// As those of ContactSet.
    void record(bool is_on) { contacts_.record(is_on); }
    std::span<const ContactPoint> points() const { return contacts_.points(); }
    /// A collider's vertices stand there, in its body frame.
    void place_obstacle(std::size_t collider, std::span<const Vec3f> vertices);

    /// Where a step begins into which colliders that move carry particles, and what leads those that are
    /// held, so that nothing meets on the way. What is held yields where nothing else can.
    /// @param deformations  [collider] in the frame of which the step is a part
    /// @param from  safe
    /// @param carried  in: where the field of the colliders carries each particle, or its hold leads it. Out:
    /// where it begins
    /// @param in_any_case  carries them even where something meets then, which is counted. What is held
    /// yields like all others
    /// @return whether they were carried; else nothing has changed
    bool carry(const std::vector<Collider>& before, const std::vector<Collider>& after,
               std::span<const Deformation> deformations, const FramePart& part, const PointArrays& from,
               PointArrays& carried, std::span<const std::uint8_t> is_held, bool in_any_case,
               const Workers& workers);

    /// By how much displacements to these places would close pairs beyond their gaps, at most; length.
    /// Colliders stand where they are, but free bodies, which go to their goals.
    /// @param may_touch  [particle] out: 1 for those that contacts may push there
    double overlap_ahead(const std::vector<Collider>& colliders, const PointArrays& from, Places guess,
                         std::span<std::uint8_t> may_touch, const Workers& workers);

    /// Begins a step: colliders stand where it ends.
    /// @param places  safe beside the colliders as they stand then: those of the step before, carried along
    /// @param guess   where particles would go without contact
    /// @param is_held [particle]
    void begin_step(const std::vector<Collider>& colliders, const PointArrays& places, Places guess,
                    std::span<const std::uint8_t> is_held, double step, const Workers& workers);
    /// Contact of particles with colliders without faces, in the step that begins.
    ParticleContacts& particles() { return particles_; }
    /// Of the step, with the contacts that were measured last.
    using StepEnergy = std::function<double(Places)>;
    /// Goes from the safe state towards these places as far as is proven safe and raises the energy nowhere.
    /// @param places  in: the goals, which the solver has found with these contacts. Out: where the particles
    /// are. Those that nothing stops keep all their digits
    /// @return how many particles were stopped
    std::size_t advance(std::span<Vec3d> places, const StepEnergy& energy, const Workers& workers);
    /// Measures the contacts anew at the safe state that advance() has reached, for the next proposal. After
    /// the last one they stay those with which the solver has found it: they are in balance, so loads and
    /// friction are.
    void renew();

    /// Puts particles outside of colliders without faces, as far as those with faces allow.
    void put_outside(std::span<Vec3d> places, const StepEnergy& energy, const Workers& workers);

    /// Did a collider stop a particle in the last advance()?
    bool stops() const;
    /// Loads of what colliders stopped then, or hold. @param forces  [particle] by which
    /// @param held_by  [particle] the collider that holds it, or kNoObstacle
    void add_loads(Places places, std::span<const Vec3d> forces, std::span<const std::uint32_t> held_by,
                   const Workers& workers);
    /// Has any particle or free body moved in this step?
    bool has_moved() const { return has_moved_; }
    /// Undoes the beginning of this step. @param unresolved_count  as it was before
    void cancel_step(std::size_t unresolved_count) {
        contacts_.cancel_step(frames_);
        unresolved_count_ = unresolved_count;
    }
    /// The friction that this step has left in contacts stays for the next.
    void end_step(Places places);

    /// Of contacts and friction, as pairs were measured last.
    const ContactEnergy& energy() const { return contacts_; }
    /// Is anything near enough to touch?
    bool has_contacts() const { return !contacts_.empty(); }

    std::size_t pushing_count(Places places) const { return contacts_.pushing_count(places); }
    std::size_t pair_count() const;
    /// Pairs that touched, or could not be told apart, when a step of this frame began.
    std::size_t unresolved_count() const { return unresolved_count_; }
    Load load_on(std::size_t collider, double seconds) const { return contacts_.load_on(collider, seconds); }
    /// [particle] 1 for those that a contact pushes, or that were stopped in this step. After end_step()
    std::span<const std::uint8_t> touching() const { return is_touching_; }

    /// The deformable is elsewhere, turned.
    void turn_own(const Rotation& turn) { contacts_.turn(static_cast<std::uint32_t>(collider_count_), turn); }

    void archive(StateArchive& state);

  private:
    void set_safe(const PointArrays& places);
    Vec3d slip_start(const ContactSide& side, const Pair& pair, const std::array<double, 4>& shares) const;
    bool find_ends(std::span<Vec3d> places, const PushRules& rules, const Workers& workers);
    bool meets_what_cannot_yield(const SafeDisplacements& displacements);
    FreeBody* free_body_of(std::uint32_t collider);
    void head_for(std::span<Vec3d> goals);
    void arrive();
    struct Stopped {
        std::size_t count = 0;
        bool is_any_new = false;
    };
    Stopped mark_stopped(Places goals, Places ends, std::span<std::uint8_t> is_stopped,
                         const Workers& workers);
    std::size_t advance_further(std::span<Vec3d> places, const StepEnergy& energy, const Workers& workers);
    std::size_t go_towards(std::span<Vec3d> places, const StepEnergy& energy, const Workers& workers);
    void find_contacts(Places goals, bool is_solved);
    void add_contacts(const ContactSide& side, Places goals, bool is_solved);
    float thickness_of(const ContactSide& side, const Pair& pair) const;

    std::shared_ptr<const Elements> own_;
    std::vector<double> masses_, strengths_;
    std::vector<std::uint32_t> bodies_; ///< [particle]
    std::size_t collider_count_;
    std::vector<ContactSide> sides_; ///< of the colliders, then of itself
    std::vector<FreeBody> free_bodies_;
    ParticleContacts particles_;
    ContactSet contacts_;
    std::vector<float> most_; ///< by vertex: the most thickness that what is around it leaves room for
    std::vector<std::optional<FrameChange>> frames_; ///< by side
    std::span<const std::uint8_t> is_held_;
    bool has_moved_ = false; ///< in this step
    bool is_begun_ = false;  ///< has a step begun in which no particle has moved yet?
    float most_missed_ = 0;
    double missed_ = 0;                     ///< how far a particle has ended from its goal, at most
    std::size_t unresolved_ = 0;            ///< of the displacements that were looked at last
    std::size_t unresolved_count_ = 0;      ///< in this frame
    PointArrays start_;                     ///< where the step began, before anything was carried
    bool is_carried_ = false;               ///< in this step
    PointArrays safe_;                      ///< the safe state
    std::vector<Vec3d> safe_places_;        ///< the same, with all digits
    std::vector<Vec3d> goals_;              ///< of the last advance()
    std::vector<std::uint8_t> is_touching_; ///< [particle] in this step
    std::vector<std::uint32_t>
        stopped_by_; ///< [particle] the side that stopped it in the last advance(), or kNoObstacle
};

} // namespace echinus
