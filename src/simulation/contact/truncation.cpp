#include "simulation/contact/truncation.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace echinus {

namespace {

/// No share of a displacement leads quite to a plane.
constexpr float kAlmost = 1 - 1.0F / (1 << 10);

/// What two parts of a pair ask of the gap between them.
struct Closing {
    std::array<float, 4> of_point{};
    std::array<float, 2> most{}; ///< by part, none if it recedes
    std::array<bool, 2> is_held{};
};

} // namespace

std::size_t limit_displacements(const ContactSide& side, std::span<const std::uint8_t> is_held,
                                std::span<float> shares) {
    const auto pairs = side.pairs.pairs();
    const auto separations = side.pairs.separations();
    std::size_t touching = 0;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const Pair& pair = pairs[p];
        const Separation& apart = separations[p];
        const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
        if (!(apart.gap > 0)) {
            ++touching;
            for (std::size_t k = 0; k < moving; ++k) shares[pair.points[k]] = 0;
            continue;
        }
        Closing closing;
        std::array<float, 2> joined; // what the parts close together
        joined.fill(-std::numeric_limits<float>::infinity());
        for (std::size_t k = 0; k < moving; ++k) {
            const std::uint32_t i = pair.points[k];
            const std::size_t part = k < own ? 0 : 1;
            const float direction = part == 0 ? -1.0F : 1.0F;
            closing.of_point[k] = direction * dot(apart.normal, side.goal[i] - side.base[i]);
            closing.most[part] = std::max(closing.most[part], closing.of_point[k]);
            closing.is_held[part] = closing.is_held[part] || (is_held[i] != 0 && closing.of_point[k] > 0);
            joined[part] = std::max(joined[part], direction * dot(apart.normal, side.base[i] - side.safe[i]));
        }
        const float closed =
            joined[0] + (moving == 4 ? joined[1] : side.obstacle_closing(pair, apart.normal));
        if (closed >= apart.gap) ++touching;
        const float room = std::max(side.room(apart.gap) - closed, 0.0F);
        const float asked = closing.most[0] + closing.most[1];
        if (asked <= room) continue;
        for (std::size_t part = 0; part < 2; ++part) {
            if (!(closing.most[part] > 0) || closing.is_held[part]) continue;
            const float allowed = closing.is_held[1 - part] ? std::max(room - closing.most[1 - part], 0.0F)
                                                            : room * (closing.most[part] / asked);
            for (std::size_t k = part == 0 ? 0 : own; k < (part == 0 ? own : moving); ++k) {
                if (!(closing.of_point[k] > allowed)) continue;
                float& share = shares[pair.points[k]];
                share = std::min(share, allowed / closing.of_point[k] * kAlmost);
            }
        }
    }
    return touching;
}

} // namespace echinus
