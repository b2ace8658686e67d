#include "simulation/contact/contact_side.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echinus {

std::optional<FrameChange> frame_of(const RigidTransform& pose) {
    const Rotation& r = pose.rotation;
    if (pose.translation == Vec3d{} && r.x == 0 && r.y == 0 && r.z == 0) return std::nullopt;
    return FrameChange(pose, {1, 1, 1});
}

void ContactSide::to_frame(const PointArrays& world, PointArrays& result) const {
    if (!frame) {
        result = world;
        return;
    }
    result.resize(own->vertex_count());
    for (std::size_t i = 0; i < own->vertex_count(); ++i) result.set(i, frame->point_to_local(world[i]));
}

void ContactSide::to_frame(Places world, PointArrays& result) const {
    result.resize(own->vertex_count());
    for (std::size_t i = 0; i < own->vertex_count(); ++i)
        result.set(i, frame ? frame->point_to_local(Vec3f(world[i])) : Vec3f(world[i]));
}

void ContactSide::place_obstacle(PointArrays places) {
    obstacle_places = std::move(places);
    extent = largest_coordinate(obstacle_places, obstacle->vertex_count());
    pairs.forget_obstacle_boxes();
}

void ContactSide::deform(PointArrays places) {
    obstacle_before = std::move(obstacle_places);
    place_obstacle(std::move(places));
    is_deforming = has_deformed = true;
    float most_sq = 0;
    for (std::uint32_t v = 0; v < obstacle->vertex_count(); ++v) {
        const Vec3f displacement = obstacle_places[v] - obstacle_before[v];
        most_sq = std::max(most_sq, dot(displacement, displacement));
    }
    deformed = std::sqrt(most_sq);
    away = {away_before.from + deformed, away_before.expected + deformed};
}

void ContactSide::end_deforming(bool is_done) {
    if (!is_deforming) return;
    is_deforming = false;
    deformed = 0;
    if (is_done)
        away_before = away;
    else
        place_obstacle(std::move(obstacle_before));
    pairs.forget_obstacle_boxes();
}

float ContactSide::obstacle_closing(const Pair& pair, const Vec3f& normal) const {
    if (!is_deforming) return 0;
    float most = -std::numeric_limits<float>::infinity();
    for (std::size_t k = own_count(pair.kind); k < 4; ++k)
        most = std::max(most, dot(normal, obstacle_places[pair.points[k]] - obstacle_before[pair.points[k]]));
    return most;
}

Vec3d ContactSide::obstacle_displacement(const Pair& pair, const std::array<double, 4>& shares) const {
    Vec3d sum;
    if (!has_deformed) return sum;
    for (std::size_t k = own_count(pair.kind); k < 4; ++k)
        sum += Vec3d(obstacle_places[pair.points[k]] - obstacle_before[pair.points[k]]) * shares[k];
    return sum;
}

/// The motion that all have in common between two states. It changes no gap of the surface to itself.
Vec3f ContactSide::common_motion(const PointArrays& from, const PointArrays& to) const {
    if (!pairs.is_of_itself()) return {};
    Vec3d sum;
    for (std::size_t i = 0; i < own->vertex_count(); ++i) sum += Vec3d(to[i] - from[i]);
    return Vec3f(sum * (1 / static_cast<double>(own->vertex_count())));
}

bool ContactSide::covers(const PointArrays& in_frame, const Away& obstacle_away) const {
    if (!is_listed()) return false;
    const float most_sq = pairs.covered() * pairs.covered();
    const auto is_near = [&](const PointArrays& places) {
        const Vec3f common = common_motion(places, in_frame);
        for (std::size_t i = 0; i < own->vertex_count(); ++i) {
            const Vec3f away_from_it = in_frame[i] - places[i] - common;
            if (!(dot(away_from_it, away_from_it) <= most_sq)) return false;
        }
        return true;
    };
    return (obstacle_away.from <= pairs.covered() && is_near(listed_from)) ||
           (obstacle_away.expected <= pairs.covered() &&
            std::any_of(expected.begin(), expected.end(), is_near));
}

bool ContactSide::list(Places ends, const Workers& workers) {
    to_frame(ends, goal);
    if (is_listed() && listed_from == safe && away_before.from == 0 && away.expected == 0)
        return add_to_list(workers);
    if (covers(safe, away_before) && covers(goal, away)) return false;
    listed_from = safe;
    is_elsewhere = true;
    expected.assign(1, goal);
    away_before = {0, deformed};
    away = {deformed, 0};
    pairs.list({safe, goal, obstacle_at_start(), pairs.is_of_itself() ? goal : obstacle_places}, workers);
    return true;
}

/// Displacements from where pairs are listed add to the list, so that a search for ends that it covers ends.
bool ContactSide::add_to_list(const Workers& workers) {
    if (covers(goal, away)) return false;
    PointArrays ends = expected.back();
    const Vec3f common = common_motion(ends, goal);
    std::vector<std::uint8_t> is_other(own->vertex_count());
    for (std::size_t i = 0; i < is_other.size(); ++i) {
        const Vec3f end = goal[i] - common, off = end - ends[i];
        if (dot(off, off) <= pairs.covered() * pairs.covered()) continue;
        is_other[i] = 1;
        ends.set(i, end);
    }
    is_elsewhere = true;
    expected.push_back(std::move(ends));
    const PointArrays& to = expected.back();
    pairs.add_to_list({safe, to, obstacle_at_start(), pairs.is_of_itself() ? to : obstacle_places}, is_other,
                      workers);
    return true;
}

void ContactSide::measure_towards(Places goals, const Workers& workers) {
    to_frame(goals, goal);
    base = goal;
    measure(workers);
}

void ContactSide::measure(const Workers& workers) {
    const std::size_t count = own->vertex_count();
    strayed.resize(count);
    ahead.resize(count);
    const Vec3f common_past = common_motion(listed_from, safe), common_ahead = common_motion(safe, goal);
    for (std::size_t i = 0; i < count; ++i) {
        strayed[i] = length(safe[i] - listed_from[i] - common_past) + away_before.from;
        ahead[i] =
            std::max(length(base[i] - safe[i] - common_ahead), length(goal[i] - safe[i] - common_ahead)) +
            deformed;
    }
    pairs.measure({listed_from, safe, base, goal, strayed, ahead}, obstacle_at_start(), ready, is_elsewhere,
                  workers);
    is_elsewhere = false;
}

float ContactSide::closing_of(const Pair& pair, const Vec3f& normal) const {
    std::array<float, 2> most;
    most.fill(-std::numeric_limits<float>::infinity());
    const std::size_t of_own = own_count(pair.kind), moving = pairs.moving_count(pair);
    for (std::size_t k = 0; k < moving; ++k) {
        const float along = dot(normal, base[pair.points[k]] - safe[pair.points[k]]);
        float& of_part = most[k < of_own ? 0 : 1];
        of_part = std::max(of_part, k < of_own ? -along : along);
    }
    return most[0] + (moving == 4 ? most[1] : obstacle_closing(pair, normal));
}

double ContactSide::overlap_ahead(std::span<std::uint8_t> may_touch) const {
    float most = 0;
    for (std::size_t p = 0; p < pairs.pairs().size(); ++p) {
        const Pair& pair = pairs.pairs()[p];
        const Separation& apart = pairs.separations()[p];
        const float closing = closing_of(pair, apart.normal);
        most = std::max(most, closing - apart.gap);
        if (apart.gap - std::max(closing, 0.0F) < thickness)
            for (std::size_t k = 0; k < pairs.moving_count(pair); ++k) may_touch[pair.points[k]] = 1;
    }
    return double{most};
}

} // namespace echinus
