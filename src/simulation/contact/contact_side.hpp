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

/// The frame of a model; none where it is the world's.
std::optional<FrameChange> frame_of(const RigidTransform& pose);

/// The surface of a deformable and what it may touch: a model, in the frame that moves with it, or itself, in
/// the world.
struct ContactSide {
    ContactSide(std::shared_ptr<const Elements> own_in, const PointArrays& own_places,
                std::shared_ptr<const Elements> obstacle_in, PointArrays obstacle_places_in)
        : own(std::move(own_in)), obstacle(std::move(obstacle_in)),
          obstacle_places(std::move(obstacle_places_in)), pairs(own, own_places, obstacle, obstacle_places) {}
    /// Of itself.
    ContactSide(const std::shared_ptr<const Elements>& own_in, const PointArrays& places)
        : own(own_in), obstacle(own_in), pairs(own_in, places) {}

    void set_pose(const RigidTransform& pose) {
        frame = frame_ahead = frame_of(pose);
        is_heading = false;
    }
    /// The model goes there in the displacements that are looked at.
    void head_for(const RigidTransform& pose) {
        frame_ahead = frame_of(pose);
        is_heading = true;
    }
    void to_frame(const PointArrays& world, PointArrays& result) const;
    /// Seen from where the model goes.
    void to_frame_ahead(Places world, PointArrays& result) const;
    Vec3d to_world(const Vec3f& in_frame) const {
        return frame ? frame->point_to_world<double>(in_frame) : Vec3d(in_frame);
    }
    Vec3d to_world_ahead(const Vec3f& in_frame) const {
        return frame_ahead ? frame_ahead->point_to_world<double>(in_frame) : Vec3d(in_frame);
    }

    /// The vertices of the obstacle stand there.
    void place_obstacle(PointArrays places);
    /// They go straight from where they are to there, while the surface makes the displacement that is looked
    /// at next.
    void deform(PointArrays places);
    /// @param is_done  else they are back where they were
    void end_deforming(bool is_done);
    /// Where they are at the beginning of the displacement that is looked at.
    const PointArrays& obstacle_from() const { return is_deforming ? obstacle_before : obstacle_places; }
    /// How far a pair's vertices of the obstacle come along the normal meanwhile, at most.
    float obstacle_closing(const Pair& pair, const Vec3f& normal) const;
    /// How far a vertex of the obstacle goes with it in the displacement that is looked at.
    Vec3d obstacle_ahead(std::uint32_t vertex) const {
        if (!is_heading) return {};
        return to_world_ahead(obstacle_places[vertex]) - to_world(obstacle_places[vertex]);
    }
    /// By which the obstacle has deformed in this step, at a point of a pair.
    Vec3d obstacle_displacement(const Pair& pair, const std::array<double, 4>& shares) const;

    bool is_listed() const { return !listed_to.x.empty(); }
    /// Lists the pairs of displacements from `safe` to here, unless they are. @return whether they were not
    bool list(Places ends, const Workers& workers);
    /// Where the surface is safe now. @param world  the same in the world
    void set_safe(const PointArrays& world) {
        to_frame(world, safe);
        is_elsewhere = true;
    }
    /// Measures the pairs that displacements to here may bring near, of those that are listed.
    void measure_towards(Places goals, const Workers& workers);
    /// Measures the pairs at `safe` that displacements to `base` or `goal` may bring near.
    void measure(const Workers& workers);

    /// How far a pair that lies `gap` apart may close: a share of the gap remains, or of the thickness where
    /// that is less, so that rounding has no say.
    float room(float gap) const {
        return gap - std::max(least_gap, std::min(gap * threshold::kLeastOfGap,
                                                  thickness * threshold::kLeastOfThickness));
    }
    /// How far a pair that was measured closes along its normal, on the way to `base`.
    float closing_of(const Pair& pair, const Vec3f& normal) const;
    /// The most by which pairs would close beyond their gaps on the way to `base`; not negative.
    /// @param may_touch  [particle] set to 1 for those of pairs that come as near as the thickness
    double overlap_ahead(std::span<std::uint8_t> may_touch) const;

    std::shared_ptr<const Elements> own, obstacle;   ///< the same of itself
    PointArrays obstacle_places, obstacle_before;    ///< of a model: now, and before it deformed in this step
    bool is_deforming = false, has_deformed = false; ///< in the displacement, and in the step
    float deformed = 0;                              ///< no vertex goes farther in the displacement
    std::uint32_t number = 0;                        ///< of the collider; of itself the count of colliders
    PairSet pairs;
    /// Of a model that does not stand in the world's: in the safe state, and where displacements lead.
    std::optional<FrameChange> frame, frame_ahead;
    bool is_heading = false; ///< may the two differ?
    float thickness = 0, ready = 0, friction = 0, least_gap = 0;
    float extent = 0;                   ///< of the obstacle's coordinates
    PointArrays listed_from, listed_to; ///< where displacements begin and end for which pairs are listed
    /// How far the vertices of the obstacle may be from where they were at those two.
    struct Away {
        float from = 0, to = 0;
    };
    Away away_before, away;            ///< at the beginning and the end of the displacement that is looked at
    PointArrays start;                 ///< where this step began, beside a model that moves; as its frame was
    bool moves = false;                ///< does the model move in this step?
    PointArrays safe;                  ///< where the pairs are measured
    PointArrays base;                  ///< and where displacements lead that have been corrected so far
    PointArrays goal;                  ///< and those that are wanted
    bool is_elsewhere = true;          ///< than where pairs were measured
    std::vector<float> strayed, ahead; ///< scratch of measure()

  private:
    const PointArrays& obstacle_at_start() const { return pairs.is_of_itself() ? safe : obstacle_from(); }
    Vec3f common_motion(const PointArrays& from, const PointArrays& to) const;
    bool mark_others(const PointArrays& reference, const PointArrays& places);
    void take_others(bool starts_there);

    std::vector<std::uint8_t> is_other_; ///< scratch of list()
};

} // namespace echinus
