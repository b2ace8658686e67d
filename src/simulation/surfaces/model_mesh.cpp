#include "simulation/surfaces/model_mesh.hpp"

#include "collider/frame_change.hpp"
#include "directions/lattice.hpp"
#include "exact_map/layout.hpp"

#include <cstddef>
#include <variant>

namespace echinus {

const ExactMap* map_of_surface(const Collider& collider) {
    if (const auto* exact = std::get_if<ExactMap>(&collider.map.kind)) return exact;
    return collider.map.surface ? &*collider.map.surface : nullptr;
}

Collider with_map(Collider collider, const ExactMap& map) {
    collider.map = map;
    return collider;
}

TriangleMesh model_mesh(const ExactMapView& map, const Vec3d& scale) {
    const LatticeFrame frame = frame_of(map);
    TriangleMesh mesh;
    for (const auto& vertex : map.vertices)
        mesh.vertices.emplace_back(times(frame.to_local(Vec3d(vertex)), scale));
    for (std::size_t f = 0; f < map.face_count(); ++f)
        mesh.faces.push_back({map.corners[3 * f], map.corners[3 * f + 1], map.corners[3 * f + 2]});
    return mesh;
}

} // namespace echinus
