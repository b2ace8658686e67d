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

void ContactSide::to_frame_ahead(Places world, PointArrays& result) const {
    result.resize(own->vertex_count());
    for (std::size_t i = 0; i < own->vertex_count(); ++i)
        result.set(i, frame_ahead ? frame_ahead->point_to_local(Vec3f(world[i])) : Vec3f(world[i]));
}

void ContactSide::place_obstacle(PointArrays places) {
    obstacle_places = std::move(places);
    extent = largest_coordinate(obstacle_places, obstacle->vertex_count());
    pairs.forget_obstacle();
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
    away = {away_before.from + deformed, away_before.to + deformed};
}

void ContactSide::end_deforming(bool is_done) {
    if (!is_deforming) return;
    is_deforming = false;
    deformed = 0;
    if (is_done)
        away_before = away;
    else
        place_obstacle(std::move(obstacle_before));
    pairs.forget_obstacle();
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

/// The mean motion of all vertices between two states, which changes no gap of the surface to itself.
Vec3f ContactSide::common_motion(const PointArrays& from, const PointArrays& to) const {
    if (!pairs.is_of_itself()) return {};
    Vec3d sum;
    for (std::size_t i = 0; i < own->vertex_count(); ++i) sum += Vec3d(to[i] - from[i]);
    return Vec3f(sum * (1 / static_cast<double>(own->vertex_count())));
}

/// Marks the vertices that are not within covered() of a reference.
/// @return whether there are any
bool ContactSide::mark_others(const PointArrays& reference, const PointArrays& places) {
    const float most_sq = pairs.covered() * pairs.covered();
    bool is_any = false;
    for (std::size_t i = 0; i < own->vertex_count(); ++i) {
        const Vec3f off = places[i] - reference[i];
        if (dot(off, off) <= most_sq) continue;
        is_other_[i] = 1;
        is_any = true;
    }
    return is_any;
}

/// From now on the list contains the displacements of the marked vertices in addition to those of the others.
/// @param starts_there  whether all displacements begin near where the listed ones do; if not, the unmarked
/// vertices are listed as resting at the ends of their listed displacements
void ContactSide::take_others(bool starts_there) {
    if (!starts_there) listed_from = listed_to;
    listed_from.resize(is_other_.size());
    listed_to.resize(is_other_.size());
    for (std::size_t i = 0; i < is_other_.size(); ++i) {
        if (is_other_[i] == 0) continue;
        if (!starts_there) listed_from.set(i, safe[i]);
        listed_to.set(i, goal[i]);
    }
}

/// After a step, the displacement of a vertex usually begins and ends near the one whose pairs are listed, or
/// else begins and ends near that one's end. Pairs are searched only for vertices to which neither applies.
bool ContactSide::list(Places ends, const Workers& workers) {
    to_frame_ahead(ends, goal);
    bool starts_there = false;
    is_other_.assign(own->vertex_count(), is_listed() ? 0 : 1);
    if (is_listed()) {
        starts_there = !mark_others(listed_from, safe);
        if (!starts_there) {
            std::fill(is_other_.begin(), is_other_.end(), std::uint8_t{0});
            mark_others(listed_to, safe);
        }
        mark_others(listed_to, goal);
        const float obstacle_off = std::max(starts_there ? away_before.from : away_before.to, away.to);
        const bool is_any = std::find(is_other_.begin(), is_other_.end(), 1) != is_other_.end();
        if (!is_any && obstacle_off <= pairs.covered()) return false;
        if (obstacle_off > 0) std::fill(is_other_.begin(), is_other_.end(), std::uint8_t{1});
    }
    starts_there = starts_there && std::find(is_other_.begin(), is_other_.end(), 0) != is_other_.end();
    take_others(starts_there);
    is_elsewhere = true;
    away_before = {0, deformed};
    away = {deformed, 0};
    pairs.list(displacements(listed_from, listed_to), is_other_, starts_there, workers);
    return true;
}

/// The displacements of the surface between two states, and those of the obstacle that are examined.
PairSet::Displacements ContactSide::displacements(const PointArrays& from, const PointArrays& to) const {
    if (pairs.is_of_itself()) return {from, to, from, to};
    return {from, to, obstacle_from(), obstacle_places};
}

void ContactSide::measure_towards(Places goals, const Workers& workers) {
    to_frame_ahead(goals, goal);
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
    return echinus::closing_of(pair, normal, displacements(safe, base));
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
