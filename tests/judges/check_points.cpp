#include "judges/check_points.hpp"

#include "support/point_sets.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace echinus::test {

namespace {

/// The low ten bits of a number, with two zeros between each and the next.
std::uint32_t spread_bits(std::uint32_t bits) {
    bits = (bits | bits << 16U) & 0x030000FFU;
    bits = (bits | bits << 8U) & 0x0300F00FU;
    bits = (bits | bits << 4U) & 0x030C30C3U;
    return (bits | bits << 2U) & 0x09249249U;
}

/// In Morton order, so that neighbours are judged in succession and find their data in the cache, which
/// halves the total time. No answer depends on the order.
void sort_along_curve(std::vector<Vec3f>& points, const MapFrame& frame) {
    const auto cell_of = [&](float coordinate, float centre) {
        const float share = (coordinate - centre) / frame.radius * 0.25F + 0.5F;
        return spread_bits(static_cast<std::uint32_t>(std::clamp(share, 0.0F, 1.0F) * 1023));
    };
    const auto place_on_curve = [&](const Vec3f& p) {
        return cell_of(p.x, frame.centre.x) | cell_of(p.y, frame.centre.y) << 1U |
               cell_of(p.z, frame.centre.z) << 2U;
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    order.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) order.emplace_back(place_on_curve(points[i]), i);
    std::ranges::sort(order);
    std::vector<Vec3f> sorted;
    sorted.reserve(points.size());
    for (const auto& [place, i] : order) sorted.push_back(points[i]);
    points = std::move(sorted);
}

/// Sheets draped over the mesh from three sides.
std::vector<Vec3f> sheets(const TriangleMesh& mesh, std::size_t side) {
    std::vector<Vec3f> points;
    for (const test::Axis up : {test::Axis::X, test::Axis::Y, test::Axis::Z}) {
        const std::vector<Vec3f> sheet = test::cloth_points(mesh, side, side, up);
        points.insert(points.end(), sheet.begin(), sheet.end());
    }
    return points;
}

} // namespace

std::vector<PointSet> point_sets(const TriangleMesh& mesh, const MapFrame& frame, std::size_t count,
                                 std::uint64_t seed) {
    const std::size_t quarter = count / 4;
    const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(quarter) / 3));
    const std::size_t rest = count - 2 * quarter - 3 * side * side;
    std::vector<PointSet> sets{
        {"uniform", [=, &mesh] { return test::uniform_points(mesh, quarter, seed); }},
        {"surface", [=, &mesh] { return test::surface_points(mesh, quarter, 0.01, seed + 1); }},
        {"cloth", [=, &mesh] { return sheets(mesh, side); }},
        {"adversarial", [=, &mesh] { return adversarial_points(mesh, frame, rest, seed + 2); }},
    };
    for (PointSet& set : sets)
        set.make = [=, make = set.make] {
            std::vector<Vec3f> points = make();
            sort_along_curve(points, frame);
            return points;
        };
    return sets;
}

} // namespace echinus::test
