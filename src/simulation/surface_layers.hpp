#pragma once

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>
#include <echinus/surface_collision.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// A layer of a surface.
struct SurfaceLayer {
    TriangleMesh mesh;
    std::vector<std::uint32_t> vertices; ///< [vertex of the layer] its number in the surface
    std::vector<std::uint8_t> pinned;    ///< [vertex of the layer] as in PartOptions; or empty
};

/// @throws Error InvalidOptions if the layers are not those of a surface, as PartOptions says; InvalidMesh if
/// neighbouring faces of one do not agree about its outer side
void require_layers(const TriangleMesh& surface, const PartOptions& options);

/// The layers of a surface that have faces, from the inside to the outside.
/// @pre require_layers() passed
std::vector<SurfaceLayer> layers_of(const TriangleMesh& surface, const PartOptions& options);

/// Turns the faces of each connected piece of a layer over if their normals point towards the closed models
/// on average.
void turn_outward(TriangleMesh& layer, const std::vector<Collider>& colliders);

/// An open model has no inside.
bool has_inside(const Collider& collider);

} // namespace echinus
