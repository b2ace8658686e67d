#include "simulation/surfaces/model_mesh.hpp"

#include "collider/frame_change.hpp"
#include "directions/lattice.hpp"
#include "exact_map/layout.hpp"

#include <cstddef>

namespace echinus {

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
