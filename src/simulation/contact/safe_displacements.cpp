#include "simulation/contact/safe_displacements.hpp"

#include "simulation/contact/thresholds.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace echinus {

SafeDisplacements::SafeDisplacements(std::span<ContactSide> sides, Places goals,
                                     std::span<const std::uint8_t> is_held, float share)
    : sides_(sides), goals_(goals), is_held_(is_held), share_(share), ends_(goals.begin(), goals.end()),
      pushed_(goals.size()), enough_(sides.size()) {}

Places SafeDisplacements::find(const Workers& workers) {
    for (ContactSide& side : sides_) side.to_frame(goals_, side.goal);
    for (std::vector<float>& of_side : enough_) of_side.clear();
    has_converged_ = false;
    for (int round = 0; round < threshold::kMostPushingRounds && !has_converged_; ++round) {
        has_converged_ = true;
        for (std::size_t s = 0; s < sides_.size(); ++s) {
            sides_[s].to_frame(ends_, sides_[s].base);
            sides_[s].measure(workers);
            has_converged_ = !correct(sides_[s], enough_[s]) && has_converged_;
        }
    }
    unresolved_count_ = 0;
    for (std::size_t s = 0; s < sides_.size(); ++s)
        for (std::size_t p = 0; p < enough_[s].size(); ++p)
            if (!(sides_[s].pairs.separations()[p].gap > 0) || closes(sides_[s], p, enough_[s][p]))
                ++unresolved_count_;
    return ends_;
}

float SafeDisplacements::room_of(const ContactSide& side, float gap) const {
    return std::max(std::min(side.room(gap), share_ * gap), 0.0F);
}

/// Does a pair close farther than it may?
/// @param enough  in: until the particles of the pair have been pushed so far in all, it does not. Out: the
/// same from now on
bool SafeDisplacements::closes(const ContactSide& side, std::size_t index, float& enough) const {
    const Pair& pair = side.pairs.pairs()[index];
    float pushed = 0;
    for (std::size_t k = 0; k < side.pairs.moving_count(pair); ++k) pushed += pushed_[pair.points[k]];
    if (pushed < enough) return false;
    const Separation& apart = side.pairs.separations()[index];
    const float left = room_of(side, apart.gap) - side.closing_of(pair, apart.normal);
    enough = pushed + left - side.least_gap / 4;
    return left < 0;
}

/// @param enough  [pair] as of closes()
/// @return whether there were any to push apart
bool SafeDisplacements::correct(ContactSide& side, std::vector<float>& enough) {
    bool is_any_pushed = false;
    enough.resize(side.pairs.pairs().size());
    for (std::size_t p = 0; p < enough.size(); ++p) {
        if (!closes(side, p, enough[p])) continue;
        const Separation& apart = side.pairs.separations()[p];
        const float room = room_of(side, apart.gap);
        is_any_pushed = push_apart(side, side.pairs.pairs()[p], apart.normal, room) || is_any_pushed;
    }
    return is_any_pushed;
}

/// Moves the particles of a pair so that it closes a share of its room. Two parts share that displacement, as
/// far as what is held in them lets them.
/// @return whether any was moved; else those that are held close the pair
bool SafeDisplacements::push_apart(ContactSide& side, const Pair& pair, const Vec3f& normal, float room) {
    const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
    constexpr float kNone = -std::numeric_limits<float>::infinity();
    std::array<float, 4> closing{};
    std::array<float, 2> most{kNone, kNone}, held{kNone, kNone};
    for (std::size_t k = 0; k < moving; ++k) {
        const std::uint32_t i = pair.points[k];
        const std::size_t part = k < own ? 0 : 1;
        const float along = dot(normal, side.base[i] - side.safe[i]);
        closing[k] = part == 0 ? -along : along;
        most[part] = std::max(most[part], closing[k]);
        if (is_held_[i] != 0) held[part] = std::max(held[part], closing[k]);
    }
    if (moving < 4) most[1] = held[1] = side.obstacle_closing(pair, normal);
    const float missing = most[0] + most[1] - room * threshold::kPushedTo + side.least_gap / 4;
    const std::array<float, 2> free{most[0] - held[0], most[1] - held[1]};
    const float first = std::min(std::max(missing / 2, missing - free[1]), free[0]);
    const std::array<float, 2> push{first, std::min(missing - first, free[1])};
    bool is_any_pushed = false;
    for (std::size_t k = 0; k < moving; ++k) {
        const std::size_t part = k < own ? 0 : 1;
        const std::uint32_t i = pair.points[k];
        const float back = closing[k] - (most[part] - push[part]);
        if (is_held_[i] != 0 || !(back > 0)) continue;
        side.base.set(i, side.base[i] + normal * (part == 0 ? back : -back));
        ends_[i] = side.to_world(side.base[i]);
        pushed_[i] += back;
        is_any_pushed = true;
    }
    return is_any_pushed;
}

} // namespace echinus
