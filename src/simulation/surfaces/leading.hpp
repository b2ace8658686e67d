#pragma once

#include "simulation/particles.hpp"
#include "simulation/surfaces/near_models.hpp"
#include "simulation/surfaces/self_surface.hpp"

#include <echinus/contact.hpp>
#include <echinus/simulation.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace echinus {

/// Where vertices end that go none of their way, beside several models of which some move: taken along by all
/// that are near, the more the nearer they are. What goes straight between two plates that approach each
/// other keeps its share of the room, and so does all that lies between them. Pairs that could meet on these
/// ways are led on one way, with all that hangs together by such pairs.
class Leading {
  public:
    /// @param carry_reaches  by model: what is so near goes along with it
    Leading(const Deformable& deformable, std::span<const float> carry_reaches);

    /// @param colliders   as the frame begins
    /// @param clearances  by model and vertex, of which each is at least so far
    void begin_frame(NearModels& models, const std::vector<Collider>& colliders,
                     std::span<const std::vector<float>> clearances, const Particles& particles);
    /// A model that was away is near after all.
    void meet_late(std::size_t model, const Collider& at_start, const NearModels& models,
                   const Particles& particles);

    bool has_pulls() const { return has_pulls_; }
    /// Of a vertex that several models may take along. @pre has_pulls()
    Vec3f carried_between(std::uint32_t vertex, NearModels& models, const Particles& particles,
                          const Workers& workers) const;

    /// Before pairs are looked at: all are led to bases, which the caller fills.
    SelfSurface::Bases& begin(const NearModels& models);
    /// All that hang together by pairs which could meet, in this round and before, are led on one way that
    /// all models permit. @return whether some are led anew
    bool lead_together(std::span<const std::array<std::uint32_t, 4>> pairs, NearModels& models,
                       const Particles& particles, const Workers& workers);

  private:
    using Member = std::pair<std::uint32_t, std::uint32_t>; ///< a group, and a vertex of it

    void begin_pulls(std::size_t model_count, std::size_t particle_count);
    void find_pulls(std::size_t model, const Collider& collider, std::span<const float> clearances,
                    const Particles& particles);
    float most_pull(std::uint32_t vertex) const;
    Vec3f mean_way(std::span<const Member> members, const NearModels& models,
                   const Particles& particles) const;
    std::uint32_t body_of(std::uint32_t vertex, const NearModels& models) const;
    std::uint32_t group_of(std::uint32_t vertex);
    bool lead_group(std::span<const Member> members, NearModels& models, const Particles& particles,
                    const Workers& workers);
    bool lead_on(std::span<const std::uint32_t> vertices, const Vec3f& way, std::uint32_t body,
                 NearModels& models, const Particles& particles, const Workers& workers);

    SelfSurface::Bases bases_;
    std::vector<std::uint32_t> attached_; ///< by vertex: to a model, or to none
    std::vector<std::uint32_t> groups_; ///< by vertex: another one that is led with it, up to one that leads
    bool has_groups_ = false;           ///< in this frame
    bool has_pulls_ = false;            ///< in this frame
    float pull_reach_;                  ///< what is farther from a model is not taken along by it
    std::vector<std::vector<float>> pulls_; ///< by model and vertex: how much the model takes it along
    std::vector<std::uint32_t> beside_;     ///< vertices that a model may take along,
    std::vector<Vec3f> places_;             ///< where they are,
    std::vector<Contact> contacts_;         ///< and what is nearest to them
};

} // namespace echinus
