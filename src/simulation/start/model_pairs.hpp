#pragma once

#include "collider/frame_change.hpp"

#include <echinus/collider.hpp>
#include <echinus/intersections.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace echinus {

/// The faces of a deformable's surface that must be separated from a collider before the first frame: those
/// that intersect it, and those that touch it. Within two steps of the map's lattice, a face inside cannot be
/// distinguished from one outside.
class ModelPairs {
  public:
    /// @param passes  [particle_count] 1 for particles that the collider lets through, or empty
    /// @pre the collider has an exact map
    ModelPairs(const Collider& collider, std::vector<std::uint8_t> passes);

    struct Found {
        std::vector<FacePair> intersecting; ///< ascending; faces of the surface and of the model's mesh
        /// Faces of the surface, ascending; without those that intersect.
        std::vector<std::uint32_t> touching;
    };
    /// @param surface  in the world, including edges and vertices as faces without area
    Found with(const TriangleMesh& surface) const;

    /// The corners of a face of the model's mesh, in the world, in the order that makes its normal point out.
    std::array<Vec3f, 3> face(std::uint32_t number) const;
    bool passes(std::size_t particle) const { return !passes_.empty() && passes_[particle] != 0; }
    bool has_inside() const { return map_.border.empty(); }

  private:
    ExactMapView map_;
    FrameChange local_, body_;
    TriangleMesh in_body_;
    std::vector<std::uint32_t> in_map_; ///< [number in the model's mesh] the index of the face in the map
    bool is_mirrored_;
    std::vector<std::uint8_t> passes_;
};

} // namespace echinus
