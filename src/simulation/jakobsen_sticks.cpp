#include "simulation/jakobsen_sticks.hpp"

#include <cmath>
#include <limits>

namespace echinus {

std::vector<JakobsenStick> jakobsen_sticks(const Deformable& deformable,
                                           const std::array<double, kStickKindCount>& stiffness) {
    std::vector<JakobsenStick> sticks;
    for (const Stick& stick : deformable.sticks) {
        const double inverse_mass_a = deformable.inverse_masses[stick.a];
        const double inverse_mass_b = deformable.inverse_masses[stick.b];
        const double sum = inverse_mass_a + inverse_mass_b;
        if (sum == 0) continue;
        // Jakobsen 2001, section 4.
        const double share = stiffness[static_cast<std::size_t>(stick.kind)];
        sticks.push_back({stick.a, stick.b, stick.rest_length,
                          static_cast<float>(share * inverse_mass_a / sum),
                          static_cast<float>(share * inverse_mass_b / sum)});
    }
    return sticks;
}

void relax(std::span<const JakobsenStick> sticks, PointArrays& positions) noexcept {
    for (const JakobsenStick& stick : sticks) {
        const Vec3f a = positions[stick.a], b = positions[stick.b];
        const Vec3f across = b - a;
        // The smallest float keeps particles at one place from dividing by zero and is lost in all else.
        const float distance = std::sqrt(dot(across, across) + std::numeric_limits<float>::min());
        const Vec3f correction = across * (1 - stick.rest_length / distance);
        positions.set(stick.a, a + correction * stick.share_a);
        positions.set(stick.b, b - correction * stick.share_b);
    }
}

} // namespace echinus
