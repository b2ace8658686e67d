#include "simulation/contact/safe_displacements.hpp"

#include "simulation/contact/passing_planes.hpp"
#include "simulation/contact/thresholds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace echinus {

SafeDisplacements::SafeDisplacements(std::span<ContactSide> sides, Places goals, const PushRules& rules,
                                     const Workers& workers)
    : sides_(sides), goals_(goals), rules_(rules), workers_(workers),
      ends_(goals.begin(), goals.end(), workers.scratch()), pushed_(goals.size(), workers.scratch()),
      pushed_by_(goals.size(), kNoObstacle, workers.scratch()),
      enough_(sides.size(), ScratchVector<float>(workers.scratch()), workers.scratch()),
      closed_counts_(sides.size(), workers.scratch()) {}

Places SafeDisplacements::find() {
    for (ContactSide& side : sides_) side.to_frame_ahead(goals_, side.goal);
    for (ScratchVector<float>& of_side : enough_) of_side.clear();
    has_converged_ = false;
    for (int round = 0; round < threshold::kMostPushingRounds && !has_converged_; ++round) {
        has_converged_ = true;
        for (std::size_t s = 0; s < sides_.size(); ++s) {
            sides_[s].to_frame_ahead(ends_, sides_[s].base);
            sides_[s].measure(workers_);
            has_converged_ = !correct(sides_[s], enough_[s]) && has_converged_;
        }
    }
    unresolved_count_ = 0;
    std::fill(closed_counts_.begin(), closed_counts_.end(), 0);
    for (std::size_t s = 0; s < sides_.size(); ++s)
        for (std::size_t p = 0; p < enough_[s].size(); ++p)
            if (!(sides_[s].pairs.separations()[p].gap > 0))
                ++unresolved_count_;
            else if (pushed(sides_[s], p) >= enough_[s][p] && plane_between(sides_[s], p).left() < 0)
                ++closed_counts_[s];
    unresolved_count_ = std::accumulate(closed_counts_.begin(), closed_counts_.end(), unresolved_count_);
    return ends_;
}

float SafeDisplacements::room_of(const ContactSide& side, float gap) const {
    return std::max(std::min(side.room(gap), rules_.share * gap), 0.0F);
}

/// The plane between the parts of a pair that hinders their displacements least: the one that they are
/// farthest apart along, or one along which they pass each other.
SafeDisplacements::Plane SafeDisplacements::plane_between(const ContactSide& side, std::size_t index) const {
    const Pair& pair = side.pairs.pairs()[index];
    const Separation& apart = side.pairs.separations()[index];
    const auto plane_along = [&](const Vec3f& normal, float gap) {
        return Plane{normal, room_of(side, gap), side.closing_of(pair, normal)};
    };
    // A pair that touches has no plane between: it is counted, and not pushed.
    if (!(apart.gap > 0)) return {apart.normal, 0, 0};
    Plane best = plane_along(apart.normal, apart.gap);
    if (best.left() >= 0) return best;
    const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
    PassingParts<float> parts{pair.kind, {}, apart.normal, {}};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t i = pair.points[k];
        parts.points[k] = (k < moving ? side.safe : side.obstacle_from())[i];
        if (k < moving)
            parts.ahead += (side.base[i] - side.safe[i]) *
                           (k < own ? 1 / static_cast<float>(own) : -1 / static_cast<float>(4 - own));
    }
    for (const Vec3f& normal : parts.normals()) {
        const float gap = parts.gap_along(normal);
        if (!(gap > side.least_gap)) continue;
        const Plane plane = plane_along(normal, gap);
        if (plane.left() > best.left()) best = plane;
    }
    return best;
}

/// Whether the two elements of a pair stay apart although no single plane separates them along the whole of
/// their displacements: a sequence of planes does, each measured where the one before reaches its limit
/// (conservative advancement, Mirtich 1996).
bool SafeDisplacements::stays_apart(const ContactSide& side, std::size_t index) const {
    const Pair& pair = side.pairs.pairs()[index];
    Separation apart = side.pairs.separations()[index];
    const float kept = apart.gap - room_of(side, apart.gap);
    const std::size_t moving = side.pairs.moving_count(pair);
    for (float done = 0;;) {
        if (!(apart.gap > kept)) return false;
        const float closing = side.closing_of(pair, apart.normal), room = apart.gap - kept;
        if (closing * (1 - done) <= room) return true;
        const float share = room / closing;
        if (share < threshold::kLeastShareOfPlane) return false;
        done += share;
        std::array<Vec3f, 4> points;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t i = pair.points[k];
            const Vec3f from = (k < moving ? side.safe : side.obstacle_from())[i];
            points[k] = from + ((k < moving ? side.base : side.obstacle_places)[i] - from) * done;
        }
        apart = separation(pair.kind, points);
    }
}

/// How far its particles have been pushed, in all.
float SafeDisplacements::pushed(const ContactSide& side, std::size_t index) const {
    const Pair& pair = side.pairs.pairs()[index];
    float sum = 0;
    for (std::size_t k = 0; k < side.pairs.moving_count(pair); ++k) sum += pushed_[pair.points[k]];
    return sum;
}

/// @param enough  [pair] while its particles have been pushed less far in all, it closes no farther than it
/// may
/// @return whether there were any to push apart
bool SafeDisplacements::correct(ContactSide& side, ScratchVector<float>& enough) {
    bool is_any_pushed = false;
    enough.resize(side.pairs.pairs().size());
    for (std::size_t p = 0; p < enough.size(); ++p) {
        const float so_far = pushed(side, p);
        if (so_far < enough[p]) continue;
        const Plane plane = plane_between(side, p);
        enough[p] = so_far + plane.left() - side.least_gap * threshold::kPushMargin;
        if (plane.left() < 0 && stays_apart(side, p))
            enough[p] = std::nextafter(so_far, std::numeric_limits<float>::infinity());
        else if (plane.left() < 0)
            is_any_pushed = push_apart(side, side.pairs.pairs()[p], plane) || is_any_pushed;
    }
    return is_any_pushed;
}

/// Moves the particles of a pair so that it closes a share of the room along a plane's normal. Two parts
/// share that displacement, as far as what is held in them lets them; where it yields, it takes the rest.
/// @return whether any was moved; else those that are held close the pair
bool SafeDisplacements::push_apart(ContactSide& side, const Pair& pair, const Plane& plane) {
    const Vec3f& normal = plane.normal;
    const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
    constexpr float kNothing = -std::numeric_limits<float>::infinity();
    std::array<float, 4> closing{};
    std::array<float, 2> most{kNothing, kNothing}, held{kNothing, kNothing}, mass{};
    for (std::size_t k = 0; k < moving; ++k) {
        const std::uint32_t i = pair.points[k];
        const std::size_t part = k < own ? 0 : 1;
        const float along = dot(normal, side.base[i] - side.safe[i]);
        closing[k] = part == 0 ? -along : along;
        most[part] = std::max(most[part], closing[k]);
        if (rules_.is_held[i] != 0)
            held[part] = std::max(held[part], closing[k]);
        else
            mass[part] += rules_.masses.empty() ? 0 : static_cast<float>(rules_.masses[i]);
    }
    if (moving < 4) most[1] = held[1] = side.obstacle_closing(pair, normal);
    const float missing =
        most[0] + most[1] - plane.room * threshold::kPushedTo + side.least_gap * threshold::kPushMargin;
    const std::array<float, 2> free{most[0] - held[0], most[1] - held[1]};
    const float of_first = moving < 4 ? 1 : rules_.masses.empty() ? 0.5F : mass[1] / (mass[0] + mass[1]);
    const float fair = missing * of_first;
    const float first = std::min(std::max(fair, missing - free[1]), free[0]);
    std::array<float, 2> push{first, std::min(missing - first, free[1])};
    if (const float rest = missing - push[0] - push[1]; rules_.yields && rest > 0) {
        const float of_second = moving < 4 ? 0 : rest / 2;
        push[0] += rest - of_second;
        push[1] += of_second;
    }
    bool is_any_pushed = false;
    for (std::size_t k = 0; k < moving; ++k) {
        const std::size_t part = k < own ? 0 : 1;
        const std::uint32_t i = pair.points[k];
        const float back = closing[k] - (most[part] - push[part]);
        if ((rules_.is_held[i] != 0 && !rules_.yields) || !(back > 0)) continue;
        side.base.set(i, side.base[i] + normal * (part == 0 ? back : -back));
        ends_[i] = side.to_world_ahead(side.base[i]);
        pushed_[i] += back;
        pushed_by_[i] = side.number;
        is_any_pushed = true;
    }
    return is_any_pushed;
}

} // namespace echinus
