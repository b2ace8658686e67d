#include "simulation/contact/safe_displacements.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace echinus {

namespace {

/// The share of a pair's gap that carrying may close: what models take along comes to its own displacement
/// after it.
constexpr float kMostCarried = 0.5F;
/// Particles that are pushed apart close such a share of their room, so that the next ones need not push them
/// again.
constexpr float kPushedTo = 0.9F, kPushedToWhenCarried = 0.5F;
/// Rounds through the pairs.
constexpr int kMostRounds = 64;

} // namespace

SafeDisplacements::SafeDisplacements(std::span<ContactSide> sides, Places safe, Places goals,
                                     std::span<const double> masses, std::span<const std::uint8_t> is_held,
                                     Kind kind)
    : kind_(kind), sides_(sides), safe_(safe), goals_(goals), masses_(masses), is_held_(is_held),
      groups_(safe.size()), is_led_(safe.size()), wanted_(goals.begin(), goals.end()), ends_(wanted_),
      is_changed_(safe.size()), changes_(safe.size()) {}

Places SafeDisplacements::find(const Workers& workers) {
    for (ContactSide& side : sides_) side.to_frame(goals_, side.goal);
    has_converged_ = false;
    touching_count_ = 0;
    for (int round = 0; round < kMostRounds && !has_converged_; ++round) {
        has_converged_ = true;
        for (ContactSide& side : sides_) {
            side.to_frame(ends_, side.base);
            side.measure(workers);
            if (!correct(side, round == 0)) continue;
            has_converged_ = false;
            if (kind_ != Kind::Carrying) take_wanted(); // for the sides that follow
        }
        if (kind_ == Kind::Carrying && !has_converged_) find_common_ends();
        std::swap(is_changed_, changes_);
        std::fill(changes_.begin(), changes_.end(), std::uint8_t{0});
    }
    return ends_;
}

/// Corrects the pairs that would close too far.
/// @param all  look at all pairs, not only at those whose particles go elsewhere than in the round before
/// @return whether there were any
bool SafeDisplacements::correct(ContactSide& side, bool all) {
    bool is_any_new = false;
    for (std::size_t p = 0; p < side.pairs.pairs().size(); ++p) {
        const Pair& pair = side.pairs.pairs()[p];
        const Separation& apart = side.pairs.separations()[p];
        const std::size_t moving = side.pairs.moving_count(pair);
        bool is_asked = all;
        for (std::size_t k = 0; k < moving; ++k) is_asked = is_asked || is_changed_[pair.points[k]] != 0;
        if (!is_asked) continue;
        if (all && !(apart.gap > 0)) ++touching_count_;
        const float most = kind_ == Kind::Standing ? apart.gap : kMostCarried * apart.gap;
        const float room = std::max(std::min(side.room(apart.gap), most), 0.0F);
        if (side.closing_of(pair, apart.normal) <= room) continue;
        if (kind_ != Kind::Carrying) {
            is_any_new = push_apart(side, pair, apart.normal, room) || is_any_new;
            continue;
        }
        for (std::size_t k = 0; k < moving; ++k)
            is_any_new = (moving == 4 ? join(pair.points[0], pair.points[k]) : lead(pair.points[k], side)) ||
                         is_any_new;
    }
    return is_any_new;
}

bool SafeDisplacements::join(std::uint32_t a, std::uint32_t b) {
    if (groups_.find(a) == groups_.find(b)) return false;
    groups_.join(a, b);
    return true;
}

/// A particle goes along with a model.
bool SafeDisplacements::lead(std::uint32_t particle, const ContactSide& side) {
    const Vec3d to = side.carried(particle, safe_[particle]);
    if (is_held_[particle] != 0 || (is_led_[particle] != 0 && wanted_[particle] == to)) return false;
    is_led_[particle] = 1;
    wanted_[particle] = to;
    return true;
}

/// Moves the particles of a pair along its normal so that it closes a share of its room. Two parts that are
/// free share that displacement.
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
    const float aim = kind_ == Kind::Standing ? kPushedTo : kPushedToWhenCarried;
    const float missing = most[0] + most[1] - room * aim + side.least_gap / 4;
    const float share = is_free[0] && is_free[1] ? missing / 2 : missing;
    bool is_any_moved = false;
    for (std::size_t k = 0; k < moving; ++k) {
        const std::size_t part = k < own ? 0 : 1;
        const float back = closing[k] - (most[part] - share);
        if (!is_free[part] || !(back > 0)) continue;
        const std::uint32_t i = pair.points[k];
        side.base.set(i, side.base[i] + normal * (part == 0 ? back : -back));
        wanted_[i] = side.to_world(side.base[i]);
        is_any_moved = true;
    }
    return is_any_moved;
}

void SafeDisplacements::take_wanted() {
    for (std::uint32_t i = 0; i < ends_.size(); ++i) end_at(i, wanted_[i]);
}

void SafeDisplacements::end_at(std::uint32_t particle, const Vec3d& end) {
    if (end != ends_[particle]) changes_[particle] = 1;
    ends_[particle] = end;
}

void SafeDisplacements::find_common_ends() {
    struct Group {
        Vec3d sum;
        double weight = 0, farthest_sq = 0;
        std::uint32_t size = 0;
        std::uint8_t rank = 0; // 2 led by what is held, 1 by a model, 0 by none
    };
    const std::size_t count = safe_.size();
    std::vector<Group> of_group(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        Group& group = of_group[groups_.find(i)];
        ++group.size;
        const std::uint8_t rank = is_held_[i] != 0 ? 2 : is_led_[i];
        if (rank < group.rank) continue;
        if (rank > group.rank) group = {{}, 0, 0, group.size, rank};
        const Vec3d own = wanted_[i] - safe_[i];
        if (rank == 0) {
            group.sum += own * masses_[i];
            group.weight += masses_[i];
        } else if (group.weight == 0 || dot(own, own) > group.farthest_sq) {
            // The farthest, which leaves all that lead behind.
            group.farthest_sq = dot(own, own);
            group.sum = own;
            group.weight = 1;
        }
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const Group& group = of_group[groups_.find(i)];
        const bool is_alone = is_held_[i] != 0 || group.size == 1;
        end_at(i, is_alone ? wanted_[i] : safe_[i] + group.sum * (1 / group.weight));
    }
}

} // namespace echinus
