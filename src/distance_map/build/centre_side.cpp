#include "distance_map/build/centre_side.hpp"

#include <cstddef>
#include <variant>
#include <vector>

namespace echinus {

CentreSide side_of_centre(const Crossings& crossings, const AnyGrid& any_grid) {
    const std::vector<double> solid_angles =
        std::visit([](const auto& grid) { return grid.solid_angle_weights(); }, any_grid);
    double odd_weight = 0;
    double weight = 0;
    std::size_t odd_count = 0;
    for (std::size_t d = 0; d < solid_angles.size(); ++d) {
        const bool odd = (crossings.offsets[d + 1] - crossings.offsets[d]) % 2 == 1;
        odd_weight += odd ? solid_angles[d] : 0;
        weight += solid_angles[d];
        odd_count += odd ? 1 : 0;
    }
    const std::size_t direction_count = solid_angles.size();
    const bool inside = odd_weight > weight / 2;
    const std::size_t wrong_count = inside ? direction_count - odd_count : odd_count;
    return {inside, static_cast<float>(wrong_count) / static_cast<float>(direction_count)};
}

} // namespace echinus
