#pragma once

#include "collider/frame_change.hpp"
#include "mechanics/energy_term.hpp"
#include "simulation/contact/pair_set.hpp"
#include "simulation/particles.hpp"

#include <echinus/collider.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace echinus {

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

    void set_pose(const RigidTransform& pose);
    void to_frame(const PointArrays& world, PointArrays& result) const;
    void to_frame(Places world, PointArrays& result) const;
    Vec3d obstacle_point(std::uint32_t vertex) const {
        return frame ? frame->point_to_world<double>(obstacle_places[vertex])
                     : Vec3d(obstacle_places[vertex]);
    }
    const PointArrays& obstacle_at(const PointArrays& own_places) const {
        return pairs.is_of_itself() ? own_places : obstacle_places;
    }

    bool is_listed() const { return !expected.empty(); }
    /// Are these places so near to those where displacements begin, or to those where they end, that their
    /// pairs are listed?
    bool covers(const PointArrays& in_frame) const;
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
    /// Where the obstacle carries a particle from where its pairs are measured.
    Vec3d carried(std::uint32_t particle, const Vec3d& from) const {
        const Vec3d to = frame ? frame->point_to_world<double>(safe[particle]) : Vec3d(safe[particle]);
        return Vec3f(to) == Vec3f(from) ? from : to;
    }

    Vec3f common_motion(const PointArrays& from, const PointArrays& to) const;

    std::shared_ptr<const Elements> own, obstacle; ///< the same of itself
    PointArrays obstacle_places;                   ///< of a model
    PairSet pairs;
    std::optional<FrameChange> frame; ///< of a model that does not stand in the world's
    float thickness = 0, ready = 0, friction = 0, least_gap = 0;
    float extent = 0; ///< of the obstacle's coordinates
    /// Where displacements begin and end for which the pairs are listed: to any of these ends.
    PointArrays listed_from;
    std::vector<PointArrays> expected;
    PointArrays safe;                  ///< where the pairs are measured
    PointArrays base;                  ///< and where displacements lead them that they make together
    PointArrays goal;                  ///< and those of each alone
    bool is_elsewhere = true;          ///< than where pairs were measured
    std::vector<float> strayed, ahead; ///< scratch of measure()
};

} // namespace echinus
