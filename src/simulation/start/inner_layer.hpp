#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/collider.hpp>
#include <echinus/contact.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <optional>
#include <vector>

namespace echinus {

/// An open surface that layers outside of it have to leave in the direction of its normals: what is behind it
/// counts as inside.
class InnerLayer {
  public:
    /// @throws Error InvalidMesh as ExactMap::build()
    explicit InnerLayer(TriangleMesh surface);

    /// The surface, which stays where it is.
    const Collider& collider() const { return collider_; }
    /// The contact of a point; none if the nearest point of the surface lies on the border, beyond which the
    /// sides are not separated. The side is that of the angle-weighted pseudonormal (Baerentzen and Aanaes
    /// 2005).
    /// @param nearest  the contact of the point with collider(), which need not know the side
    Contact contact_of(const Vec3f& point, const Contact& nearest) const;

  private:
    void find_normals();
    std::array<Vec3d, 3> corners(std::size_t face) const;
    /// The normal at a feature of a face, not of unit length; nothing on the border.
    std::optional<Vec3d> normal_at(const Contact& nearest) const;

    TriangleMesh surface_;
    Collider collider_;
    Elements elements_;
    std::vector<Vec3d> face_normals_, edge_normals_, vertex_normals_; ///< [face], [edge], [vertex]
    std::vector<bool> is_border_edge_, is_border_vertex_;
};

} // namespace echinus
