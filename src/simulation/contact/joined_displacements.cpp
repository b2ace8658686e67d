#include "simulation/contact/joined_displacements.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace echinus {

namespace {

/// The share of a pair's gap that carrying may close.
constexpr float kMostCarried = 0.5F;
/// No share of a displacement leads quite to a plane.
constexpr float kAlmost = 1 - 1.0F / (1 << 10);
/// Rounds in which particles are joined; after them all stay with what holds them.
constexpr int kMostRounds = 64;

} // namespace

JoinedDisplacements::JoinedDisplacements(std::span<ContactSide> sides, Places safe, Places goals,
                                         std::span<const double> masses,
                                         std::span<const std::uint8_t> is_held, Kind kind)
    : kind_(kind), sides_(sides), safe_(safe), goals_(goals), masses_(masses), is_held_(is_held),
      groups_(safe.size()), is_led_(safe.size()), led_to_(goals.begin(), goals.end()), joined_(led_to_),
      is_changed_(safe.size()) {}

Places JoinedDisplacements::find(const Workers& workers) {
    for (ContactSide& side : sides_) side.to_frame(goals_, side.goal);
    has_converged_ = false;
    for (int round = 0; round < kMostRounds && !has_converged_; ++round) {
        bool is_any_new = false;
        for (ContactSide& side : sides_) {
            side.to_frame(joined_, side.base);
            side.measure(workers);
            if (!join(side, round == 0)) continue;
            is_any_new = true;
            if (kind_ == Kind::Deforming) find_displacements(); // for the sides that follow
        }
        has_converged_ = !is_any_new;
        if (kind_ != Kind::Deforming && is_any_new) find_displacements();
    }
    return joined_;
}

/// @param all  look at all pairs, not only at those whose particles go elsewhere than in the last round
/// @return whether anything is joined that was not before
bool JoinedDisplacements::join(ContactSide& side, bool all) {
    bool is_any_new = false;
    for (std::size_t p = 0; p < side.pairs.pairs().size(); ++p) {
        const Pair& pair = side.pairs.pairs()[p];
        const std::size_t moving = side.pairs.moving_count(pair);
        bool is_asked = all || kind_ == Kind::Deforming;
        for (std::size_t k = 0; k < moving; ++k) is_asked = is_asked || is_changed_[pair.points[k]] != 0;
        if (!is_asked) continue;
        const Separation& apart = side.pairs.separations()[p];
        const float most = kind_ == Kind::Standing ? apart.gap : kMostCarried * apart.gap;
        const float room = std::max(std::min(side.room(apart.gap), most), 0.0F);
        if (side.closing_of(pair, apart.normal) <= room) continue;
        if (kind_ == Kind::Deforming) {
            is_any_new = push_apart(side, pair, apart.normal, room) || is_any_new;
            continue;
        }
        for (std::size_t k = 0; k < moving; ++k)
            is_any_new = (moving == 4 ? join_particles(pair.points[0], pair.points[k])
                                      : lead(pair.points[k], side, apart, room)) ||
                         is_any_new;
    }
    return is_any_new;
}

bool JoinedDisplacements::join_particles(std::uint32_t a, std::uint32_t b) {
    if (groups_.find(a) == groups_.find(b)) return false;
    groups_.join(a, b);
    return true;
}

/// A particle goes along with a model that moves; beside one that stands, as far as the pair has room.
bool JoinedDisplacements::lead(std::uint32_t particle, const ContactSide& side, const Separation& apart,
                               float room) {
    if (is_held_[particle] != 0) return false;
    Vec3d to = side.carried(particle, safe_[particle]);
    if (kind_ == Kind::Standing) {
        const float closing = -dot(apart.normal, side.base[particle] - side.safe[particle]);
        if (closing <= room) return false;
        to = safe_[particle] + (joined_[particle] - safe_[particle]) * double{room / closing * kAlmost};
    }
    if (is_led_[particle] != 0 && led_to_[particle] == to) return false;
    is_led_[particle] = 1;
    led_to_[particle] = to;
    return true;
}

/// Moves the particles of a pair so that it closes half of its room. Two parts that are free share that.
bool JoinedDisplacements::push_apart(ContactSide& side, const Pair& pair, const Vec3f& normal, float room) {
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
    const float missing = most[0] + most[1] - room / 2 + side.least_gap / 4;
    const float share = is_free[0] && is_free[1] ? missing / 2 : missing;
    bool is_any_moved = false;
    for (std::size_t k = 0; k < moving; ++k) {
        const std::size_t part = k < own ? 0 : 1;
        const float back = closing[k] - (most[part] - share);
        if (!is_free[part] || !(back > 0)) continue;
        const std::uint32_t i = pair.points[k];
        side.base.set(i, side.base[i] + normal * (part == 0 ? back : -back));
        led_to_[i] = side.to_world(side.base[i]);
        is_any_moved = true;
    }
    return is_any_moved;
}

void JoinedDisplacements::find_displacements() {
    const std::size_t count = safe_.size();
    struct Group {
        Vec3d sum;
        double weight = 0, leading_sq = 0;
        std::uint32_t size = 0;
        std::uint8_t rank = 0; // 2 led by what is held, 1 by a model, 0 by none
    };
    std::vector<Group> of_group(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        Group& group = of_group[groups_.find(i)];
        ++group.size;
        const std::uint8_t rank = is_held_[i] != 0 ? 2 : is_led_[i];
        if (rank < group.rank) continue;
        if (rank > group.rank) group = {{}, 0, 0, group.size, rank};
        const Vec3d own = led_to_[i] - safe_[i];
        if (rank == 0) {
            group.sum += own * masses_[i];
            group.weight += masses_[i];
        } else if (group.weight == 0 || (dot(own, own) > group.leading_sq) == (kind_ == Kind::Carrying)) {
            group.leading_sq = dot(own, own);
            group.sum = own;
            group.weight = 1;
        }
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const Group& group = of_group[groups_.find(i)];
        const Vec3d to =
            is_held_[i] != 0 || group.size == 1 ? led_to_[i] : safe_[i] + group.sum * (1 / group.weight);
        is_changed_[i] = to == joined_[i] ? 0 : 1;
        joined_[i] = to;
    }
}

} // namespace echinus
