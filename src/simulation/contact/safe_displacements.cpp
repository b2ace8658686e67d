#include "simulation/contact/safe_displacements.hpp"

#include "simulation/contact/thresholds.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace echinus {

SafeDisplacements::SafeDisplacements(std::span<ContactSide> sides, Places goals,
                                     std::span<const std::uint8_t> is_held, float share)
    : sides_(sides), goals_(goals), is_held_(is_held), share_(share), ends_(goals.begin(), goals.end()),
      is_pushed_(goals.size()), was_pushed_(goals.size()) {}

Places SafeDisplacements::find(const Workers& workers) {
    for (ContactSide& side : sides_) side.to_frame(goals_, side.goal);
    has_converged_ = false;
    touching_count_ = 0;
    for (int round = 0; round < threshold::kMostPushingRounds && !has_converged_; ++round) {
        has_converged_ = true;
        for (ContactSide& side : sides_) {
            side.to_frame(ends_, side.base);
            side.measure(workers);
            has_converged_ = !correct(side, round == 0) && has_converged_;
        }
        std::swap(was_pushed_, is_pushed_);
        std::fill(is_pushed_.begin(), is_pushed_.end(), std::uint8_t{0});
    }
    return ends_;
}

/// @param all  look at all pairs, not only at those of particles that the last round, or this one, has pushed
/// @return whether there were any to push apart
bool SafeDisplacements::correct(ContactSide& side, bool all) {
    bool is_any_pushed = false;
    for (std::size_t p = 0; p < side.pairs.pairs().size(); ++p) {
        const Pair& pair = side.pairs.pairs()[p];
        const Separation& apart = side.pairs.separations()[p];
        bool is_asked = all;
        for (std::size_t k = 0; k < side.pairs.moving_count(pair); ++k)
            is_asked = is_asked || (was_pushed_[pair.points[k]] | is_pushed_[pair.points[k]]) != 0;
        if (!is_asked) continue;
        if (all && !(apart.gap > 0)) ++touching_count_;
        const float room = std::max(std::min(side.room(apart.gap), share_ * apart.gap), 0.0F);
        if (side.closing_of(pair, apart.normal) > room)
            is_any_pushed = push_apart(side, pair, apart.normal, room) || is_any_pushed;
    }
    return is_any_pushed;
}

/// Moves the particles of a pair so that it closes a share of its room. Two parts that are free share that
/// displacement.
bool SafeDisplacements::push_apart(ContactSide& side, const Pair& pair, const Vec3f& normal, float room) {
    const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
    std::array<float, 4> closing{};
    std::array<float, 2> most;
    std::array<bool, 2> is_free{true, moving == 4};
    most.fill(-std::numeric_limits<float>::infinity());
    for (std::size_t k = 0; k < moving; ++k) {
        const std::uint32_t i = pair.points[k];
        const std::size_t part = k < own ? 0 : 1;
        const float along = dot(normal, side.base[i] - side.safe[i]);
        closing[k] = part == 0 ? -along : along;
        most[part] = std::max(most[part], closing[k]);
        is_free[part] = is_free[part] && is_held_[i] == 0;
    }
    if (moving < 4) most[1] = side.obstacle_closing(pair, normal);
    const float missing = most[0] + most[1] - room * threshold::kPushedTo + side.least_gap / 4;
    const float push = is_free[0] && is_free[1] ? missing / 2 : missing;
    bool is_any_pushed = false;
    for (std::size_t k = 0; k < moving; ++k) {
        const std::size_t part = k < own ? 0 : 1;
        const float back = closing[k] - (most[part] - push);
        if (!is_free[part] || !(back > 0)) continue;
        const std::uint32_t i = pair.points[k];
        side.base.set(i, side.base[i] + normal * (part == 0 ? back : -back));
        ends_[i] = side.to_world(side.base[i]);
        is_pushed_[i] = 1;
        is_any_pushed = true;
    }
    return is_any_pushed;
}

} // namespace echinus
