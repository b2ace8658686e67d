#include "rivals/systems/dense_grid/dense_grid.hpp"

#include "systems/ways.hpp"

using namespace echinus;

namespace {

/// The grid's answers, an array a component.
struct Arrays {
    explicit Arrays(std::size_t count) : depths(count), x(count), y(count), z(count) {}

    rivals::DenseGrid::Contacts from(std::size_t first, std::size_t count) {
        const auto part = [&](std::vector<float>& all) { return std::span(all).subspan(first, count); };
        return {part(depths), part(x), part(y), part(z)};
    }

    std::vector<float> depths, x, y, z;
};

} // namespace

Ways contacts_ways(const rivals::DenseGrid& grid, std::size_t point_count) {
    const auto arrays = std::make_shared<Arrays>(point_count);
    return {{"vector loop",
             [=, &grid](std::span<const Vec3f> points, std::size_t first) {
                 grid.contacts_batch(points, arrays->from(first, points.size()));
             },
             [=](std::size_t i) {
                 const float depth = arrays->depths[i];
                 if (!(depth > 0)) return DepthNormal{};
                 return DepthNormal{depth, {arrays->x[i], arrays->y[i], arrays->z[i]}};
             }}};
}
