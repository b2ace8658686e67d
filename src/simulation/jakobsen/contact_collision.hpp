#pragma once

#include "simulation/jakobsen/collision.hpp"
#include "simulation/jakobsen/contact_response.hpp"
#include "simulation/jakobsen/material_motion.hpp"

#include <vector>

namespace echinus {

/// Collision with a distance map or a custom map: every relaxation queries the contact of every particle.
class ContactCollision final : public Collision {
  public:
    ContactCollision(const Collider& collider, const Particles& particles,
                     std::span<const std::uint8_t> passes, const SimulationOptions& options);
    std::unique_ptr<Collision> clone() const override { return std::make_unique<ContactCollision>(*this); }

    void set_friction(double friction) override { rules_.friction = static_cast<float>(friction); }
    void begin_frame(const Collider& collider, const RigidTransform& previous_pose) override;
    void relax(Particles& particles, SimulationProfile& profile, const Workers& workers) override;
    Vec3d without_approach(std::size_t i, const Particles& particles, const Vec3d& motion) const override;

  private:
    std::size_t relax_piece(std::size_t begin, Particles& particles);

    Collider collider_;
    MaterialMotion material_;
    ResponseRules rules_;
    std::vector<std::uint8_t> passes_; ///< [particle] 1 if the collider lets it through; or empty
    float reach_;                      ///< the distance outside within which a particle has a contact
    std::vector<Vec3f> places_;        ///< of a piece of the particles
    std::vector<Contact> contacts_;    ///< the contacts of places_
};

} // namespace echinus
