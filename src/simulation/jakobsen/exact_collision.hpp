#pragma once

#include "simulation/jakobsen/collider_now.hpp"
#include "simulation/jakobsen/collision.hpp"
#include "simulation/jakobsen/free_places.hpp"
#include "simulation/jakobsen/known_contacts.hpp"
#include "simulation/jakobsen/swept_particle.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Collision with an exact map.
///
/// In the relaxations, the map is queried for a particle's nearest point only if the particle has moved so
/// far since the last answer that a different one is possible (KnownContacts). Such particles are queried
/// together.
///
/// The proof (SweptParticle) follows the relaxations. Most particles are proven free by what is already
/// known; the others are swept.
class ExactCollision final : public Collision {
  public:
    /// Particles that are outside at the start are free.
    ExactCollision(const Collider& collider, const Particles& particles, std::span<const std::uint8_t> passes,
                   const SimulationOptions& options);
    std::unique_ptr<Collision> clone() const override { return std::make_unique<ExactCollision>(*this); }

    void restart(std::span<const std::uint32_t> restarted, const Particles& particles) override;
    void set_friction(double friction) override { options_.friction = friction; }
    void begin_frame(const Collider& collider, const RigidTransform& previous_pose) override;
    /// In the collider's frame, each particle moves straight from one box to the other.
    bool is_away(const AlignedBox<double>& starts, const AlignedBox<double>& ends) const override;
    /// Pushes particles to the thickness over the nearest point, with friction.
    void relax(Particles& particles, SimulationProfile& profile, const Workers& workers) override;

    /// Uses the plane to which the particle was pushed.
    Vec3d without_approach(std::size_t i, const Particles& particles, const Vec3d& motion) const override;

    std::span<const std::uint32_t> find_unproven(const Particles& particles) override;
    bool is_unproven(std::size_t i, const Particles& particles) const override;
    bool is_lost(std::size_t i, const Particles& particles) const override;
    void rescue(std::size_t i, Particles& particles) const override;
    void take_back(std::size_t i, Particles& particles) const override;
    bool mark_lost(std::size_t i) override { return free_places_.mark_lost(i); }
    void end_frame(const Particles& particles) override;

    void archive(StateArchive& state, const Collider& collider) override;

  private:
    /// The particles that a thread relaxes at once.
    struct Piece {
        ParticleList to_ask;
        std::uint64_t contact_count = 0, map_query_count = 0;
    };

    void follow();
    void relax(std::size_t first, std::size_t end, Particles& particles, Piece& piece);
    void ask(Particles& particles, Piece& piece);
    bool meet_on_the_way(std::size_t i, const Particles& particles, Piece& piece);
    float reach_of(std::size_t i, const Particles& particles) const;
    void remember(std::size_t i, const Vec3f& position, const Contact& nearest, float reach);
    void ask_for_nearest(std::span<const std::uint32_t> asked, std::span<const Vec3f> places_local,
                         float reach, Particles& particles, Piece& piece);
    SweptParticle swept(std::size_t i, const Particles& particles) const {
        return {now_, free_places_, i, particles};
    }

    SimulationOptions options_;
    ColliderNow now_;
    RigidTransform pose_, frame_start_pose_;
    RigidTransform known_pose_; ///< the collider's pose when known_ last followed it
    KnownContacts known_;
    FreePlaces free_places_;
    PointArrays moved_along_; ///< positions at the start of the frame, moved along with the collider; used if
                              ///< it moves
    std::vector<Piece> pieces_;
    ParticleList unproven_;
    bool moves_ = false;
};

} // namespace echinus
