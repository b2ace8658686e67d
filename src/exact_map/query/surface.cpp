#include "exact_map/layout.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>

namespace echinus {

namespace {

std::vector<std::uint32_t> longest_lists(const ExactMapView& map) {
    std::vector<std::uint32_t> longest(map.face_count());
    for (std::size_t band = 0; band + 1 < map.bands.size(); ++band) {
        const std::uint32_t first = map.bands[band].first_reference;
        const std::uint32_t last = map.bands[band + 1].first_reference;
        for (std::uint32_t r = first; r < last; ++r) {
            std::uint32_t& length = longest[map.references[r]];
            length = std::max(length, last - first);
        }
    }
    return longest;
}

} // namespace

ExactMapSurface reconstruct_surface(const ExactMapView& map) {
    ExactMapSurface surface;
    surface.mesh.origin = map.origin;
    const LatticeFrame frame = frame_of(map);
    for (const Vec3<std::int32_t>& vertex : map.vertices)
        surface.mesh.vertices.push_back(Vec3f(frame.to_local(Vec3d(vertex))));
    for (std::size_t face = 0; face < map.face_count(); ++face)
        surface.mesh.faces.push_back(
            {map.corners[3 * face], map.corners[3 * face + 1], map.corners[3 * face + 2]});
    surface.longest_list = longest_lists(map);
    return surface;
}

} // namespace echinus
