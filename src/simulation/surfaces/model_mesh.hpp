#pragma once

#include <echinus/collider.hpp>
#include <echinus/exact_map_view.hpp>
#include <echinus/mesh.hpp>

namespace echinus {

/// The exact map that contains the faces of a collider: its own map, or the one given in addition to it. Null
/// if there is none.
const ExactMap* map_of_surface(const Collider& collider);

/// The collider with a different map.
Collider with_map(Collider collider, const ExactMap& map);

/// The mesh of an exact map: its faces in the map's order, its vertices numbered as in the original mesh,
/// with a collider's scale applied. A mirroring scale does not change the order of a face's corners.
TriangleMesh model_mesh(const ExactMapView& map, const Vec3d& scale);

} // namespace echinus
