#pragma once

#include <echinus/exact_map_view.hpp>
#include <echinus/mesh.hpp>

namespace echinus {

/// The faces of an exact map, numbered as in the mesh that it was made of, with a collider's scale applied to
/// the vertices. A scale that mirrors leaves the order of their corners.
TriangleMesh model_mesh(const ExactMapView& map, const Vec3d& scale);

} // namespace echinus
