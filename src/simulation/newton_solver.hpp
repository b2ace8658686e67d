#pragma once

#include "mechanics/implicit_step.hpp"
#include "simulation/contact/surface_contacts.hpp"
#include "simulation/elastic_parts.hpp"
#include "simulation/solver.hpp"

#include <optional>

namespace echinus {

/// A continuous material in implicit steps, with contact and friction in the same energy (docs/mechanics.md).
class NewtonSolver : public Solver {
  public:
    /// @throws Error InvalidOptions
    NewtonSolver(Deformable deformable, std::vector<Collider> colliders, const SimulationOptions& options);

    std::unique_ptr<Solver> copy() const override { return std::make_unique<NewtonSolver>(*this); }
    void step() override;
    void set_particle_velocity(std::size_t particle, const Vec3d& velocity) override;
    void blow(const Vec3d& wind, double rate) override;
    Load load_on(std::size_t collider) const override;
    void record_contacts(bool is_on) override;
    std::span<const ContactPoint> contact_points() const override;
    void archive(StateArchive& state) override;

  protected:
    void set_held(std::uint32_t particle, bool is_held) override { is_held_[particle] = is_held ? 1 : 0; }
    void move_particles(const RigidTransform& motion) override;

  private:
    std::vector<double> strengths();
    std::span<FreeBody> free_bodies() { return contacts_ ? contacts_->free_bodies() : std::span<FreeBody>(); }
    void find_free_bodies();
    bool holds(std::size_t collider) const;
    RigidTransform pose_without_contact(std::size_t collider, double seconds) const;
    RigidTransform guess(const FreeBody& body, double seconds);
    void end_step_of(const FreeBody& body, double seconds);
    double time_of(float share) const { return (frame + double{share}) * options.time_step; }
    void require_ways();
    void deform();
    std::uint32_t part_count();
    void find_near_colliders();
    double most_carried();
    ScratchVector<Vec3d> own_displacements(double seconds) const;
    bool step_part(const FramePart& part);
    void find_now();
    double fastest() const;
    void choose_orders(bool is_part);
    bool find_start(const FramePart& part, bool is_least);
    ScratchVector<Vec3d> exact_start() const;
    ScratchVector<Vec3d> guess(std::span<const Vec3d> start, double seconds) const;
    bool minimise(std::span<Vec3d> places, double seconds, bool may_stop);
    bool can_be_halved(float share) const;
    void publish();
    void publish_places();

    ImplicitStep step_;
    Motion motion_;
    std::vector<std::uint8_t> is_held_;
    std::vector<Vec3d> accelerations_; ///< [particle] by gravity and wind
    /// [particle] the acceleration of the last step, after contacts; for the guess of the next.
    std::vector<Vec3d> gained_;
    std::vector<Deformation> deformations_; ///< [collider] in this frame
    /// [collider] 1 for colliders that may carry particles in this frame, or hold them.
    std::vector<std::uint8_t> is_near_;
    /// [particle] 1 for particles that may touch something in this frame.
    std::vector<std::uint8_t> may_touch_;
    std::uint8_t was_part_ = 0;          ///< whether the last step was only a part of a frame
    std::vector<std::uint32_t> held_by_; ///< [particle] the collider to which it is attached, or kNoObstacle
    /// [particle] The positions to which held particles are led, at the beginning and at the end of a step;
    /// contact may keep them from there.
    PointArrays led_, led_to_;
    PointArrays now_, start_; ///< present positions, and those at which the step begins, after carrying
    std::vector<Collider> colliders_before_; ///< at the beginning of the step
    std::vector<std::uint8_t> meets_some_;   ///< [collider] 0 for colliders that let all particles through
    std::optional<SurfaceContacts> contacts_;
    double mean_edge_; ///< of the surface
    double thickness_; ///< the effective one, which is positive
};

} // namespace echinus
