#pragma once

#include "collider/frame_change.hpp"
#include "simulation/surfaces/surface_contact.hpp"
#include "simulation/surfaces/surface_pairs.hpp"

#include <echinus/simulation.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace echinus {

/// The deformable's own surface, which must not meet itself, in a rigid frame that may move.
class SelfSurface {
  public:
    /// @param thickness  that its layers keep from each other, as far as the faces are large enough for it
    SelfSurface(std::shared_ptr<const Elements> own, const PointArrays& positions, const PairReach& reach,
                float thickness, float friction);

    /// @param frame  where the frame stands; the world where there is none
    void begin_pass(const RigidTransform* frame, const PointArrays& starts);
    /// @param frame  at the end of the frame
    void look_ahead(const RigidTransform* frame, const PointArrays& goals);
    void relax(Particles& particles, std::span<const float> inverse_masses, SimulationProfile& profile);

    void set_goals(const RigidTransform* frame, const PointArrays& goals);
    std::span<const std::uint32_t> find_leaving() { return pairs_.find_leaving(goals_); }
    bool renew(std::uint32_t vertex) { return pairs_.renew(vertex); }
    /// @param from  in the world, at the end of the frame; none for one that is carried along
    Shares allowed(std::uint32_t vertex, const Vec3f* from) const;
    const SurfacePairs& pairs() const { return pairs_; }

  private:
    struct Contact {
        SurfaceContact pair;
        std::uint32_t element, opponent;
        bool has_pushed = false;
    };

    void to_frame(const RigidTransform* frame, const PointArrays& places, PointArrays& result);
    float thickness_of(std::uint32_t element, std::uint32_t opponent) const {
        return std::min(std::min(most_[element], most_[opponent]), thickness_);
    }
    void forget_contacts(std::span<const std::uint32_t> elements);
    float consider(std::uint32_t element, const Pair& pair, const Separation& apart);

    std::shared_ptr<const Elements> own_;
    ElementTree tree_;
    SurfacePairs pairs_;
    FrameChange now_{RigidTransform{}, {1, 1, 1}};
    bool in_world_ = true;
    float thickness_, friction_;
    std::vector<float> most_; ///< by element: the most that its size allows
    PointArrays starts_, goals_;
    std::vector<Contact> contacts_;
    std::vector<std::uint8_t> is_measured_; ///< by element, while it looks ahead
    std::vector<std::uint8_t> is_alert_;    ///< by vertex: a contact that is being replaced had pushed it
};

} // namespace echinus
