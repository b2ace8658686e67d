#pragma once

#include "geometry/whole_numbers.hpp"
#include "mesh/require_valid.hpp"

#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

using LatticePoint = Vec3<std::int64_t>;

/// Half the extent of the lattice: a bounding sphere of radius R is snapped to integers in [-2^19, 2^19], in
/// steps of R / 2^19 = 1.9e-6 R. Sums of products of three coordinates then stay below 2^62, so int64 decides
/// every sign.
inline constexpr std::int64_t kLatticeExtent = std::int64_t{1} << 19;

/// Position and step of a lattice. Mesh and particles are snapped by the same arithmetic, so a particle at a
/// vertex is snapped to the same point as the vertex.
struct LatticeFrame {
    Vec3d centre;    ///< C, local; the lattice's origin
    double step = 0; ///< length of one lattice step, R / kLatticeExtent
    double inverse_step = 0;

    LatticeFrame() = default;
    LatticeFrame(const Vec3f& centre_, float radius)
        : centre(centre_), step(static_cast<double>(radius) / static_cast<double>(kLatticeExtent)),
          inverse_step(1 / step) {}

    /// Converts to lattice steps, without rounding.
    Vec3d to_lattice(const Vec3f& point_local) const { return (Vec3d(point_local) - centre) * inverse_step; }
    Vec3d to_local(const Vec3d& place) const { return centre + place * step; }
};

/// The nearest lattice point. @pre components below 2^63
inline LatticePoint rounded(const Vec3d& place) {
    return {nearest_whole(place.x), nearest_whole(place.y), nearest_whole(place.z)};
}

/// A unit vector scaled to the lattice's extent and snapped: the direction of a ray.
LatticePoint lattice_direction(const Vec3d& unit);
/// The same for many unit vectors.
std::vector<LatticePoint> lattice_directions(const std::vector<Vec3d>& units);

/// A mesh on the integer lattice around its centre: the input of all exact predicates.
struct LatticeMesh {
    Vec3f centre;     ///< C, local; the lattice's origin
    float radius = 0; ///< R: every vertex lies within R of C, before snapping
    LatticeFrame frame;
    std::vector<LatticePoint> vertices; ///< [vertex_count] as in the mesh
    /// Faces whose three corners are different lattice points, and their numbers in the mesh. The dropped
    /// faces have no area on the lattice; a closed surface stays closed without them.
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> face_numbers;

    LatticePoint snap(const Vec3f& point_local) const { return rounded(frame.to_lattice(point_local)); }
    std::array<LatticePoint, 3> corners(std::uint32_t face) const {
        const Triangle& t = faces[face];
        return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    }
};

/// Do two corners have the same lattice point?
inline bool is_collapsed(const std::array<LatticePoint, 3>& corners) {
    return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
}

/// Snaps successive poses of a deforming mesh with fixed faces to lattices. It keeps memory and the data that
/// depend only on the faces from one call to the next. Corners on both sides of a seam (mesh/seams.hpp) get
/// the same lattice point, so that the rounding of a seam never opens a hole.
class LatticeSnapper {
  public:
    /// @param faces  must outlive the snapper
    explicit LatticeSnapper(std::span<const Triangle> faces) : faces_(faces) {}

    /// Is every edge balanced, with vertices distinguished by index?
    /// @pre snap() was called
    bool faces_are_closed() const { return open_vertices_->empty(); }

    /// Snaps the mesh around the centre of its bounding sphere. If that centre lies on a face or on the line
    /// of an edge, so that no small rotation could make its rays miss them, it is moved by whole lattice
    /// steps until it does not.
    /// @param result  becomes the lattice mesh
    /// @throws Error InvalidMesh as inspect() does, or if the bounding radius is 0 or outside [1e-15, 1e15]
    void snap(std::span<const Vec3f> vertices, LatticeMesh& result);

    /// The same around a given centre; the radius grows until the sphere contains every vertex.
    void snap(std::span<const Vec3f> vertices, const Vec3f& centre, LatticeMesh& result);

  private:
    void require_valid(std::span<const Vec3f> vertices);
    void find_seams(std::span<const Vec3f> vertices, double bounding_radius);
    void snap_valid(std::span<const Vec3f> vertices, const Vec3f& wanted_centre, LatticeMesh& result);
    void snap_around(std::span<const Vec3f> vertices, const Vec3f& centre, float radius,
                     LatticeMesh& result) const;

    std::span<const Triangle> faces_;
    std::optional<UsedVertices> used_; ///< not known before the first pose
    std::vector<Vec3f> positions_;
    std::optional<std::vector<std::uint32_t>> open_vertices_; ///< not known before the first pose
    std::vector<std::uint32_t> joined_vertices_; ///< [open_vertices_.size()] for the current pose
};

/// LatticeSnapper::snap() of a single mesh.
LatticeMesh snap_to_lattice(const TriangleMesh& mesh);
LatticeMesh snap_to_lattice(const TriangleMesh& mesh, const Vec3f& centre);

/// Snaps a mesh to the lattice of a low-cost centre, found by a pattern search from the bounding sphere's
/// centre with steps of a quarter to a sixteenth of the radius (Hooke and Jeeves, "Direct Search Solution of
/// Numerical and Statistical Problems", 1961). Evaluates 19 costs.
/// @param cost_of  a pure function of the lattice
/// @param best     becomes the lattice mesh
/// @throws Error as LatticeSnapper::snap()
void snap_at_lowest_cost(LatticeSnapper& snapper, std::span<const Vec3f> vertices,
                         const std::function<double(const LatticeMesh&)>& cost_of, LatticeMesh& best);

} // namespace echinus
