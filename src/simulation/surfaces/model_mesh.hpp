#pragma once

#include <echinus/collider.hpp>
#include <echinus/exact_map_view.hpp>
#include <echinus/mesh.hpp>

namespace echinus {

/// The exact map that has the faces of a collider: its map, or the one that is given beside it. Null where
/// there is none.
const ExactMap* map_of_surface(const Collider& collider);

/// The collider with another map.
Collider with_map(Collider collider, const ExactMap& map);

/// The faces of an exact map, numbered as in the mesh that it was made of, with a collider's scale applied to
/// the vertices. A scale that mirrors leaves the order of their corners.
TriangleMesh model_mesh(const ExactMapView& map, const Vec3d& scale);

} // namespace echinus
