#pragma once

#include "collider/frame_change.hpp"
#include "simulation/surfaces/element_tree.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/separation.hpp"
#include "simulation/surfaces/shares.hpp"
#include "simulation/surfaces/surface_contact.hpp"

#include <echinus/simulation.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace echinus {

/// The deformable's own surface, which must not meet itself.
///
/// All is said in a frame that moves along with the deformable: the world or a collider's frame, and in it
/// the mean motion of the particles. In that frame each vertex has a *room*, as beside a model
/// (surface_pairs.hpp), half as wide, since both sides of a pair move. When a vertex leaves its room all
/// pairs are measured; when one has moved by a slack they are searched for.
class SelfSurface {
  public:
    struct Reach {
        float listed;    ///< pairs this near are listed
        float slack;     ///< the list holds until a vertex has moved this far
        float least_gap; ///< no motion takes a pair nearer than this
    };

    /// @param thickness  that layers keep from each other, as far as the faces are large enough for it
    SelfSurface(std::shared_ptr<const Elements> own, const Particles& particles, const Reach& reach,
                float thickness, float friction);

    /// @param frame  where the frame stands; the world where there is none
    void begin_pass(const RigidTransform* frame, const PointArrays& starts);
    /// Looks for contacts on the way to the goals. @param frame  at the end of the frame
    void look_ahead(const RigidTransform* frame, const PointArrays& goals);
    void relax(Particles& particles, std::span<const float> inverse_masses, SimulationProfile& profile);

    /// @param drifts  take the mean motion off, which a way that has to end early does not do
    void set_goals(const RigidTransform* frame, const PointArrays& goals, bool drifts);
    /// The vertices that leave their rooms for the goals though their rooms are new.
    std::span<const std::uint32_t> find_leaving();
    /// Makes sure that rooms are new. @return whether they were not
    bool renew();
    /// For those of find_leaving() and others that are asked for next.
    void prepare(std::span<const std::uint32_t> vertices);
    /// The shares of the way of one of them that nothing forbids.
    /// @param from  where the way begins, in the world at the end of the frame
    Shares allowed(std::uint32_t vertex, const Vec3f& from) const;

    std::uint64_t search_count = 0, measured_count = 0;

  private:
    struct Contact {
        SurfaceContact pair;
        bool has_pushed = false;
    };

    Vec3f into_frame(const Vec3f& place) const { return in_world_ ? place : now_.point_to_local(place); }
    void to_frame(const RigidTransform* frame, const PointArrays& places, PointArrays& result);
    void take_off(const Vec3f& drift, PointArrays& places) const;
    void search();
    void measure();
    bool is_beyond(std::uint32_t vertex, float radius) const;
    float thickness_of(const Pair& pair) const;
    float consider(const Pair& pair, const Separation& apart);
    float usable(float gap) const { return usable_gap(gap, reach_.least_gap); }

    std::shared_ptr<const Elements> own_;
    std::vector<Element> faces_, edges_, vertices_; ///< each as elements of their own
    ElementTree face_tree_, edge_tree_, vertex_tree_;
    Reach reach_;
    FrameChange now_{RigidTransform{}, {1, 1, 1}};
    bool in_world_ = true;
    Vec3f drift_;      ///< the frame's mean motion so far
    Vec3f drift_goal_; ///< and at the goals
    bool drifts_ = false;
    float thickness_, friction_;
    std::vector<float> most_;     ///< by vertex: the most thickness that the elements around it allow
    std::vector<float> mobility_; ///< by vertex: 1, or 0 for one that is pinned
    PointArrays starts_, goals_;
    // Pairs, each once, with the one side as the deformable's and the other as the opponent's
    std::vector<std::array<std::uint32_t, 2>> near_;
    std::vector<Pair> candidates_, pairs_;
    std::vector<Separation> separations_;
    PointArrays searched_at_;
    bool has_searched_ = false;
    // Rooms
    PointArrays anchors_;
    std::vector<float> rooms_, quiet_; ///< radii; nothing new is expected within the quiet ones
    float unlisted_room_ = 0;          ///< as far as the pairs that are not listed are concerned
    bool is_measured_ = false;         ///< in this pass
    std::vector<std::uint32_t> leaving_;
    // prepare()
    std::vector<std::uint8_t> is_wanted_;
    std::vector<std::uint32_t> pair_offsets_, pairs_at_, next_;
    // Contacts
    std::vector<Contact> contacts_;
    std::vector<std::uint8_t> is_alert_; ///< by vertex: a contact has pushed it lately
};

} // namespace echinus
