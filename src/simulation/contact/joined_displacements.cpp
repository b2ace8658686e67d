#include "simulation/contact/joined_displacements.hpp"

#include "geometry/union_find.hpp"
#include "simulation/surfaces/shares.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace echinus {

namespace {

/// The share of a pair's gap that displacements may close without being joined.
constexpr float kMostClosed = 0.5F;
/// Rounds in which particles are joined; after them all stay with what holds them.
constexpr int kMostRounds = 64;

/// How far a pair closes, along its normal.
float closing_of(const ContactSide& side, const Pair& pair, const Vec3f& normal) {
    std::array<float, 2> most;
    most.fill(-std::numeric_limits<float>::infinity());
    const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
    for (std::size_t k = 0; k < moving; ++k) {
        const float along = dot(normal, side.base[pair.points[k]] - side.safe[pair.points[k]]);
        float& of_part = most[k < own ? 0 : 1];
        of_part = std::max(of_part, k < own ? -along : along);
    }
    return most[0] + (moving == 4 ? most[1] : side.obstacle_closing(pair, normal));
}

class Joining {
  public:
    /// @param pushes  beside surfaces that deform no common displacement keeps all gaps: then particles are
    /// moved as far as is missing, one pair after the other
    Joining(Places safe, Places goals, std::span<const double> masses, std::span<const std::uint8_t> is_held,
            bool pushes)
        : safe_(safe), goals_(goals), masses_(masses), is_held_(is_held), pushes_(pushes),
          groups_(safe.size()), is_led_(safe.size()), led_to_(goals.begin(), goals.end()) {}

    /// @return whether anything is joined that was not before
    bool join(ContactSide& side) {
        bool is_any_new = false;
        for (std::size_t p = 0; p < side.pairs.pairs().size(); ++p) {
            const Pair& pair = side.pairs.pairs()[p];
            const Separation& apart = side.pairs.separations()[p];
            const float room =
                std::max(std::min(usable_gap(apart.gap, side.least_gap), kMostClosed * apart.gap), 0.0F);
            if (closing_of(side, pair, apart.normal) <= room) continue;
            if (pushes_) {
                is_any_new = push_apart(side, pair, apart.normal, room) || is_any_new;
                continue;
            }
            const std::size_t moving = side.pairs.moving_count(pair);
            for (std::size_t k = 0; k < moving; ++k)
                is_any_new = (moving == 4 ? join_particles(pair.points[0], pair.points[k])
                                          : lead(pair.points[k], side)) ||
                             is_any_new;
        }
        return is_any_new;
    }

    void find_displacements(std::vector<Vec3d>& joined) {
        const std::size_t count = safe_.size();
        struct Group {
            Vec3d sum;
            double weight = 0, farthest_sq = -1;
            std::uint8_t rank = 0; // 2 led by what is held, 1 by a model, 0 by none
        };
        std::vector<Group> of_group(count);
        std::vector<std::uint32_t> sizes(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t number = groups_.find(i);
            ++sizes[number];
            Group& group = of_group[number];
            const std::uint8_t rank = is_held_[i] != 0 ? 2 : is_led_[i];
            if (rank < group.rank) continue;
            if (rank > group.rank) group = {{}, 0, -1, rank};
            const Vec3d own = led_to_[i] - safe_[i];
            if (rank == 0) {
                group.sum += own * masses_[i];
                group.weight += masses_[i];
            } else if (dot(own, own) > group.farthest_sq) {
                // The farthest, which leaves all that lead behind.
                group.farthest_sq = dot(own, own);
                group.sum = own;
                group.weight = 1;
            }
        }
        joined.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t number = groups_.find(i);
            const Group& group = of_group[number];
            joined[i] = is_held_[i] != 0 || sizes[number] == 1 ? led_to_[i]
                                                               : safe_[i] + group.sum * (1 / group.weight);
        }
    }

  private:
    bool join_particles(std::uint32_t a, std::uint32_t b) {
        if (groups_.find(a) == groups_.find(b)) return false;
        groups_.join(a, b);
        return true;
    }
    /// A particle goes along with a model.
    bool lead(std::uint32_t i, const ContactSide& side) {
        const Vec3d to = side.carried(i, safe_[i]);
        if (is_held_[i] != 0 || (is_led_[i] != 0 && led_to_[i] == to)) return false;
        is_led_[i] = 1;
        led_to_[i] = to;
        return true;
    }
    /// Moves the particles of a pair so that it closes half of its room. Two parts that are free share that.
    bool push_apart(ContactSide& side, const Pair& pair, const Vec3f& normal, float room) {
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

    Places safe_, goals_;
    std::span<const double> masses_;
    std::span<const std::uint8_t> is_held_;
    bool pushes_;
    UnionFind groups_;
    std::vector<std::uint8_t> is_led_; ///< by a model
    std::vector<Vec3d> led_to_;        ///< the goal, or where the model leads
};

} // namespace

void join_displacements(std::span<ContactSide> sides, Places safe, Places goals,
                        std::span<const double> masses, std::span<const std::uint8_t> is_held,
                        std::vector<Vec3d>& joined, const Workers& workers) {
    joined.assign(goals.begin(), goals.end());
    for (ContactSide& side : sides) {
        side.to_frame(goals, side.goal);
        side.base = side.goal;
        side.measure(workers);
    }
    const bool pushes =
        std::any_of(sides.begin(), sides.end(), [](const ContactSide& side) { return side.is_deforming; });
    Joining joining(safe, goals, masses, is_held, pushes);
    const auto move_on = [&] {
        joining.find_displacements(joined);
        for (ContactSide& side : sides) side.to_frame(joined, side.base);
    };
    for (int round = 0; round < kMostRounds; ++round) {
        bool is_any_new = false;
        for (ContactSide& side : sides) {
            if (!joining.join(side)) continue;
            is_any_new = true;
            if (pushes) move_on(); // for the sides that follow
        }
        if (!is_any_new) return;
        if (!pushes) move_on();
        for (ContactSide& side : sides) side.measure(workers);
    }
}

} // namespace echinus
