#pragma once

#include "collider/frame_change.hpp"
#include "mechanics/energy_term.hpp"
#include "simulation/contact/pair_set.hpp"
#include "simulation/contact/thresholds.hpp"
#include "simulation/particles.hpp"

#include <echinus/collider.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace echinus {

/// The frame of a model; none if it is the world's.
std::optional<FrameChange> frame_of(const RigidTransform& pose);

/// The surface of a deformable and what it may touch: a model, in the frame that moves with the model, or the
/// surface itself, in the world.
struct ContactSide {
    ContactSide(std::shared_ptr<const Elements> own_in, const PointArrays& own_places,
                std::shared_ptr<const Elements> obstacle_in, PointArrays obstacle_places_in)
        : own(std::move(own_in)), obstacle(std::move(obstacle_in)),
          obstacle_places(std::move(obstacle_places_in)), pairs(own, own_places, obstacle, obstacle_places) {}
    /// The surface and itself.
    ContactSide(const std::shared_ptr<const Elements>& own_in, const PointArrays& places)
        : own(own_in), obstacle(own_in), pairs(own_in, places) {}

    void set_pose(const RigidTransform& pose) {
        frame = frame_ahead = frame_of(pose);
        is_heading = false;
    }
    /// The displacements that are examined lead to this pose of the model.
    void head_for(const RigidTransform& pose) {
        frame_ahead = frame_of(pose);
        is_heading = true;
    }
    void to_frame(const PointArrays& world, PointArrays& result) const;
    /// The same in the frame to which the model moves.
    void to_frame_ahead(Places world, PointArrays& result) const;
    Vec3d to_world(const Vec3f& in_frame) const {
        return frame ? frame->point_to_world<double>(in_frame) : Vec3d(in_frame);
    }
    Vec3d to_world_ahead(const Vec3f& in_frame) const {
        return frame_ahead ? frame_ahead->point_to_world<double>(in_frame) : Vec3d(in_frame);
    }

    /// Sets the vertices of the obstacle.
    void place_obstacle(PointArrays places);
    /// The obstacle's vertices move straight to these positions during the displacement that is examined
    /// next.
    void deform(PointArrays places);
    /// @param is_done  if false, they return to where they were
    void end_deforming(bool is_done);
    /// The obstacle's vertices at the beginning of the displacement that is examined.
    const PointArrays& obstacle_from() const { return is_deforming ? obstacle_before : obstacle_places; }
    /// The largest distance by which the obstacle's vertices in a pair move along the normal in this
    /// displacement.
    float obstacle_closing(const Pair& pair, const Vec3f& normal) const;
    /// The displacement of a vertex of the obstacle in the displacement that is examined, by the motion of
    /// the model.
    Vec3d obstacle_ahead(std::uint32_t vertex) const {
        if (!is_heading) return {};
        return to_world_ahead(obstacle_places[vertex]) - to_world(obstacle_places[vertex]);
    }
    /// The displacement by which the obstacle has deformed in this step, at a point of a pair.
    Vec3d obstacle_displacement(const Pair& pair, const std::array<double, 4>& shares) const;

    bool is_listed() const { return !listed_to.x.empty(); }
    /// Lists the pairs for displacements from `safe` to these ends, unless they are already listed. @return
    /// whether they were not
    bool list(Places ends, const Workers& workers);
    /// Sets the positions at which the surface is safe. @param world  in world coordinates
    void set_safe(const PointArrays& world) {
        to_frame(world, safe);
        is_elsewhere = true;
    }
    /// Measures those listed pairs that displacements to these goals may bring near.
    void measure_towards(Places goals, const Workers& workers);
    /// Measures the pairs at `safe` that displacements to `base` or `goal` may bring near.
    void measure(const Workers& workers);

    /// How far a pair with this gap may close: a share of the gap, or of the thickness if that is less,
    /// remains, so that rounding has no influence.
    float room(float gap) const {
        return gap - std::max(least_gap, std::min(gap * threshold::kLeastOfGap,
                                                  thickness * threshold::kLeastOfThickness));
    }
    /// How far a measured pair closes along its normal on the way to `base`.
    float closing_of(const Pair& pair, const Vec3f& normal) const;
    /// The largest distance by which pairs would close beyond their gaps on the way to `base`; not negative.
    /// @param may_touch  [particle] set to 1 for particles of pairs that come nearer than the thickness
    double overlap_ahead(std::span<std::uint8_t> may_touch) const;

    std::shared_ptr<const Elements> own, obstacle;   ///< equal for contact with itself
    PointArrays obstacle_places, obstacle_before;    ///< of a model: now, and before it deformed in this step
    bool is_deforming = false, has_deformed = false; ///< in this displacement; in this step
    float deformed = 0;       ///< the largest displacement of its vertices by the deformation
    std::uint32_t number = 0; ///< of the collider; for contact with itself the number of colliders
    PairSet pairs;
    /// The frame of a model, if it is not the world's: in the safe state, and where displacements lead.
    std::optional<FrameChange> frame, frame_ahead;
    bool is_heading = false; ///< may the two differ?
    float thickness = 0, ready = 0, friction = 0, least_gap = 0;
    float extent = 0;                   ///< of the obstacle's coordinates
    PointArrays listed_from, listed_to; ///< where the displacements whose pairs are listed begin and end
    /// How far the vertices of the obstacle may be from their positions at the beginning and the end of the
    /// listed displacements.
    struct Away {
        float from = 0, to = 0;
    };
    Away away_before, away;            ///< at the beginning and the end of the displacement that is examined
    PointArrays start;                 ///< where this step began, in the frame of a moving model at that time
    bool moves = false;                ///< does the model move in this step?
    PointArrays safe;                  ///< the positions at which pairs are measured
    PointArrays base;                  ///< where the displacements lead after the corrections made so far
    PointArrays goal;                  ///< where the wanted displacements lead
    bool is_elsewhere = true;          ///< whether `safe` has changed since pairs were measured
    std::vector<float> strayed, ahead; ///< scratch of measure()

  private:
    const PointArrays& obstacle_at_start() const { return pairs.is_of_itself() ? safe : obstacle_from(); }
    PairSet::Displacements displacements(const PointArrays& from, const PointArrays& to) const;
    Vec3f common_motion(const PointArrays& from, const PointArrays& to) const;
    bool mark_others(const PointArrays& reference, const PointArrays& places);
    void take_others(bool starts_there);

    std::vector<std::uint8_t> is_other_; ///< scratch of list()
};

} // namespace echinus
