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

/// Contact of a deformable's surface with models and with itself, treated together: the same pairs, planes
/// and gaps serve the energy of contact and friction and the proof that nothing meets (docs/mechanics.md).
/// The control points of free bodies are particles, too, which come after those of the deformable.
///
/// A step goes from one safe state, in which nothing meets, to the next: pairs are measured in a safe state,
/// the solver proposes positions, and advance() goes towards them as far as the planes between the pairs
/// allow.
class SurfaceContacts {
  public:
    /// @param masses  [particle]; of held particles infinite or arbitrary
    /// @param strengths  [particle] the force that strains the material around it by 1
    /// @param bodies  [particle] the first particle of its body
    /// @param options  with a positive thickness
    SurfaceContacts(const Deformable& deformable, const std::vector<Collider>& colliders,
                    std::span<const double> masses, std::span<const double> strengths,
                    std::span<const std::uint32_t> bodies, const SimulationOptions& options);

    /// From the next step on, these colliders are unknowns. @param masses, bodies  of all particles
    void set_free_bodies(std::vector<FreeBody> free_bodies, std::span<const double> masses,
                         std::span<const std::uint32_t> bodies);
    std::span<FreeBody> free_bodies() { return free_bodies_; }

    /// Begins a frame of one step or more, over which loads are summed.
    void begin_frame();
    void end_frame() { contacts_.end_frame(); }
    /// See ContactSet.
    void record(bool is_on) { contacts_.record(is_on); }
    std::span<const ContactPoint> points() const { return contacts_.points(); }
    /// Sets the vertices of a collider, in its body frame.
    void place_obstacle(std::size_t collider, std::span<const Vec3f> vertices);

    /// Finds positions at which a step can begin after moving colliders carry particles and holds lead held
    /// ones, so that nothing meets on the way. Held particles yield only if nothing else can.
    /// @param deformations  [collider] of the frame that contains the step
    /// @param from  safe positions
    /// @param carried  in: where the field of the colliders carries each particle, or its hold leads it. Out:
    /// where it begins the step
    /// @param in_any_case  carries particles even if some pairs then meet, which are counted. Held particles
    /// yield like all others
    /// @return whether particles were carried; otherwise nothing has changed
    bool carry(const std::vector<Collider>& before, const std::vector<Collider>& after,
               std::span<const Deformation> deformations, const FramePart& part, const PointArrays& from,
               PointArrays& carried, std::span<const std::uint8_t> is_held, bool in_any_case,
               const Workers& workers);

    /// The largest distance by which displacements to these positions would close pairs beyond their gaps.
    /// Colliders stay where they are, except free bodies, which go to their goals.
    /// @param may_touch  [particle] out: 1 for particles that contacts may push there
    double overlap_ahead(const std::vector<Collider>& colliders, const PointArrays& from, Places guess,
                         std::span<std::uint8_t> may_touch, const Workers& workers);

    /// Begins a step.
    /// @param colliders  where the step ends
    /// @param places  safe positions for these colliders: those of the step before, carried along
    /// @param guess   where particles would go without contact
    /// @param is_held [particle]
    void begin_step(const std::vector<Collider>& colliders, const PointArrays& places, Places guess,
                    std::span<const std::uint8_t> is_held, double step, const Workers& workers);
    /// Contact of particles with colliders without faces, in the step that begins.
    ParticleContacts& particles() { return particles_; }
    /// The energy of the step, with the contacts as they were measured last.
    using StepEnergy = std::function<double(Places)>;
    /// Goes from the safe state towards these positions as far as is proven safe and does not raise the
    /// energy.
    /// @param places  in: the goals, which the solver has found with these contacts. Out: the positions
    /// reached. Particles that nothing stops keep all digits
    /// @return how many particles and free bodies were stopped
    std::size_t advance(std::span<Vec3d> places, const StepEnergy& energy, const Workers& workers);
    /// Measures the contacts again in the safe state that advance() has reached, for the next proposal. After
    /// the last proposal they are not measured again: the solver has balanced these contacts, so their loads
    /// and friction are consistent.
    void renew();

    /// Puts particles outside of colliders without faces, as far as those with faces allow.
    void put_outside(std::span<Vec3d> places, const StepEnergy& energy, const Workers& workers);

    /// Did a collider stop a particle in the last advance()?
    bool stops() const;
    /// Adds the loads of particles that colliders stopped then, or hold. @param forces  [particle] the
    /// stopping or holding force
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
    /// Ends the step. Friction remains in the contacts for the next step.
    void end_step(Places places);

    /// The energy of contacts and friction, for the pairs as measured last.
    const ContactEnergy& energy() const { return contacts_; }
    /// Whether anything is near enough to touch.
    bool has_contacts() const { return !contacts_.empty(); }

    std::size_t pushing_count(Places places) const { return contacts_.pushing_count(places); }
    std::size_t pair_count() const;
    /// The number of pairs that touched, or could not be kept apart, when a step of this frame began.
    std::size_t unresolved_count() const { return unresolved_count_; }
    Load load_on(std::size_t collider, double seconds) const { return contacts_.load_on(collider, seconds); }
    /// [particle] 1 for particles that a contact pushed or that were stopped in this step. After end_step()
    std::span<const std::uint8_t> touching() const { return is_touching_; }

    /// The deformable has been moved and turned.
    void turn_own(const Rotation& turn) { contacts_.turn(static_cast<std::uint32_t>(collider_count_), turn); }

    void archive(StateArchive& state);

  private:
    void set_safe(const PointArrays& places);
    Vec3d slip_start(const ContactSide& side, const Pair& pair, const std::array<double, 4>& shares) const;
    bool find_ends(std::span<Vec3d> places, const PushRules& rules, const Workers& workers);
    bool meets_what_cannot_yield(const SafeDisplacements& displacements);
    FreeBody* free_body_of(std::uint32_t collider);
    void head_for(std::span<Vec3d> goals);
    void arrive_at(Places places);
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
    void add_contact(const ContactSide& side, const Pair& pair, float proven_gap, Places goals,
                     bool is_solved);
    ContactSet::Contact contact_along(const Vec3d& normal, double gap, const ContactSide& side,
                                      const Pair& pair, const std::array<double, 4>& weights) const;
    float thickness_of(const ContactSide& side, const Pair& pair) const;

    std::shared_ptr<const Elements> own_;
    std::vector<double> masses_, strengths_;
    std::vector<std::uint32_t> bodies_; ///< [particle]
    std::size_t collider_count_;
    std::vector<ContactSide> sides_; ///< for the colliders, then for the surface itself
    std::vector<FreeBody> free_bodies_;
    ParticleContacts particles_;
    ContactSet contacts_;
    std::vector<float> most_; ///< [vertex] the largest thickness for which its neighbourhood leaves room
    std::vector<std::optional<FrameChange>> frames_; ///< [obstacle]
    std::span<const std::uint8_t> is_held_;
    bool has_moved_ = false; ///< in this step
    bool is_begun_ = false;  ///< whether a step has begun in which no particle has moved yet
    float most_missed_ = 0;
    double missed_ = 0;                     ///< the largest distance of a particle from its goal
    std::size_t unresolved_ = 0;            ///< of the displacements examined last
    std::size_t unresolved_count_ = 0;      ///< in this frame
    PointArrays start_;                     ///< where the step began, before anything was carried
    bool is_carried_ = false;               ///< in this step
    PointArrays safe_;                      ///< the safe state
    std::vector<Vec3d> safe_places_;        ///< the same in double precision
    std::vector<Vec3d> goals_;              ///< of the last advance()
    std::vector<std::uint8_t> is_touching_; ///< [particle] in this step
    /// [particle] the side that stopped it in the last advance(), or kNoObstacle.
    std::vector<std::uint32_t> stopped_by_;
};

} // namespace echinus
