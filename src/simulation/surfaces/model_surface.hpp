#pragma once

#include "collider/frame_change.hpp"
#include "simulation/material_motion.hpp"
#include "simulation/surface_motion.hpp"
#include "simulation/surfaces/surface_contact.hpp"
#include "simulation/surfaces/surface_pairs.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace echinus {

/// A model's surface, which a deformable must not meet. Lengths are those of the world in the *body
/// frame*: the collider's frame with its scale applied.
class ModelSurface {
  public:
    /// @pre the collider has an exact map
    ModelSurface(const Collider& collider, std::shared_ptr<const Elements> own, const PairReach& reach,
                 float thickness, float friction);

    /// Keeps pairs so far apart from now on.
    void keep_gap(float least_gap) { pairs_.keep_gap(least_gap); }

    /// Forgets everything: nothing was asked of it for a while.
    void reset() { pairs_.reset(); }

    /// @param clearances  [vertex_count] lower bounds of the vertices' distances from the model, or none
    /// @param motion  how the surface deforms in this frame, or null
    void begin_frame(const Collider& collider, const SurfaceMotion* motion, const PointArrays& starts,
                     std::span<const float> clearances, const Workers& workers);
    /// Looks for contacts on the way to where the frame would lead the particles.
    void look_ahead(const Collider& collider_at_end, const PointArrays& goals, const Workers& workers);
    void begin_substep(const Collider& collider, const RigidTransform& previous_pose, std::uint32_t substeps);
    /// @param chosen  [particle_count] if not empty, only contacts of particles that have 1 here
    void relax(Particles& particles, std::span<const float> inverse_masses, SimulationProfile& profile,
               std::span<const std::uint8_t> chosen = {});

    void archive(StateArchive& state);

    /// The collider is where it ends the frame, and so are the particles' goals.
    void set_goals(const PointArrays& goals);
    /// Begins another pass from here, with the collider at rest.
    void begin_pass(const PointArrays& starts, std::span<const float> clearances = {});
    std::span<const std::uint32_t> find_leaving(const Workers& workers) {
        return pairs_.find_leaving(goals_, workers);
    }
    bool renew(std::uint32_t vertex, const Workers& workers) { return pairs_.renew(vertex, workers); }
    /// @param from  in the world, at the end of the frame; none for one that is carried along
    Shares allowed(std::uint32_t vertex, const Vec3f* from) const {
        return pairs_.allowed(vertex, from != nullptr ? now_.point_to_local(*from) : bases_[vertex],
                              goals_[vertex], pairs_.rounding());
    }
    /// May a vertex end the frame at a place in the world? Where it is carried along it may, but for
    /// rounding.
    bool permits(std::uint32_t vertex, const Vec3f& place, bool is_carried) const {
        return pairs_.permits(vertex, now_.point_to_local(place), is_carried ? pairs_.rounding() : 0);
    }
    const SurfacePairs& pairs() const { return pairs_; }
    /// Where a vertex would be that is carried along from where the frame began.
    Vec3f carried(std::uint32_t vertex) const { return now_.point_to_world(bases_[vertex]); }
    /// On the straight way from there to its goal, within the body frame.
    Vec3f place_at(float share, std::uint32_t vertex) const {
        const Vec3f base = bases_[vertex];
        return now_.point_to_world(base + (goals_[vertex] - base) * share);
    }

  private:
    struct Shape {
        Elements elements;
        PointArrays positions;
        ElementTree tree;
    };
    struct Contact {
        SurfaceContact in_world;
        Vec3f normal_body;
        Vec3f drift_body; ///< how the surface under it deforms in this frame
        float offset_body;
        std::uint32_t element;
        bool has_pushed = false;
    };

    void to_body(const PointArrays& places, PointArrays& result) const;
    void deform(const SurfaceMotion& motion, const Workers& workers);
    void forget_contacts(std::span<const std::uint32_t> elements);
    float consider(std::uint32_t element, const Pair& pair, const Separation& apart);
    bool slides_past(const Pair& pair, const Separation& apart) const;
    void add_contact(std::uint32_t element, const Pair& pair, const Separation& apart);
    void place(Contact& contact) const;

    std::shared_ptr<const Elements> own_;
    std::shared_ptr<const Shape> shape_; ///< as it began
    /// In place of the shape's, once it has deformed: where the vertices are when the frame begins and ends.
    std::optional<Shape> deformed_;
    MovingTree ways_;                       ///< of its elements, in the last frame in which it deformed
    const SurfaceMotion* motion_ = nullptr; ///< in this pass
    float drift_share_ = 1;                 ///< of a frame's, in each substep
    SurfacePairs pairs_;
    FrameChange now_;
    bool at_origin_ = false; ///< the body frame is the world
    MaterialMotion material_;
    float thickness_, friction_;
    PointArrays starts_, bases_, goals_;
    std::vector<Contact> contacts_;
    std::vector<std::uint8_t> is_forgotten_; ///< by element, while contacts are forgotten
    std::vector<std::uint8_t> is_alert_;     ///< by vertex: a contact that is being replaced had pushed it
};

} // namespace echinus
